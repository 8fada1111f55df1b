"""Readings that repeat one value: a sensor that stood still, or one that rounds what follows an input at once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

STEP, COUNT = 3.0, 400
#: Currents at which the volts lie between two of their steps, so that noise shows, and one in the middle of a step [A].
LEVELS = np.array([0.325, 0.925, 0.425, 0.875, 0.45, 0.225, 0.575, 0.775, 0.375, 0.825])
LAMP = OdeModel(
    "lamp",
    {"tau": (200.0, "s"), "v": (16.0, "V"), "r": (2.0, "ohm")},
    {"amps": "A"},
    {"x": ("A", "0", "(amps - x)/tau")},
    {"volts": ("V", "v + r*amps"), "warm": ("A", "x")},
)
SCENARIO = f"""\
title: A lamp that is dimmed
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  supply: {{kind: programme, outputs: {{amps: {{unit: A, constant: 0 A}}}}}}
  rig: {{kind: fmu, fmu: lamp.fmu, integrator: cvode}}
connections: [supply.amps -> rig.amps]
"""


def _doubts(folder: Path, stuck: slice | None) -> list[Doubt]:
    """About a run whose current changes every 120 s; volts are rounded to 0.1 V, with a noise of 0.01 V."""
    LAMP.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    rng = np.random.default_rng(5)
    amps = np.repeat(LEVELS, 40)
    warm: Array = np.zeros(COUNT)
    for n in range(1, COUNT):
        warm[n] = warm[n - 1] - (amps[n - 1] - warm[n - 1]) * np.expm1(-STEP / 200.0)
    volts = np.round(10.0 * (16.0 + 2.0 * amps + 0.01 * rng.standard_normal(COUNT))) / 10.0
    if stuck is not None:
        volts[stuck] = volts[stuck.start]
    columns = {"t": STEP * np.arange(COUNT), "I": amps, "U": volts, "w": warm + 0.01 * rng.standard_normal(COUNT)}
    told = {"rig.volts": ("U", "V", "0.01 V"), "rig.warm": ("w", "A", "0.01 A")}
    recording = write_recording(folder / "run", columns, {"supply.amps": ("I", "A")}, told)
    every = check_recordings(load_scenario(folder / "scenario.yaml"), [load_recording(recording)])
    return [d for d in every if "stood still" in d.statement]


def test_what_follows_its_input_at_once_repeats_a_value_until_that_changes(tmp_path: Path) -> None:
    assert _doubts(tmp_path, None) == []


def test_a_sensor_that_stands_still_over_changes_of_its_input_is_told(tmp_path: Path) -> None:
    (told,) = _doubts(tmp_path, slice(150, 225))
    assert (told.subject, told.is_serious) == ("rig.volts", True)
    assert (told.begin, told.end) == pytest.approx((150 * STEP, 224 * STEP), abs=35 * STEP)
