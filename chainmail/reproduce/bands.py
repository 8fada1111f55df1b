"""The same experiments from several starts in the faster engine: how much of a curve is one draw of the contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from chainmail.reproduce.row import Row
from cosim.components import FabricComponent
from cosim.scenario import Scenario
from cosim.unit.quantity import PhysicalValue

#: How the engine of the bands is called where users read it.
ENGINE = "MuJoCo"
#: Micro-step of that engine [ms] (docs/engines.md).
_MICRO_STEP = 0.25


def is_available() -> bool:
    """Whether the engine of the bands is installed."""
    from mechanics.mujoco_world import MujocoMissing, load_mujoco

    try:
        load_mujoco()
    except MujocoMissing:
        return False
    return True


def in_mujoco(scenario: Scenario) -> Scenario:
    """The scenario with its fabrics in MuJoCo; the title says so."""
    changed = {name: _moved(c) for name, c in scenario.components.items() if isinstance(c, FabricComponent)}
    head, bracket, rest = scenario.title.partition(" (")
    title = f"{head}, in {ENGINE}{bracket}{rest}"
    return scenario.model_copy(update={"components": {**scenario.components, **changed}, "title": title})


def _moved(fabric: FabricComponent) -> FabricComponent:
    solver = fabric.solver.model_copy(update={"micro_step": PhysicalValue(_MICRO_STEP, "ms")})
    return fabric.model_copy(update={"engine": "mujoco", "solver": solver})


def with_bands(rows: Sequence[Row], banded: Sequence[Row]) -> list[Row]:
    """Rows of our run with the medians and bands of others, which decide the verdict where there are any.

    Args:
        rows: Of the single runs.
        banded: The same rows over the starts of ensembles.

    Raises:
        ValueError: They are not the same rows.
    """
    return [_with_band(own, other) for own, other in zip(rows, banded, strict=True)]


def _with_band(own: Row, other: Row) -> Row:
    if other.quantity != own.quantity:
        raise ValueError(f"`{other.quantity}` is no band of `{own.quantity}`")
    if other.band is None:
        return own
    return replace(own, is_met=other.is_met, band=other.band, median=other.ours, starts=other.starts)


def inside(rows: Sequence[Row]) -> tuple[int, int]:
    """In how many rows with a band of other runs ours lies within it, and how many such rows there are."""
    compared = [(row.ours, row.band) for row in rows if row.median is not None and row.band is not None]
    return sum(low <= own <= high for own, (low, high) in compared), len(compared)
