"""A sensor with another zero in one whole recording: laws that stand in for it are no physics of the rig."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.doubts import is_physics
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

STEP, COUNT, HOLD, NOISE = 0.04, 700, 25, 0.08
#: Readings of the first run: where the one with the fault has more, it bends the numbers.
SHORT = 300
NUMBERS = {"gain": 0.1, "power": 0.7, "settling": 0.4, "thrust_per": 30.0}
MOTOR = OdeModel(
    "motor",
    {name: (value, "1") for name, value in NUMBERS.items()},
    {"feed": "1"},
    {"p": ("1", "2", "(1 + 10*gain*pow(feed, power) - p)/settling")},
    {"chamber": ("1", "p"), "thrust": ("1", "thrust_per*(p - 1)")},
)
SCENARIO = f"""\
title: A motor on a stand
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  valve: {{kind: programme, outputs: {{feed: {{unit: "1", constant: 100}}}}}}
  motor: {{kind: fmu, fmu: motor.fmu, integrator: INTEGRATOR, parameter_set: numbers.yaml}}
connections: [valve.feed -> motor.feed]
"""


def recordings_of(folder: Path, offset: float, integrator: str) -> list[Recording]:
    """Three runs whose true numbers are a little off; in the second the chamber's gauge has another zero."""
    MOTOR.build(folder)
    off = {"gain": 1.03, "power": 0.99, "settling": 1.05, "thrust_per": 0.98}
    true = {n: v * off[n] for n, v in NUMBERS.items()}
    own = {n: {"value": v, "unit": "1", "source": "test", "uncertainty": 0.1} for n, v in NUMBERS.items()}
    (folder / "numbers.yaml").write_text(yaml.safe_dump({"title": "motor", "parameters": own}), encoding="utf-8")
    (folder / "scenario.yaml").write_text(SCENARIO.replace("INTEGRATOR", integrator), encoding="utf-8")
    found = []
    for run in (1, 2, 3):
        rng = np.random.default_rng(20 + run)
        feed = np.repeat(rng.uniform(80.0, 260.0, COUNT // HOLD), HOLD)
        steady, kept = 1.0 + 10.0 * true["gain"] * feed ** true["power"], np.exp(-STEP / true["settling"])
        p: Array = np.full(COUNT, 2.0)
        for n in range(COUNT - 1):
            p[n + 1] = steady[n] + kept * (p[n] - steady[n])
        chamber = p + (offset if run == 2 else 0.0) + NOISE * rng.standard_normal(COUNT)
        thrust = true["thrust_per"] * (p - 1.0) + 30.0 * NOISE * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "u": feed, "p": chamber, "f": thrust}
        columns = {n: v[: SHORT if run == 1 else COUNT] for n, v in columns.items()}
        channels = {"motor.chamber": ("p", "1", f"{NOISE} 1"), "motor.thrust": ("f", "1", f"{30.0 * NOISE} 1")}
        found.append(
            load_recording(write_recording(folder / f"run_{run}", columns, {"valve.feed": ("u", "1")}, channels))
        )
    return found


def answer(folder: Path, recordings: list[Recording]) -> Diagnosis:
    scenario = load_scenario(folder / "scenario.yaml")
    return diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True)).diagnosis


def test_no_law_takes_the_place_of_another_zero_in_one_recording(tmp_path: Path) -> None:
    found = answer(tmp_path, recordings_of(tmp_path, -1.0, "internal"))
    assert not [f.statement for f in found.findings if f.is_accepted and is_physics(f)]
    assert found.verdict in (Verdict.CANNOT_TELL, Verdict.MEASUREMENT_FAULT)
    assert "run_2 stands out" in found.statement
    assert "motor.chamber alone is missed; as if this sensor had another zero, by -" in found.statement, found.statement
    assert [(f.effect, f.place) for f in found.suggestions] == [("sensor_offset_in_interval", "motor.chamber (run_2)")]
    assert not any("not confirmed" in n for n in found.notes)


def test_nothing_is_missing_where_no_zero_is_off(tmp_path: Path) -> None:
    found = answer(tmp_path, recordings_of(tmp_path, 0.0, "cvode"))
    assert found.verdict is Verdict.RECALIBRATED
