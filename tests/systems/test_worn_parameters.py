"""Parameters that change with what has passed: a filter that clogs, a brake lining that wears."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import fits, places_of
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import built, diagnosed, held, write_recording

#: A vessel that empties through a filter.
FILTER = OdeModel(
    "filter",
    {"area": (0.5, "m^2"), "k": (0.02, "m^2/s"), "h_0": (0.2, "m")},
    {"inflow": "m^3/s"},
    {"h": ("m", "h_0", "(inflow - k*h)/area")},
    {"level": ("m", "h"), "outflow": ("m^3/s", "k*h")},
)
SCENARIO = """
title: A filter
time: {stop: 1200 s, macro_step: 2 s, output_step: 2 s}
components:
  pump: {kind: programme, outputs: {inflow: {unit: m^3/s, constant: 0.004 m^3/s}}}
  filter: {kind: fmu, fmu: filter.fmu, integrator: cvode}
connections: [pump.inflow -> filter.inflow]
"""


def _scenario(folder: Path) -> Path:
    return built(FILTER, SCENARIO, folder)


def _diagnosed(folder: Path, clog: float) -> Diagnosis:
    """Three runs from a fresh filter, which loses the share `clog` of its conductance per m^3 of inflow."""
    path = _scenario(folder)
    every = []
    for number in range(3):
        rng = np.random.default_rng(40 + number)
        inflow = np.repeat(rng.uniform(0.001, 0.01, 12), 50)

        def rate(x: Array, u: float) -> Array:
            return np.array([(u - 0.0203 * (1.0 - clog * x[1]) * x[0]) / 0.49, u])

        states = held(rate, np.array([0.2, 0.0]), inflow, 2.0)
        columns = {
            "t": 2.0 * np.arange(len(states)),
            "q": inflow,
            "h": states[:, 0] + 0.003 * rng.standard_normal(len(states)),
            "out": 0.0203 * (1.0 - clog * states[:, 1]) * states[:, 0] + 1e-4 * rng.standard_normal(len(states)),
        }
        channels = {"filter.level": ("h", "m", "0.003 m"), "filter.outflow": ("out", "m^3/s", "1e-4 m^3/s")}
        inputs = {"pump.inflow": ("q", "m^3/s")}
        every.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    return diagnosed(path, every)


def test_a_filter_that_clogs_by_what_flowed_through_it_is_found_with_its_capacity(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.1)
    assert found.verdict is Verdict.UNNAMED_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.place == "filter.k"
    assert finding.effect == "parameter_worn_of_inflow"
    assert finding.parameters[0].value == pytest.approx(-0.1, rel=0.03)
    assert finding.parameters[0].unit == "1/m^3"
    assert "der(passed) = abs(inflow), passed = 0 at the begin" in finding.law


def test_a_filter_that_stays_as_it_is_has_no_such_law(tmp_path: Path) -> None:
    assert not [f for f in _diagnosed(tmp_path, 0.0).findings if f.is_accepted]


def test_what_is_used_up_never_comes_to_less_than_nothing(tmp_path: Path) -> None:
    """A filter that would be clogged at a third of the run: 5 % of its conductance stay, and the run goes on."""
    path = _scenario(tmp_path)
    system = FastSystem(load_scenario(str(path)))
    own = places_of([system])[0]
    worn = next(
        f
        for f in fits([own], library(), 2.0)
        if f.term.identifier == "parameter_worn_of_inflow" and f.placed.parameter == "k"
    )
    system.close()
    system = FastSystem(load_scenario(str(path)), [worn.placed])
    rows = system.simulate(laws={0: (-1.0 / 1.6,)})
    assert rows is not None
    outflow, level = (rows.values[:, system.recorded["filter", n]].ravel() for n in ("outflow", "level"))
    np.testing.assert_allclose(outflow[-100:] / level[-100:], 0.05 * 0.02, rtol=1e-4)
    system.close()


def test_every_parameter_of_the_derivatives_may_wear_by_every_state_and_input(tmp_path: Path) -> None:
    system = FastSystem(load_scenario(str(_scenario(tmp_path))))
    own = places_of([system])[0]
    worn = [f for f in fits([own], library(), 2.0) if f.law.identifier == "parameter_worn"]
    system.close()
    assert {(f.placed.parameter, f.term.identifier) for f in worn} == {
        (parameter, f"parameter_worn_of_{of}") for parameter in ("area", "k") for of in ("inflow", "h")
    }
