"""FMUs that list no dependencies of outputs on inputs: a ring of them need not be an algebraic loop."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import NotFast
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import LUMP

SCENARIO = """\
title: Two lumps that exchange heat
time: {stop: 60 s, macro_step: 100 ms, output_step: 100 ms}
components:
  heater:
    kind: programme
    outputs: {P: {unit: W, points: [[0 s, 0 W], [5 s, 40 W], [30 s, 0 W]]}, none: {unit: W, constant: 0 W}}
  first: {kind: fmu, fmu: first.fmu, integrator: INTEGRATOR}
  second: {kind: fmu, fmu: second.fmu, integrator: INTEGRATOR, start: {room: 300 K}}
connections:
  - heater.P -> first.power
  - heater.none -> second.power
  - second.temperature -> first.room
  - first.temperature -> second.room
"""


@dataclass(frozen=True)
class Undeclared(OdeModel):
    """An FMU whose description lists no dependencies, as most tools export them."""

    def description(self, guid: str) -> str:
        """See `OdeModel`."""
        return re.sub(r' dependencies="[^"]*"', "", super().description(guid))


def _ring(folder: Path, integrator: str, outputs: dict[str, tuple[str, str]] | None = None) -> Path:
    for name, capacity in (("first", 50.0), ("second", 80.0)):
        parameters = {**LUMP.parameters, "capacity": (capacity, "J/K")}
        own = outputs or LUMP.outputs
        Undeclared(name, parameters, LUMP.inputs, LUMP.states, own, LUMP.inner_step).build(folder)
    path = folder / "scenario.yaml"
    path.write_text(SCENARIO.replace("INTEGRATOR", integrator), encoding="utf-8")
    return path


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_a_ring_without_declared_dependencies_is_simulated_as_the_co_simulation_does(
    tmp_path: Path, integrator: str
) -> None:
    scenario = load_scenario(str(_ring(tmp_path, integrator)))
    system = FastSystem(scenario)
    system.set_substeps(8)
    rows = system.simulate()
    assert rows is not None
    results = run(scenario)
    for name in ("first", "second"):
        there = results[f"{name}.temperature"].values
        mine = rows.values[:, system.recorded[name, "temperature"]][:, 0]
        # CVODE integrates to 1e-6 of 300 K in each step, and steps differ.
        np.testing.assert_allclose(mine, there, rtol=0.0, atol=2e-3)
        assert there.max() > 303.0
    system.close()


def test_outputs_that_follow_each_other_at_once_are_refused(tmp_path: Path) -> None:
    scenario = load_scenario(str(_ring(tmp_path, "cvode", {"temperature": ("K", "0.5 * T + 0.5 * room")})))
    with pytest.raises(NotFast, match="outputs of its FMUs follow each other at once"):
        FastSystem(scenario)
