"""A finger that a tendon bends: what the tendon loses in its sheath grows with its pull and turns with the motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

INERTIA, DAMPING, RETURN, LEVER = 2e-3, 0.03, 0.6, 0.012  # kg m^2, N m s, N m, m
#: Share of the pull that the sheath takes, and the speed within which it sets in [rad/s].
SHARE, ROUNDING = 0.18, 0.05
STEP, COUNT, NOISE = 0.01, 1200, 2e-3
FINGER = OdeModel(
    "finger",
    {"J": (INERTIA, "kg*m^2"), "d": (DAMPING, "N*m*s"), "k": (RETURN, "N*m"), "r": (LEVER, "m")},
    {"pull": "N", "load": "N*m"},
    {"phi": ("rad", "0", "w"), "w": ("rad/s", "0", "(r*pull - load - k*phi - d*w)/J")},
    {"bend": ("rad", "phi")},
)
SCENARIO = f"""\
title: A finger on a tendon
time: {{stop: {STEP * COUNT:g} s, macro_step: 10 ms, output_step: 10 ms}}
components:
  motor: {{kind: programme, outputs: {{pull: {{unit: N, constant: 0 N}}}}}}
  hand: {{kind: programme, outputs: {{load: {{unit: N*m, constant: 0 N*m}}}}}}
  finger: {{kind: fmu, fmu: finger.fmu, integrator: cvode}}
connections: [motor.pull -> finger.pull, hand.load -> finger.load]
"""


def course(pull: Array, load: Array, by_pull: float, always: float) -> Array:
    """Angles at the begin of every step [rad], with friction of a share of the pull and of a constant moment."""
    found, state = np.empty(len(pull)), np.zeros(2)
    for k, (force, moment) in enumerate(zip(pull, load)):
        found[k] = state[0]

        def rate(t: float, y: Array, force: float = force, moment: float = moment) -> list[float]:
            rubs = (LEVER * by_pull * abs(force) + always) * np.tanh(y[1] / ROUNDING)
            return [y[1], (LEVER * force - moment - RETURN * y[0] - DAMPING * y[1] - rubs) / INERTIA]

        state = solve_ivp(rate, (0.0, STEP), state, method="Radau", rtol=1e-7, atol=1e-9).y[:, -1]
    return found


def answer(folder: Path, by_pull: float, always: float) -> Diagnosis:
    """The diagnosis of three recordings, of which the last judges."""
    FINGER.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    recordings: list[Recording] = []
    for number in range(3):
        rng = np.random.default_rng([23, number])
        pull = np.repeat(rng.uniform(5.0, 45.0, COUNT // 40), 40)
        load = np.repeat(rng.uniform(-0.05, 0.2, COUNT // 60), 60)
        bend = course(pull, load, by_pull, always) + NOISE * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "F": pull, "M": load, "phi": bend}
        inputs = {"motor.pull": ("F", "N"), "hand.load": ("M", "N*m")}
        channels = {"finger.bend": ("phi", "rad", f"{1e3 * NOISE:g} mrad")}
        recordings.append(load_recording(write_recording(folder / f"run_{number + 1}", columns, inputs, channels)))
    scenario = load_scenario(folder / "scenario.yaml")
    made = diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True))
    return made.diagnosis


def test_friction_that_grows_with_the_pull_is_named_with_its_size(tmp_path: Path) -> None:
    found = answer(tmp_path, SHARE, 0.0)
    assert found.verdict is Verdict.MISSING_PHYSICS
    (one,) = found.accepted
    assert one.effect == "load_friction_of_pull"
    assert "pull" in one.law
    assert one.parameters[0].value == pytest.approx(SHARE * LEVER / INERTIA, rel=0.1)
    assert one.parameters[0].lower < SHARE * LEVER / INERTIA < one.parameters[0].upper


def test_friction_that_does_not_is_not_called_so(tmp_path: Path) -> None:
    found = answer(tmp_path, 0.0, 0.06)
    assert found.verdict is Verdict.MISSING_PHYSICS
    (one,) = found.accepted
    assert one.effect == "dry_friction"
    assert one.parameters[0].value == pytest.approx(0.06 / INERTIA, rel=0.1)
