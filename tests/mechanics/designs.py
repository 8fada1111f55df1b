"""Fabrics for tests, built from the shipped parameter set."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.mechanics_assembly import FABRIC_UNITS
from cosim.parameters import resolve
from cosim.scenario import scenario_folder
from mechanics.fabric import FabricDesign
from mechanics.solver import SolverSettings
from mechanics.unit import FabricUnit

COLD, HOT, REST = 157.1, 356.0, 0.0094
#: The shipped defaults, without friction anchors: links as Bullet itself has them.
SOLVER = SolverSettings(micro_step=5e-4, iterations=200, penetration_limit=1e-3)
STEP = 10_000_000


def prototype(**changes: Any) -> FabricDesign:
    """The 2 x 6 prototype, with changes."""
    values = resolve("prototype_links", {}, scenario_folder() / "test.yaml").values
    numbers: dict[str, Any] = {k: v.to(FABRIC_UNITS[k]) for k, v in values.items()}  # type: ignore[union-attr]
    base = {"rows": 6, "columns": 2, "tether_rows": 2, "tether_kind": "cantilever", **numbers}
    return FabricDesign(**{**base, **changes})


def woven_unit(design: FabricDesign, stiffness: float = COLD, solver: SolverSettings = SOLVER) -> FabricUnit:
    """A fabric unit at time 0."""
    unit = FabricUnit("fabric", design, solver)
    unit.set("stiffness", np.full(2 * design.links, stiffness))
    unit.set("rest_length", np.full(2 * design.links, REST))
    unit.initialise(0)
    return unit


def advance(unit: FabricUnit, seconds: float, begin: int = 0) -> dict[str, np.ndarray]:
    """Step on; returns the series of every scalar output and the link lengths."""
    names = [n for n, v in unit.variables.items() if v.shape == ()] + ["link_length"]
    series: dict[str, list] = {n: [] for n in names}
    for index in range(round(seconds * 1e9) // STEP):
        unit.do_step(begin + index * STEP, STEP)
        for n in names:
            series[n].append(unit.get(n).copy())
    return {n: np.array(v) for n, v in series.items()}
