"""One channel that is so many times what it is in the others: its sensor, unless a number of the rig does the same."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.check import input_runs
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.check.test_other_course import COUNT, STEP, _power
from tests.systems.rigs import write_recording

#: Time constant [s] of a follower, and noise of both outputs [W].
TAU, NOISE = 900.0, 0.05
#: One number is in both outputs; the second one has one of its own.
COUPLED, OWN = (
    OdeModel(
        "follower",
        {"tau": (TAU, "s"), "g": (1.0, "1"), "h": (2.0, "1")},
        {"power": "W"},
        {"x": ("W", "0", "(power - x)/tau")},
        {"first": ("W", "g*x"), "second": ("W", second)},
    )
    for second in ("2*g*x", "h*x")
)
SCENARIO = f"""\
title: A follower with two outputs
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  heater: {{kind: programme, outputs: {{power: {{unit: W, constant: 10 W}}}}}}
  rig: {{kind: fmu, fmu: follower.fmu, integrator: cvode}}
connections: [heater.power -> rig.power]
"""
BOTH = ("first", "second")


def _doubts(
    folder: Path, model: OdeModel, factor: float = 0.6, channels: Sequence[str] = BOTH, off: float = 1.0
) -> list[Doubt]:
    """About three runs, in the second of which the second channel is multiplied; both are off by so much in all."""
    model.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    recordings = []
    for run in (1, 2, 3):
        rng, power, course = np.random.default_rng(run), _power(run), np.zeros(COUNT)
        for n in range(1, COUNT):
            course[n] = course[n - 1] - (power[n - 1] - course[n - 1]) * np.expm1(-STEP / TAU)
        values = {"first": off * course, "second": off * 2.0 * course * (factor if run == 2 else 1.0)}
        columns = {"t": STEP * np.arange(COUNT), "P": power}
        columns |= {n: values[n] + NOISE * rng.standard_normal(COUNT) for n in channels}
        told = {f"rig.{n}": (n, "W", f"{NOISE} W") for n in channels}
        recordings.append(write_recording(folder / f"run_{run}", columns, {"heater.power": ("P", "W")}, told))
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return list(check_recordings(scenario, [load_recording(r) for r in recordings]))


#: A temperature that settles above the room's, and another that is warmed by it; both begin at 20 degC.
WARM = OdeModel(
    "warmed",
    {"tau": (TAU, "s"), "g": (0.5, "K/W"), "room": (293.15, "K")},
    {"power": "W"},
    {
        "x": ("K", "room", "(room + g*power - x)/tau"),
        "y": ("K", "room", "(x - y)/tau"),
    },
    {"first": ("K", "x"), "second": ("K", "y")},
)


def _warm(folder: Path, factor: float, later: float) -> list[Doubt]:
    """About three runs, in the second of which the second temperature reads a multiple [degC], or begins elsewhere."""
    WARM.build(folder)
    text = SCENARIO.replace("follower", "warmed")
    (folder / "scenario.yaml").write_text(text, encoding="utf-8")
    recordings = []
    for run in (1, 2, 3):
        rng, power = np.random.default_rng(run), _power(run)
        course = np.full((COUNT, 2), 20.0)
        course[0, 1] += later if run == 2 else 0.0
        for n in range(1, COUNT):
            x, y = course[n - 1]
            course[n] = x + STEP / TAU * (20.0 + 0.5 * power[n - 1] - x), y + STEP / TAU * (x - y)
        if run == 2:
            course[:, 1] *= factor
        columns = {"t": STEP * np.arange(COUNT), "P": power}
        columns |= {n: course[:, k] + NOISE * rng.standard_normal(COUNT) for k, n in enumerate(BOTH)}
        told = {f"rig.{n}": (n, "degC", f"{NOISE} K") for n in BOTH}
        recordings.append(write_recording(folder / f"run_{run}", columns, {"heater.power": ("P", "W")}, told))
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return list(check_recordings(scenario, [load_recording(r) for r in recordings]))


def test_a_sensor_that_reads_too_much_from_the_begin_is_no_start(tmp_path: Path) -> None:
    (doubt,) = [d for d in _warm(tmp_path, 1.4, 0.0) if d.is_serious]
    assert (doubt.recording, doubt.subject, doubt.kind) == ("run_2", "rig.second", "unit")
    assert "1.4 times" in doubt.statement


def test_another_start_is_no_sensor_that_reads_too_much(tmp_path: Path) -> None:
    (doubt,) = [d for d in _warm(tmp_path, 1.0, 8.0) if d.is_serious]
    assert (doubt.recording, doubt.subject, doubt.kind) == ("run_2", "rig.second", "start")


def test_what_no_number_of_the_rig_does_is_of_the_sensor(tmp_path: Path) -> None:
    (doubt,) = _doubts(tmp_path, COUPLED)
    assert (doubt.recording, doubt.subject, doubt.kind, doubt.is_serious) == ("run_2", "rig.second", "unit", True)
    assert "0.6 times" in doubt.statement
    assert "calibration or unit than W" in doubt.statement


def test_a_number_that_does_the_same_is_named_and_nothing_is_decided(tmp_path: Path) -> None:
    (doubt,) = _doubts(tmp_path, OWN)
    assert (doubt.subject, doubt.kind, doubt.is_serious) == ("rig.second", "odd one out", False)
    assert "or another rig.h in this recording" in doubt.statement


def test_numbers_that_are_off_in_all_recordings_hide_no_sensor(tmp_path: Path) -> None:
    """The scenario explains none of them within 5 %, so that none stands out."""
    doubts = _doubts(tmp_path, COUPLED, off=1.5)
    assert not [d for d in doubts if "all channels" in d.subject]
    (doubt,) = [d for d in doubts if d.recording == "run_2"]
    assert (doubt.subject, doubt.kind, doubt.is_serious) == ("rig.second", "unit", True)


def test_where_numbers_are_not_tried_that_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(input_runs, "MOST", COUNT // 2)
    (doubt,) = _doubts(tmp_path, COUPLED)
    assert (doubt.subject, doubt.is_serious) == ("rig.second", False)
    assert "was not tried" in doubt.statement


@pytest.mark.parametrize(("factor", "channels"), [(1.15, BOTH), (0.6, ("second",))])
def test_a_small_factor_and_a_channel_alone_are_not_accused(
    tmp_path: Path, factor: float, channels: Sequence[str]
) -> None:
    assert [d for d in _doubts(tmp_path, COUPLED, factor, channels) if d.kind == "unit"] == []
