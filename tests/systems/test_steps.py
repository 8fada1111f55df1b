"""A time constant far below the macro-step: the integration takes shorter steps, and laws have their places."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import parse_scenario
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.places import places_of
from diagnosis.models.systems.steps import _is_same, resolve
from evaluation.fmus.model import OdeModel

R, SCENARIO = (
    2.0,
    """\
title: A winding
time: {stop: 0.5 s, macro_step: 10 ms, output_step: 10 ms}
components:
  source: {kind: programme, outputs: {u: {unit: V, points: [[0 s, 6 V], [0.25 s, 3 V]]}}}
  coil: {kind: fmu, fmu: winding.fmu, integrator: cvode}
connections: [source.u -> coil.u]
""",
)


def winding(folder: Path, inductance: float) -> FastSystem:
    """A winding of 2 ohm."""
    OdeModel(
        "winding",
        {"R": (R, "ohm"), "L": (inductance, "H")},
        {"u": "V"},
        {"i": ("A", "0", "(u - R*i) / L")},
        {"current": ("A", "i")},
    ).build(folder)
    return FastSystem(parse_scenario(SCENARIO, folder / "scenario.yaml"))


def test_a_winding_of_two_milliseconds_is_resolved_at_a_macro_step_of_ten(tmp_path: Path) -> None:
    """Closed form: u / R behind a lag of L / R = 2 ms; one Runge-Kutta step of 10 ms multiplies the error by 13.7."""
    system = winding(tmp_path, 4e-3)
    assert system.simulate() is None or not np.isclose(system.simulate().values[-1, 0], 1.5, rtol=1e-3)
    values = resolve(system)
    assert values is not None
    current = values[:, system.recorded["coil", "current"]][:, 0]
    t = system.times
    wanted = np.where(t <= 0.25, 3.0 * (1.0 - np.exp(-t / 2e-3)), 1.5 + 1.5 * np.exp(-(t - 0.25) / 2e-3))
    np.testing.assert_allclose(current, wanted, atol=5e-3)
    (places,) = places_of([system])
    assert list(places.states) == ["i"]
    assert places.states["i"].size == pytest.approx(np.sqrt(np.mean(wanted**2)), rel=0.01)
    system.close()


def test_a_winding_that_no_step_resolves_is_left_to_the_co_simulation(tmp_path: Path) -> None:
    system = winding(tmp_path, 1e-8)  # 5 ns: two million steps in each macro-step
    assert resolve(system) is None
    with pytest.raises(NotFast, match="a simulation stops"):
        places_of([system])
    system.close()


def test_a_run_that_grew_beyond_all_measure_is_never_the_same_as_the_next() -> None:
    before = np.array([[0.0], [1e200], [-3e220]])
    assert not _is_same(before, np.array([[0.0], [1.0], [1.5]]))
    assert not _is_same(np.array([[0.0], [1.0], [1.5]]), before)
    assert not _is_same(before, before)  # both ran away
    assert _is_same(np.array([[0.0], [1.0], [1.5]]), np.array([[0.0], [1.0], [1.5 + 1e-4]]))
