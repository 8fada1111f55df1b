"""An input that explains nearly all of the readings is not accused where the model answers to it too much."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

TAU, NOISE, STEP, COUNT = 300.0, 0.05, 10.0, 400
FOLLOWER = OdeModel(
    "follower",
    {"tau": (TAU, "s"), "k": (1.0, "W/K"), "x_0": (20.0, "W")},
    {"power": "W", "room": "K"},
    {"x": ("W", "x_0", "(power + k*(room - 273.15) - x)/tau")},
    {"heat": ("W", "x")},
)
SCENARIO = f"""\
title: A follower in a room
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  heater: {{kind: programme, outputs: {{power: {{unit: W, constant: 0 W}}}}}}
  lab: {{kind: programme, outputs: {{warmth: {{unit: degC, constant: 20 degC}}}}}}
  rig: {{kind: fmu, fmu: follower.fmu, integrator: cvode}}
connections: [heater.power -> rig.power, lab.warmth -> rig.room]
"""


@pytest.mark.parametrize(("swing", "is_accused"), [(1.5, False), (12.0, True)])
def test_a_room_is_not_of_another_experiment_because_the_rig_hardly_feels_it(
    tmp_path: Path, swing: float, is_accused: bool
) -> None:
    """The scenario states no course of the room; the truth does not answer to the room at all."""
    FOLLOWER.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    times, recordings = STEP * np.arange(COUNT), []
    for run in (1, 2, 3):
        rng = np.random.default_rng(run)
        power = np.repeat(rng.uniform(0.0, 20.0, COUNT // 40), 40)
        room = 20.0 + swing * np.sin(2.0 * np.pi * times / (500.0 + 100.0 * run))
        course = np.full(COUNT, 20.0)
        for n in range(1, COUNT):
            course[n] = course[n - 1] - (power[n - 1] + 20.0 - course[n - 1]) * np.expm1(-STEP / TAU)
        points = [[f"{times[n]:g} s", f"{power[n]:.6g} W"] for n in range(0, COUNT, 40)]
        stated = {"components": {"heater": {"outputs": {"power": {"unit": "W", "constant": None, "points": points}}}}}
        extra = yaml.safe_dump({"overrides": stated})
        columns = {"t": times, "R": room, "x": course + NOISE * rng.standard_normal(COUNT)}
        inputs = {"lab.warmth": ("R", "degC")}
        told = {"rig.heat": ("x", "W", f"{NOISE} W")}
        recordings.append(write_recording(tmp_path / f"run_{run}", columns, inputs, told, extra))
    doubts = check_recordings(load_scenario(str(tmp_path / "scenario.yaml")), [load_recording(r) for r in recordings])
    accused = [d for d in doubts if d.is_serious and "another course" in d.statement]
    assert bool(accused) is is_accused, [d.statement for d in doubts if d.is_serious]
