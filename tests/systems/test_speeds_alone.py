"""Two shafts of which only the speeds are states: what rubs between them acts on both, by the ratio of inertias."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import parse_scenario
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import fits, places_of
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import diagnosed, held, write_recording

#: Inertias of the rotor and of the drum that it drives through a clutch [kg*m^2], damping of their bearings [N*m*s].
J_1, J_2, B_1, B_2 = 0.004, 0.03, 2e-3, 6e-3
#: Damping of the clutch [N*m*s/rad], and its dry friction, which the model does not have [N*m].
C, FRICTION = 5e-3, 0.06
STEP, COUNT = 0.02, 600
DRUM = OdeModel(
    "drum",
    {"J_1": (J_1, "kg*m^2"), "J_2": (J_2, "kg*m^2"), "C": (C, "N*m*s/rad"), "B": (B_1, "N*m*s/rad")},
    {"torque": "N*m"},
    {
        "w_1": ("rad/s", "0", "(torque - C*(w_1 - w_2) - B*w_1) / J_1"),
        "w_2": ("rad/s", "0", f"(C*(w_1 - w_2) - {B_2}*w_2) / J_2"),
    },
    {"rotor": ("rad/s", "w_1"), "drum": ("rad/s", "w_2")},
)
SCENARIO = f"""\
title: A rotor that drives a drum through a clutch
time: {{stop: {STEP * COUNT:g} s, macro_step: 20 ms, output_step: 20 ms}}
components:
  motor: {{kind: programme, outputs: {{torque: {{unit: N*m, constant: 0.1 N*m}}}}}}
  drum: {{kind: fmu, fmu: drum.fmu, integrator: cvode}}
connections: [motor.torque -> drum.torque]
"""


def _course(torque: Array) -> Array:
    def rate(x: Array, u: float) -> Array:
        slip = x[0] - x[1]
        through = C * slip + FRICTION * np.tanh(slip / 0.02)
        return np.array([(u - through - B_1 * x[0]) / J_1, (through - B_2 * x[1]) / J_2])

    return held(rate, np.zeros(2), torque, STEP)


def test_only_what_needs_no_distance_is_placed_between_two_speeds(tmp_path: Path) -> None:
    DRUM.build(tmp_path)
    system = FastSystem(parse_scenario(SCENARIO, tmp_path / "scenario.yaml"))
    try:
        found = {f.term.identifier: f for f in fits(places_of([system]), library(), STEP)}
    finally:
        system.close()
    coupled = {name for name in found if name.startswith("coupling_") and found[name].term.is_named}
    assert coupled == {"coupling_damping_of_w_2", "coupling_friction_of_w_2"}
    friction = found["coupling_friction_of_w_2"]
    assert friction.placed.to == "der(w_1)"
    assert friction.reaction is not None
    assert friction.reaction.to == "der(w_2)"
    assert friction.reaction.formula == "ratio * friction * tanh((w_1 - w_2) / rounding)"


def test_a_clutch_that_rubs_is_told_with_its_torque_and_the_ratio_of_inertias(tmp_path: Path) -> None:
    DRUM.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    every = []
    for number in range(3):
        rng = np.random.default_rng(number)
        torque = np.repeat(rng.uniform(-0.3, 0.3, 15), 40)
        speeds = _course(torque)
        columns = {"t": STEP * np.arange(COUNT), "M": torque}
        columns |= {name: speeds[:, i] + 0.05 * rng.standard_normal(COUNT) for i, name in enumerate(("rotor", "drum"))}
        channels = {f"drum.{name}": (name, "rad/s", "0.05 rad/s") for name in ("rotor", "drum")}
        path = write_recording(tmp_path / f"run_{number + 1}", columns, {"motor.torque": ("M", "N*m")}, channels)
        every.append(load_recording(path))
    found = diagnosed(tmp_path / "scenario.yaml", every)
    assert found.verdict is Verdict.MISSING_PHYSICS, found.statement
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.is_named) == ("coupling_friction_of_w_2", True)
    numbers = {p.name: p.value for p in finding.parameters}
    assert numbers["friction"] == pytest.approx(FRICTION / J_1, rel=0.03)
    assert numbers["ratio"] == pytest.approx(J_1 / J_2, rel=0.05)
