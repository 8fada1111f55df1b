"""A fan that never turns back, beside a heater that radiates: what rubs in its bearings may be a constant force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from diagnosis.judge.diagnosis import Standing, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.report.sentences import ambiguity, what
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import diagnosed, write_recording

INERTIA, TORQUE, DRAG, CAPACITY, LOSS, ROOM = 5e-3, 0.02, 2e-5, 20.0, 0.3, 293.0
#: Torque of the bearings [N m], and emissivity times surface times Stefan and Boltzmann's constant [W/K^4].
RUBS, RADIATES = 0.02, 4e-10
STEP, COUNT = 0.1, 600
RIG = OdeModel(
    "dryer_fan",
    {
        "J": (INERTIA, "kg*m^2"),
        "k": (TORQUE, "N*m/V"),
        "c": (DRAG, "N*m*s^2"),
        "C": (CAPACITY, "J/K"),
        "G": (LOSS, "W/K"),
        "room": (ROOM, "K"),
    },
    {"volts": "V", "power": "W"},
    {"w": ("rad/s", "60", "(k*volts - c*w*w)/J"), "T": ("K", f"{ROOM}", "(power - G*(T - room))/C")},
    {"speed": ("rad/s", "w"), "warmth": ("K", "T")},
)
SCENARIO = f"""\
title: A fan and a heater
time: {{stop: {STEP * COUNT:g} s, macro_step: 100 ms, output_step: 100 ms}}
components:
  dials:
    kind: programme
    outputs: {{volts: {{unit: V, constant: 8 V}}, power: {{unit: W, constant: 0 W}}}}
  dryer: {{kind: fmu, fmu: dryer_fan.fmu, integrator: cvode}}
connections: [dials.volts -> dryer.volts, dials.power -> dryer.power]
"""
NOISE = {"speed": 0.1, "warmth": 0.1}


def test_the_law_found_first_is_compared_with_its_twin_once_the_other_is_there(tmp_path: Path) -> None:
    RIG.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    recordings = []
    for number in range(3):
        rng = np.random.default_rng([7, number])
        volts = np.repeat(rng.uniform(5.0, 12.0, COUNT // 50), 50)
        power = np.repeat(rng.uniform(0.0, 80.0, COUNT // 100), 100)
        found, state = np.empty((COUNT, 2)), np.array([60.0, ROOM])
        for n in range(COUNT):
            found[n] = state

            def rate(t: float, y: np.ndarray, u: float = volts[n], p: float = power[n]) -> list[float]:
                lost = LOSS * (y[1] - ROOM) + RADIATES * (y[1] ** 4 - ROOM**4)
                return [(TORQUE * u - DRAG * y[0] ** 2 - RUBS) / INERTIA, (p - lost) / CAPACITY]

            state = solve_ivp(rate, (0.0, STEP), state, rtol=1e-9, atol=1e-9).y[:, -1]
        assert found[:, 0].min() > 30.0  # it never turns back
        columns = {"t": STEP * np.arange(COUNT), "U": volts, "P": power}
        columns |= {n: found[:, i] + NOISE[n] * rng.standard_normal(COUNT) for i, n in enumerate(NOISE)}
        inputs = {"dials.volts": ("U", "V"), "dials.power": ("P", "W")}
        channels = {"dryer.speed": ("speed", "rad/s", "0.1 rad/s"), "dryer.warmth": ("warmth", "K", "0.1 K")}
        recordings.append(load_recording(write_recording(tmp_path / f"run_{number + 1}", columns, inputs, channels)))
    made = diagnosed(tmp_path / "scenario.yaml", recordings)
    assert made.verdict is Verdict.MISSING_PHYSICS
    assert len([f for f in made.findings if f.is_accepted]) > 1
    (one,) = [f for f in made.findings if f.is_accepted and f.place in ("dryer.w", "dryer.volts")]
    assert one.standing is Standing.CLASS
    assert {one.effect, *one.ambiguous_with} >= {"constant_force", "dry_friction", "input_offset"}
    assert "probability" not in what(one)
    if one.place == "dryer.volts":
        assert "dry friction at dryer.w" in ambiguity(one)
    else:
        assert "input offset at dryer.volts" in ambiguity(one)
