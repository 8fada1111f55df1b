"""A battery whose voltage follows the load at once: readings at a change of the load, and numbers of its output alone.

A logger writes the load of a row that was set before, or after, the voltage of that row was read; the table does not
say which. Whichever it was, nothing is missing here.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cosim.cli import app
from cosim.loading import load_scenario
from diagnosis.check.beside import compare
from diagnosis.check.check import check_recordings
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.numbers import usual_numbers
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.usage import usage
from evaluation.fmus.model import OdeModel

from .rigs import write_recording

CELL = OdeModel(
    "cell",
    {
        "Q": (9000.0, "C"),
        "R0": (0.03, "ohm"),
        "R1": (0.02, "ohm"),
        "tau": (300.0, "s"),
        "slope": (0.7, "V"),
        "charge": (0.9, ""),
    },
    {"load": "A"},
    {"s": ("", "charge", "-load/Q"), "v": ("V", "0.0", "(R1*load - v)/tau")},
    {"y": ("V", "3.4 + slope*s - v - R0*load")},
    2.0,
)
STEP, COUNT = 20.0, 541
SCENARIO = """
title: A cell
time: {stop: 10800 s, macro_step: 10 s, output_step: 10 s}
components:
  bench: {kind: programme, outputs: {load: {unit: A, constant: 0 A}}}
  cell: {kind: fmu, fmu: cell.fmu, integrator: INTEGRATOR}
connections: [bench.load -> cell.load]
"""


def record(folder: Path, seed: int, rows: int, is_after: bool, noise: str | None) -> None:
    """A recording of a cell 3 % off in all, whose load changes each so many rows; from the closed form of its parts."""
    rng = np.random.default_rng(seed)
    load = np.repeat(rng.uniform(-0.8, 1.6, -(-COUNT // rows)), rows)[:COUNT].round(3)
    kept = np.exp(-STEP / 291.0)
    charge, over = np.empty(COUNT), np.empty(COUNT)
    s, v = 0.9, 0.0
    for i in range(COUNT):
        charge[i], over[i] = s, v
        s, v = s - load[i] * STEP / 9270.0, 0.0206 * load[i] + (v - 0.0206 * load[i]) * kept
    seen = load if is_after else np.concatenate([[0.0], load[:-1]])
    values = 3.4 + 0.7 * charge - over - 0.0291 * seen + 1e-3 * rng.standard_normal(COUNT)
    columns = {"t": STEP * np.arange(COUNT), "I": load, "U": 1e3 * values}
    write_recording(folder, columns, {"bench.load": ("I", "A")}, {"cell.y": ("U", "mV", noise or "")})


def rig(folder: Path, rows: int, is_after: bool, noise: str | None = "1 mV", integrator: str = "cvode") -> Path:
    CELL.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO.replace("INTEGRATOR", integrator))
    record(folder / "one", 3, rows, is_after, noise)
    record(folder / "two", 4, rows, is_after, noise)
    return folder / "scenario.yaml"


def compared(folder: Path) -> Recording:
    return compare(load_scenario(folder / "scenario.yaml"), load_recording(folder / "one")).recording


@pytest.mark.parametrize("is_after", [True, False])
@pytest.mark.parametrize(("rows", "noise"), [(75, "1 mV"), (1, None)])
def test_a_cell_of_which_nothing_is_missing_is_recalibrated(
    tmp_path: Path, rows: int, noise: str | None, is_after: bool
) -> None:
    """ "Gain of an input" was announced of all four, and a noise of 24 mV of those whose load changes all the time."""
    scenario = rig(tmp_path, rows, is_after, noise)
    arguments = ["--recording", str(tmp_path / "one"), "--held-out", str(tmp_path / "two")]
    done = CliRunner().invoke(app, ["diagnose", str(scenario), *arguments, "--out", str(tmp_path / "out"), "--brief"])
    assert done.exit_code == 0, done.output
    found = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert found["findings"] == []
    assert found["doubts"] == []
    moved = {p["name"]: p["amount"] for p in found["recalibration"]}
    assert moved.get("cell.R0", 0.97) == pytest.approx(0.97, abs=0.02)
    judged = next(f for f in found["fit"] if f["is_held_out"])["chi_square"]["after"]
    assert 0.8 < judged < 1.3


def test_readings_at_a_change_are_left_out_where_they_are_few(tmp_path: Path) -> None:
    rig(tmp_path, 75, True)
    (used,) = usage(compared(tmp_path))
    assert used.unused == {
        "taken while an input changed that the quantity follows at once": 8
    }  # seven changes, and t = 0


def test_readings_that_are_all_at_a_change_say_on_which_side_of_it_they_are(tmp_path: Path) -> None:
    rig(tmp_path, 1, True)
    rig(tmp_path / "before", 1, False)
    (after,), (before,) = usage(compared(tmp_path)), usage(compared(tmp_path / "before"))
    assert str(after) == "cell.y: all 541 readings are used, each as taken just after the input changed"
    assert not before.is_after
    assert before.used == 540


def test_nothing_is_left_out_of_a_quantity_that_follows_slowly(tmp_path: Path) -> None:
    rig(tmp_path, 75, True)
    one = compared(tmp_path)
    slow = replace(CELL, outputs={"y": ("V", "3.4 + slope*s - v")})
    slow.build(tmp_path)
    channel = compared(tmp_path).channels["cell.y"]
    assert len(channel.times) == COUNT > len(one.channels["cell.y"].times)


def test_a_stated_noise_is_compared_with_what_the_simulation_leaves_between_neighbours(tmp_path: Path) -> None:
    """A load that changes with each reading is no noise; 5 mV where 1 mV acts is still told."""
    scenario = load_scenario(rig(tmp_path, 1, False))
    assert check_recordings(scenario, [load_recording(tmp_path / "one")]) == ()
    text = (tmp_path / "one" / "recording.yaml").read_text().replace("1 mV", "5 mV")
    (tmp_path / "one" / "recording.yaml").write_text(text)
    (doubt,) = check_recordings(scenario, [load_recording(tmp_path / "one")])
    assert doubt.kind == "noise"
    assert "times less" in doubt.statement


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_numbers_of_an_output_may_be_off_and_start_values_may_not(tmp_path: Path, integrator: str) -> None:
    """`R0` and `slope` stand in no derivative, and were taken for start values; `charge` is one."""
    scenario = rig(tmp_path, 75, True, integrator=integrator)
    system = FastSystem(compare(load_scenario(scenario), load_recording(tmp_path / "one")).scenario)
    try:
        assert {f.name for f in usual_numbers(system, ())} == {"Q", "R0", "R1", "tau", "slope"}
    finally:
        system.close()
