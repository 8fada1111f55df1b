"""A controller whose laws run in the shipped FMU `string_controller`: its keys to parameters of the FMU."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cosim.components import ControllerComponent, FmuComponent
from cosim.control.controller import ControllerDesign
from cosim.control.laws import Hold, OnOff, Pi
from cosim.control.string_controllers import StringControllers
from cosim.control.supervisor import Supervisor
from cosim.fmu_assembly import build_fmu
from cosim.parameters import Resolved
from cosim.unit.protocol import Unit, seconds
from cosim.unit.quantity import PhysicalValue

_COMBINE = {"mean": 0.0, "max": 1.0, "min": 2.0}
#: Bounds that are not given, in the FMU's table.
_NEVER = 1e9


def build_controller_fmu(
    name: str,
    component: ControllerComponent,
    design: ControllerDesign,
    law: OnOff | Pi | Hold,
    supervisor: Supervisor | None,
    source: Path,
) -> StringControllers:
    """One FMU per string, with the keys of the component as parameters.

    Args:
        name: Name of the component.
        component: What the scenario says.
        design: The same in SI.
        law: The same.
        supervisor: The same; None: none.
        source: File of the scenario.

    Raises:
        ValueError: The FMU has no such unit.
        InputError: The FMU cannot be loaded or built.
    """
    if (design.measured_unit, design.command_unit) != ("K", "V"):
        raise ValueError(
            f"fmu: {component.fmu} measures K and commands V, not {design.measured_unit} and "
            f"{design.command_unit}; leave `fmu` out, or change the units"
        )
    numbers = _parameters(design, law, supervisor)
    values: dict[str, PhysicalValue | bool] = {
        n: v if isinstance(v, bool) else PhysicalValue(v, _UNITS.get(n, "")) for n, v in numbers.items()
    }
    strings: list[Unit] = []
    try:
        for i, coils in enumerate(design.groups, start=1):
            given = FmuComponent(kind="fmu", fmu=str(component.fmu), structure={"coils": coils})
            strings.append(build_fmu(f"{name}[{i}]", given, Resolved(dict(values), {}), source))
        return StringControllers(name, design, strings)
    except BaseException:
        for string in strings:
            string.terminate()
        raise


_UNITS = {
    "sample": "s",
    "lowest": "V",
    "highest": "V",
    "band": "K",
    "integral_time": "s",
    "ambient": "K",
    "hold_at": "K",
    "reheat_below": "K",
    "limit": "K",
    "margin": "K",
    "fastest_rise": "K/s",
    "slowest_rise": "K/s",
    "cooling_time": "s",
    "lowest_ambient": "K",
    "tolerance": "K",
    "delay": "s",
    "lag": "s",
    "lowest_reading": "K",
    "highest_reading": "K",
    "frozen_after": "s",
}


def _parameters(design: ControllerDesign, law: OnOff | Pi | Hold, supervisor: Supervisor | None) -> dict[str, float]:
    """Names of the FMU's table (fmus/control/string_controller/config.h) to numbers in its units."""
    found: dict[str, float] = {
        "sample": seconds(design.sample),
        "lowest": design.low,
        "highest": design.high,
        "drive_squared": design.is_squared,
        "combine": _COMBINE[design.combine],
        "use_hold": isinstance(law, Hold),
        "use_supervisor": supervisor is not None,
    }
    if isinstance(law, Hold):
        found |= {"hold_at": law.hold_at, "reheat_below": law.reheat_below}
    inner = law.inner if isinstance(law, Hold) else law
    if isinstance(inner, OnOff):
        found |= {"law": 0.0, "band": inner.band}
    else:
        found |= {
            "law": 1.0,
            "gain": inner.gain,
            "integral_time": inner.integral_time,
            "feedforward": inner.feedforward,
            "ambient": inner.ambient,
        }
    if supervisor is not None:
        s = supervisor
        found |= {
            "limit": s.limit,
            "margin": s.margin,
            "fastest_rise": s.fastest_rise,
            "slowest_rise": s.slowest_rise,
            "cooling_time": s.cooling_time,
            "lowest_ambient": s.ambient,
            "tolerance": min(s.tolerance, _NEVER),
            "delay": s.delay,
            "lag": s.lag,
            "lowest_reading": float(np.clip(s.lowest, -_NEVER, _NEVER)),
            "highest_reading": float(np.clip(s.highest, -_NEVER, _NEVER)),
            "frozen_after": s.frozen_after,
        }
    return found
