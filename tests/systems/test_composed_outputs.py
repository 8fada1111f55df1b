"""Outputs that are made of several states have an equation of their own, from which something may be missing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, Result, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import places_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from diagnosis.write_outputs import write_outputs
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import COUNT, STEP, built, drive, held, write_recording

#: A mass on a foundation that weighs what acts on it: spring and damper together.
STAND = OdeModel(
    "stand",
    {"m": (0.5, "kg"), "k": (200.0, "N/m"), "c": (2.0, "N*s/m"), "b": (50.0, "N/V")},
    {"u": "V"},
    {"x": ("m", "0", "v"), "v": ("m/s", "0", "(b*u - k*x - c*v)/m")},
    {
        "position": ("m", "x"),
        "height": ("m", "2*x"),
        "acceleration": ("m/s^2", "(b*u - k*x - c*v)/m"),
        "force": ("N", "k*x + c*v"),
        "still": ("N", "7"),
    },
)
SCENARIO = """\
title: A mass on a foundation
time: {stop: 4 s, macro_step: 5 ms, output_step: 5 ms}
components:
  drive: {kind: programme, outputs: {u: {unit: V, constant: 0 V}}}
  rig: {kind: fmu, fmu: stand.fmu, integrator: cvode}
connections: [drive.u -> rig.u]
"""
#: Cubic part of the spring [N/m^3].
CUBIC = 9000.0


def rig(folder: Path) -> Path:
    return built(STAND, SCENARIO, folder)


def answer(folder: Path, at_mass: float, at_foundation: float) -> Result:
    """The diagnosis of three recordings of a stand with a cubic spring, of which the last judges."""
    path = rig(folder)
    recordings = []
    for number, size in enumerate((0.3, 0.4, 0.35)):
        u = drive(number, size)

        def rate(s: Array, volt: float) -> Array:
            spring = 202.0 * s[0] + at_mass * s[0] ** 3
            return np.array([s[1], (50.0 * volt - spring - 2.03 * s[1]) / 0.5])

        states = held(rate, np.zeros(2), u, STEP)
        rng = np.random.default_rng(100 + number)
        force = 202.0 * states[:, 0] + at_foundation * states[:, 0] ** 3 + 2.03 * states[:, 1]
        columns = {
            "t": STEP * np.arange(COUNT),
            "u": u,
            "x": states[:, 0] + 1e-3 * rng.standard_normal(COUNT),
            "F": force + 0.3 * rng.standard_normal(COUNT),
        }
        channels = {"rig.position": ("x", "m", "1 mm"), "rig.force": ("F", "N", "0.3 N")}
        recordings.append(
            load_recording(write_recording(folder / f"run_{number + 1}", columns, {"drive.u": ("u", "V")}, channels))
        )
    scenario = load_scenario(path)
    made = diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True))
    write_outputs(made, scenario, recordings[:2], recordings[2:], folder / "answer")
    return made


def test_outputs_that_are_a_state_or_a_derivative_or_a_constant_are_not_made_of_several(tmp_path: Path) -> None:
    scenario = load_scenario(rig(tmp_path))
    outputs = ("position", "height", "acceleration", "force", "still")
    (own,) = places_of([FastSystem(scenario)])
    assert set(own.readings) <= set(outputs)
    assert list(own.readings) == ["force"]


def test_a_force_that_the_mass_and_the_foundation_feel_is_one_law_and_the_amended_model_has_it(tmp_path: Path) -> None:
    made = answer(tmp_path, CUBIC, CUBIC)
    (found,) = made.diagnosis.accepted
    assert found.effect == "cubic_spring_of_what_force_reads"
    assert found.is_named
    assert found.parameters[0].value == pytest.approx(CUBIC / 0.5, rel=0.05)
    assert found.parameters[-1].value == pytest.approx(1.0, abs=0.05)  # the mass is the stated one
    results = run(load_scenario(tmp_path / "answer" / "amended" / "scenario.yaml"))
    assert np.isfinite(results["rig.force"].values).all()


def test_a_spring_beside_what_the_foundation_feels_is_the_mass_alone(tmp_path: Path) -> None:
    made = answer(tmp_path, CUBIC, 0.0)
    (found,) = made.diagnosis.accepted
    assert found.effect == "cubic_spring"
    assert found.parameters[0].value == pytest.approx(CUBIC / 0.5, rel=0.05)


def test_a_sensor_of_the_foundation_alone_is_not_told_of_the_mass(tmp_path: Path) -> None:
    made = answer(tmp_path, 0.0, CUBIC)
    assert {f.effect for f in made.diagnosis.accepted} == {"reading_cubed_of_x"}


def test_a_stand_that_lacks_nothing_has_no_law_there(tmp_path: Path) -> None:
    made = answer(tmp_path, 0.0, 0.0)
    assert made.diagnosis.verdict in (Verdict.RECALIBRATED, Verdict.CONSISTENT)
