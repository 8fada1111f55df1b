"""A law over a quantity of a component to which nothing connects the place where it acts, found from recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import diagnosed, held, write_recording

#: A carriage under a force, and a coil that is fed along the rail on which it runs.
CARRIAGE = OdeModel(
    "carriage",
    {"m": (2.0, "kg"), "d": (1.5, "N*s/m")},
    {"force": "N"},
    {"x": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(force - d*v)/m")},
    {"speed": ("m/s", "v")},
)
COIL = OdeModel(
    "coil",
    {"R": (4.0, "ohm"), "L": (2.0, "H")},
    {"volts": "V"},
    {"i": ("A", "0.0", "(volts - R*i)/L")},
    {"amps": ("A", "i")},
    5e-3,
)
SCENARIO = """
title: A coil that is fed along a rail
time: {stop: 60 s, macro_step: 50 ms, output_step: 100 ms}
components:
  drive: {kind: programme, outputs: {force: {unit: N, constant: 0 N}, volts: {unit: V, constant: 0 V}}}
  carriage: {kind: fmu, fmu: carriage.fmu, integrator: cvode}
  coil: {kind: fmu, fmu: coil.fmu, integrator: internal}
connections: [drive.force -> carriage.force, drive.volts -> coil.volts]
"""
#: Resistance of the rail [ohm/m].
RAIL = 0.9


def _diagnosed(folder: Path, rail: float) -> Diagnosis:
    """Three runs in which the current flows through as much rail as the carriage has run along."""
    for model in (CARRIAGE, COIL):
        model.build(folder)
    path = folder / "scenario.yaml"
    path.write_text(SCENARIO, encoding="utf-8")
    every = []
    for number in range(3):
        rng = np.random.default_rng(40 + number)
        force = np.repeat(rng.uniform(-2.0, 3.0, 30), 40)
        volts = np.repeat(rng.uniform(2.0, 12.0, 40), 30)

        def rate(x: Array, step: float) -> Array:
            pull, feed = force[int(step)], volts[int(step)]  # noqa: B023  # called within this run
            return np.array([x[1], (pull - 1.48 * x[1]) / 2.02, (feed - (4.05 + rail * x[0]) * x[2]) / 1.97])

        states = held(rate, np.zeros(3), np.arange(1200.0), 0.05)[::2]
        count = len(states)
        columns = {
            "t": 0.1 * np.arange(count),
            "force": force[::2][:count],
            "volts": volts[::2][:count],
            "v": states[:, 1] + 0.01 * rng.standard_normal(count),
            "i": states[:, 2] + 0.01 * rng.standard_normal(count),
        }
        inputs = {"drive.force": ("force", "N"), "drive.volts": ("volts", "V")}
        channels = {"carriage.speed": ("v", "m/s", "1 cm/s"), "coil.amps": ("i", "A", "10 mA")}
        every.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    return diagnosed(path, every)


def test_a_resistance_that_grows_with_where_another_component_is_needs_its_place(tmp_path: Path) -> None:
    """Nobody recorded the place: the model has it, and no law at the coil alone is the product of both."""
    found = _diagnosed(tmp_path, RAIL)
    assert found.verdict is Verdict.UNNAMED_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.place, finding.effect) == ("coil.volts", "far_output_product_of_amps_of_carriage_x")
    (strength,) = finding.parameters
    assert strength.value == pytest.approx(-RAIL, rel=0.03)
    assert "carriage_x = carriage.x" in finding.law


def test_a_rail_that_conducts_has_no_such_law(tmp_path: Path) -> None:
    assert not [f for f in _diagnosed(tmp_path, 0.0).findings if f.is_accepted]
