"""A level in a tank whose pump is recorded by another logger: its column may be late or early, or nothing is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cosim.cli import app
from cosim.loading import load_scenario
from diagnosis.check.beside import Compared, compare
from diagnosis.check.clock_doubts import shift_doubts
from diagnosis.check.clock_shift import swings, turns
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel

from .rigs import write_recording

TANK = OdeModel(
    "tank",
    {"A": (0.02, "m2"), "k": (2e-5, "m3/s"), "c": (2.4e-5, "m2/s")},
    {"pump": "1"},
    {"h": ("m", "0.3", "(k*pump - c*h)/A")},
    {"level": ("m", "h")},
    2.0,
)
SPRING = OdeModel(
    "spring",
    {"m": (1.0, "kg"), "d": (0.02, "N.s/m"), "k": (0.04, "N/m")},
    {"force": "N"},
    {"x": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(force - d*v - k*x)/m")},
    {"position": ("m", "x")},
    1.0,
)
STEP, COUNT = 4.0, 901
SCENARIO = """
title: A tank
time: {stop: 3600 s, macro_step: 4 s, output_step: 4 s}
components:
  bench: {kind: programme, outputs: {pump: {unit: "1", constant: 0}}}
  tank: {kind: fmu, fmu: tank.fmu, integrator: cvode}
connections: [bench.pump -> tank.pump]
"""


def record(folder: Path, seed: int, late: int) -> None:
    """Levels of a tank a few per cent off in all; the column of the pump is late by so many rows."""
    rng = np.random.default_rng(seed)
    pump = np.repeat(rng.uniform(0.0, 1.0, 13), 75)[:COUNT].round(3)
    area, inflow, outflow = 0.0206, 1.95e-5, 2.45e-5
    level = np.full(COUNT, 0.3)
    for i in range(COUNT - 1):
        end = inflow * pump[i] / outflow
        level[i + 1] = end + (level[i] - end) * np.exp(-outflow / area * STEP)
    values = level + 5e-4 * rng.standard_normal(COUNT)
    seen = pump[np.clip(np.arange(COUNT) - late, 0, COUNT - 1)]
    columns = {"t": STEP * np.arange(COUNT), "P": seen, "L": 1e3 * values}
    write_recording(folder, columns, {"bench.pump": ("P", "1")}, {"tank.level": ("L", "mm", "0.5 mm")})


def rig(folder: Path, seed: int, late: int) -> Compared:
    TANK.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO)
    record(folder / "one", seed, late)
    record(folder / "two", seed + 1, late)
    return compare(load_scenario(folder / "scenario.yaml"), load_recording(folder / "one"))


@pytest.mark.parametrize("seed", [3, 5])
@pytest.mark.parametrize("late", [5, -5])
def test_a_level_is_asked_for_the_clock_too(tmp_path: Path, seed: int, late: int) -> None:
    """Only temperatures and flows were: an input that was logged 20 s late became a gain of a sensor."""
    (doubt,) = shift_doubts(rig(tmp_path, seed, late))
    assert not doubt.is_serious  # one channel alone: which clock it is it cannot say
    assert f"comes {'earlier' if late > 0 else 'later'} than its recorded input by " in doubt.statement
    assert ("dead time" in doubt.statement) == (late < 0)
    assert "no other channel can confirm it" in doubt.statement
    size = float(doubt.statement.split(" input by ")[1].split(" s ")[0])
    assert size == pytest.approx(20.0, abs=3.0)


@pytest.mark.parametrize("seed", range(3, 9))
def test_a_level_that_follows_its_pump_has_no_wrong_clock(tmp_path: Path, seed: int) -> None:
    assert shift_doubts(rig(tmp_path, seed, 0)) == []


def test_an_early_input_is_a_dead_time_or_a_clock_and_nothing_beside(tmp_path: Path) -> None:
    """Lag, dead time and a gain of the input were three findings at more than 99.9 %."""
    rig(tmp_path, 3, -5)
    asked = ["diagnose", str(tmp_path / "scenario.yaml"), "--recording", str(tmp_path / "one")]
    asked += ["--held-out", str(tmp_path / "two"), "--brief", "--out", str(tmp_path / "answer")]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 0, done.output
    answer = json.loads((tmp_path / "answer" / "diagnosis.json").read_text())
    assert {f["effect"] for f in answer["findings"] if f["is_accepted"]} <= {"input_dead_time"}
    assert any("later than its recorded input" in d["statement"] for d in answer["doubts"])


def test_what_swings_by_itself_is_not_asked(tmp_path: Path) -> None:
    """A spring of 31 s under two steps turns over each 16 s; a level turns with its pump alone."""
    SPRING.build(tmp_path)
    text = """
title: A spring
time: {stop: 200 s, macro_step: 1 s, output_step: 1 s}
components:
  hand: {kind: programme, outputs: {force: {unit: N, points: [[0 s, 0 N], [20 s, 0.01 N], [120 s, 0 N]]}}}
  spring: {kind: fmu, fmu: spring.fmu, integrator: cvode}
connections: [hand.force -> spring.force]
"""
    (tmp_path / "scenario.yaml").write_text(text)
    folder = tmp_path / "swing"
    times = np.arange(0.0, 201.0)
    swung = 0.25 * (1.0 - np.cos(0.2 * (times - 20.0))) * (times > 20.0)
    write_recording(folder, {"t": times, "x": swung}, {}, {"spring.position": ("x", "m", "1 mm")})
    swing = compare(load_scenario(tmp_path / "scenario.yaml"), load_recording(folder))
    assert swings(swing, swing.channels["spring.position"])
    assert shift_doubts(swing) == []
    tank = rig(tmp_path / "tank", 3, 0)
    assert not swings(tank, tank.channels["tank.level"])


def test_turns_are_counted_beyond_ripple() -> None:
    times = np.linspace(0.0, 1.0, 400)
    assert turns(np.sin(2.0 * np.pi * 3.0 * times)) == 6
    assert turns(np.sin(np.pi * times) + 0.005 * np.sin(300.0 * times)) == 1
    assert turns(times) == turns(np.zeros(5)) == 0
    assert turns(np.repeat([0.0, 1.0, 0.5, 0.7], 50)) == 2
