"""Outputs that are a part of a derivative: a load cell, a flow meter, a heat flux; a law in that part shows in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import parse_scenario
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.models.systems.quantities import Places
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import diagnosed, held, write_recording

#: Inertia of a drum [kg], of a load [kg], stiffness of the tendon between them [N/m], friction of both [N s/m].
DRUM, LOAD, TENDON, LOSS = 0.8, 1.5, 400.0, 6.0
STEP, COUNT = 0.01, 1200
TENDONS = OdeModel(
    "tendon",
    {"m_1": (DRUM, "kg"), "m_2": (LOAD, "kg"), "k": (TENDON, "N/m"), "d": (LOSS, "N*s/m")},
    {"pull": "N"},
    {
        "x": ("m", "0", "v"),
        "v": ("m/s", "0", "(pull - k*(x - y) - d*v)/m_1"),
        "y": ("m", "0", "w"),
        "w": ("m/s", "0", "(k*(x - y) - d*w - 200.0*y)/m_2"),
    },
    {
        "drum": ("m", "x"),
        "load": ("m", "y"),
        "cell": ("N", "k*(x - y)"),
        "apart": ("m", "x - y"),
        "pot": ("V", "5.0*y"),
    },
)
SCENARIO = f"""
title: A drum that pulls a load by a tendon with a load cell
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  motor: {{kind: programme, outputs: {{pull: {{unit: N, points: [[0 s, 1 N], [5 s, -2 N]]}}}}}}
  tendon: {{kind: fmu, fmu: tendon.fmu, integrator: cvode}}
connections: [motor.pull -> tendon.pull]
"""
FLOWS = OdeModel(
    "flows",
    {"A": (0.5, "m^2"), "c": (0.02, "m^2/s"), "C": (900.0, "J/K"), "G": (3.0, "W/K")},
    {"inflow": "m^3/s", "heat": "W"},
    {
        "h": ("m", "0.4", "(inflow - c*(h - j))/A"),
        "j": ("m", "0.3", "(c*(h - j) - c*j)/A"),
        "T": ("K", "300", "(heat - G*(T - S))/C"),
        "S": ("K", "295", "(G*(T - S) - G*(S - 293.15))/C"),
    },
    {"meter": ("m^3/s", "c*(h - j)"), "flux": ("W", "G*(T - S)"), "supply": ("W", "heat"), "level": ("m", "h")},
)
FLOWS_SCENARIO = """
title: Two tanks, two walls
time: {stop: 60 s, macro_step: 1 s, output_step: 1 s}
components:
  pump: {kind: programme, outputs: {flow: {unit: m^3/s, points: [[0 s, 0.01 m^3/s], [20 s, 0 m^3/s]]}}}
  heater: {kind: programme, outputs: {power: {unit: W, points: [[0 s, 50 W], [30 s, 0 W]]}}}
  flows: {kind: fmu, fmu: flows.fmu, integrator: cvode}
connections: [pump.flow -> flows.inflow, heater.power -> flows.heat]
"""


def _places(model: OdeModel, text: str, folder: Path) -> tuple[Places, list[Fit]]:
    model.build(folder)
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    try:
        (own,) = places_of([system])
        return own, list(fits([own], library(), 1.0))
    finally:
        system.close()


def test_a_load_cell_is_minus_the_inertia_times_a_part_of_an_acceleration(tmp_path: Path) -> None:
    own, found = _places(TENDONS, SCENARIO, tmp_path)
    assert {state: set(outputs) for state, outputs in own.parts_read.items()} == {"v": {"cell"}}  # w is held by a wall
    factor, over = own.parts_read["v"]["cell"]
    assert factor == pytest.approx(-DRUM, rel=1e-6)
    assert over == {"x", "y", "v", "w"}
    read = {f.law.identifier for f in found if f.seen_by == "cell"}
    assert {"coupling_cubic_spring", "coupling_damping", "coupling_friction", "coupling_play"} <= read
    assert not {"constant_force", "coupling_delayed_spline"} & read
    beside = {f.law.identifier for f in found if not f.seen_by}
    assert read <= beside  # what acts beside the tendon shows in no load cell


def test_a_flow_meter_and_a_heat_flux_read_an_exchange_and_a_supply_does_not(tmp_path: Path) -> None:
    own, found = _places(FLOWS, FLOWS_SCENARIO, tmp_path)
    assert {s: {n: f for n, (f, _) in outputs.items()} for s, outputs in own.parts_read.items()} == {
        "h": {"meter": pytest.approx(-0.5, rel=1e-6)},
        "T": {"flux": pytest.approx(-900.0, rel=1e-6)},
    }
    read = {(f.law.identifier, f.seen_by) for f in found if f.seen_by}
    assert {("turbulent_exchange_flow", "meter"), ("exchange_by_radiation", "flux")} <= read
    assert not [law for law, output in read if output == "supply"]


def _diagnosed(folder: Path, is_read: bool) -> Diagnosis:
    """Three runs of a tendon that becomes stiffer, or of a band beside it that does; numbers 1 to 2 % off."""
    TENDONS.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    every = []
    for number in range(3):
        rng = np.random.default_rng(50 + number)
        pull = np.repeat(rng.uniform(-30.0, 30.0, COUNT // 40), 40)

        def carried(x: Array) -> tuple[float, float]:
            apart = float(x[0] - x[2])
            return 404.0 * apart, 9e4 * apart**3

        def rate(x: Array, u: float) -> Array:
            linear, more = carried(x)
            v = (u - linear - more - 6.1 * x[1]) / 0.79
            return np.array([x[1], v, x[3], (linear + more - 6.1 * x[3] - 200.0 * x[2]) / 1.52])

        states = held(rate, np.zeros(4), pull, STEP)
        cell = np.array([sum(carried(x)) if is_read else carried(x)[0] for x in states])
        columns = {"t": STEP * np.arange(COUNT), "F": pull, "cell": cell + 0.1 * rng.standard_normal(COUNT)}
        columns |= {n: states[:, i] + 2e-4 * rng.standard_normal(COUNT) for n, i in (("x", 0), ("y", 2))}
        channels = {
            "tendon.drum": ("x", "m", "0.2 mm"),
            "tendon.load": ("y", "m", "0.2 mm"),
            "tendon.cell": ("cell", "N", "0.1 N"),
        }
        path = write_recording(folder / f"run_{number}", columns, {"motor.pull": ("F", "N")}, channels)
        every.append(load_recording(path))
    return diagnosed(folder / "scenario.yaml", every)


@pytest.mark.parametrize("is_read", [True, False], ids=["in the tendon", "beside it"])
def test_a_spring_that_hardens_is_found_in_what_the_load_cell_reads_or_beside_it(tmp_path: Path, is_read: bool) -> None:
    found = _diagnosed(tmp_path, is_read)
    assert found.verdict is Verdict.MISSING_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.effect.startswith("coupling_cubic_spring")
    assert finding.effect.endswith("_of_what_cell_reads") == is_read
    assert finding.is_named
    assert finding.parameters[0].lower < 9e4 / 0.79 < finding.parameters[0].upper
