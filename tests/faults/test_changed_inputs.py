"""What faults of inputs do to a system of FMUs in compiled code, wherever their interval lies."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import Scenario, parse_scenario
from cosim.unit.protocol import Array
from diagnosis.faults.programme import InputChange
from diagnosis.models.systems.fast import FastSystem
from diagnosis.search.cosim_run import Changes, changed
from tests.systems.rigs import TANK

SCENARIO = """
title: A tank
time: {stop: 60 s, macro_step: 1 s, output_step: 1 s}
components:
  pump:
    kind: programme
    outputs: {flow: {unit: m^3/s, points: [[0 s, 0.01 m^3/s], [20 s, 0 m^3/s], [50 s, 0.02 m^3/s]]}}
  tank: {kind: fmu, fmu: tank.fmu, integrator: cvode}
connections: [pump.flow -> tank.inflow]
"""


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    folder = tmp_path_factory.mktemp("tank")
    TANK.build(folder)
    return parse_scenario(SCENARIO, folder / "scenario.yaml")


@pytest.fixture(scope="module")
def system(scenario: Scenario) -> Iterator[FastSystem]:
    found = FastSystem(scenario)
    yield found
    found.close()


def _levels(system: FastSystem, change: InputChange | None = None) -> Array:
    changes = Changes() if change is None else Changes(faults={"pump": {"flow": (change,)}})
    rows = system.simulate(changes)
    assert rows is not None
    return np.asarray(rows.values[:, system.recorded["tank", "level"]][:, 0]).copy()


FAULTS = {
    "unstated, within a stretch of zero": InputChange(0.005, 30.0, 40.0, True),
    "unstated, over the edges of that stretch": InputChange(0.005, 15.0, 55.0, True),
    "a share of what is stated": InputChange(0.5, 5.0, 15.0),
    "stays where it was": InputChange(1.0, 10.0, 30.0, is_held=True),
    "to the end of the run": InputChange(0.5, 55.0, 60.0),
}


@pytest.mark.parametrize("change", FAULTS.values(), ids=FAULTS)
def test_it_does_what_it_does_in_the_co_simulation(scenario: Scenario, system: FastSystem, change: InputChange) -> None:
    """The tank is linear, and its FMU integrates exactly enough: 1e-5 of a metre is its tolerance over a minute."""
    plain, found = _levels(system), _levels(system, change)
    expected = run(changed(scenario, Changes(faults={"pump": {"flow": (change,)}})))["tank.level"].values
    assert np.max(np.abs(expected - plain)) > 0.01
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_what_is_stated_as_zero_gets_what_acts_and_nothing_else_does(system: FastSystem) -> None:
    """5 L/s over 10 s are 50 L, on 0.5 m^2: a rise by 0.1 m, less what runs out meanwhile."""
    rise = _levels(system, FAULTS["unstated, within a stretch of zero"]) - _levels(system)
    assert np.all(rise[:31] == 0.0)
    assert 0.07 < rise[40] < 0.1
    over_edges = _levels(system, FAULTS["unstated, over the edges of that stretch"]) - _levels(system)
    assert np.all(over_edges[:21] == 0.0)  # until 20 s something is stated


@pytest.mark.parametrize("is_held", [False, True])
@pytest.mark.parametrize("is_added", [False, True])
def test_an_interval_after_the_last_step_changes_nothing(system: FastSystem, is_added: bool, is_held: bool) -> None:
    change = InputChange(0.5, 60.2, 60.4, is_added, is_held=is_held)
    np.testing.assert_array_equal(_levels(system, change), _levels(system))
