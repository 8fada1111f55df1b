"""What a controller was to reach, and what its sensor read: read off the scenario and the results of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from cosim.components import ControllerComponent, HoldLaw
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion


@dataclass(frozen=True)
class Loop:
    """One controller and what it is about.

    Args:
        unit: Of all that follows.
        setpoint: Shape (times, strings), or (times, 1) where all strings have one; None: fed in parts, which is not
            put together here.
        measured: What the sensor gave, shape (times, elements); None: the same.
        hold: Lower value that is held once the setpoint has been reached; None: the law has none.
    """

    unit: str
    setpoint: Array | None
    measured: Array | None
    hold: float | None


def loop_of(scenario: Scenario, run: xr.Dataset, controller: str) -> Loop | None:
    """The loop of a controller; None where the scenario has no such component.

    Args:
        scenario: Of the run.
        run: With the dimension `time`.
        controller: Name of the component.
    """
    component = scenario.components.get(controller)
    if not isinstance(component, ControllerComponent):
        return None
    unit = component.measured_unit
    given = component.setpoint if isinstance(component.setpoint, list) else [component.setpoint]
    constant = np.tile([value.to(unit) for value in given], (run.sizes["time"], 1))
    is_fed, setpoint = _fed(scenario, run, f"{controller}.setpoint", unit)
    _, measured = _fed(scenario, run, f"{controller}.measured", unit)
    hold = component.law.hold_at.to(unit) if isinstance(component.law, HoldLaw) else None
    return Loop(unit, setpoint if is_fed else constant, measured, hold)


def _fed(scenario: Scenario, run: xr.Dataset, target: str, unit: str) -> tuple[bool, Array | None]:
    """Whether something is connected to an input, and the recorded values of what feeds it as a whole."""
    is_fed = False
    for given in scenario.connections:
        text = given if isinstance(given, str) else given.connect
        source, _, end = (part.strip() for part in text.partition("->"))
        is_fed |= end.partition("[")[0] == target
        if end != target or source not in run:
            continue
        values = run[source].values.reshape(run.sizes["time"], -1)
        own = str(run[source].attrs.get("units", unit))
        if isinstance(given, str) or given.convert_units:
            factor, offset = conversion(own, unit)
            values = factor * values + offset
        return True, values if isinstance(given, str) else given.factor * values + given.offset
    return is_fed, None
