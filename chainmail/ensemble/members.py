"""The scenarios of an ensemble: the same fabric from other starts."""

from __future__ import annotations

from cosim.components import FabricComponent
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue

#: Speed of random starts where the scenario gives none [m/s]: within milliseconds it moves links by micrometres.
START_SPEED = 1e-3


def member(scenario: Scenario, start: int) -> Scenario:
    """The scenario from one of its starts.

    Start 1 is the scenario as it is. In every other one the free links of each fabric begin with random speeds of up to
    its `start_speed` (1 mm/s where it gives none); `start_number` counts on from its own.

    Args:
        scenario: With at least one fabric.
        start: Counted from 1.

    Raises:
        InputError: The scenario has no fabric, so that all its starts would be the same.
    """
    fabrics = {n: c for n, c in scenario.components.items() if isinstance(c, FabricComponent)}
    if not fabrics:
        source = scenario.path or "scenario"
        raise InputError(
            source, "components", "there is no fabric: every start gives the same run", "run it without `--starts`"
        )
    if start == 1:
        return scenario
    changed = {name: _from(component, start) for name, component in fabrics.items()}
    return scenario.model_copy(update={"components": {**scenario.components, **changed}})


def _from(fabric: FabricComponent, start: int) -> FabricComponent:
    given = dict(fabric.parameters)
    first = given.get("start_number")
    base = round(first.to("1")) if isinstance(first, PhysicalValue) else 0
    speed = given.get("start_speed")
    if not isinstance(speed, PhysicalValue) or speed.to("m/s") == 0.0:
        given["start_speed"] = PhysicalValue(1e3 * START_SPEED, "mm/s")
    given["start_number"] = PhysicalValue(float(base + start - 1), "1")
    return fabric.model_copy(update={"parameters": given})
