"""Sensors and controllers of a scenario to their units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

import numpy as np

from cosim.components import (
    ControllerComponent,
    HoldLaw,
    OnOffLaw,
    PiLaw,
    PythonLaw,
    SensorComponent,
    SensorFault,
    SupervisorSettings,
    nanoseconds,
)
from cosim.control.controller import ControllerDesign, ControllerUnit, check_limits
from cosim.control.laws import Hold, OnOff, Pi
from cosim.control.sensor import Fault, SensorDesign, SensorUnit
from cosim.control.string_controllers import StringControllers
from cosim.control.supervisor import Supervisor
from cosim.control.user_law import UserLaw
from cosim.control_fmu import build_controller_fmu
from cosim.unit.protocol import Unit
from cosim.unit.quantity import PhysicalValue, conversion

T = TypeVar("T")


def build_control(name: str, component: SensorComponent | ControllerComponent, source: Path) -> Unit:
    """A sensor or a controller; raises ValueError for a number that does not fit.

    Args:
        name: Name of the component.
        component: What the scenario says.
        source: File of the scenario, beside which the law of a user's own lies.
    """
    if isinstance(component, SensorComponent):
        return build_sensor(name, component)
    return build_controller(name, component, source)


def build_sensor(name: str, component: SensorComponent) -> SensorUnit:
    """A sensor; raises ValueError for a number that does not fit."""
    unit, size = component.unit, component.elements
    _check_absolute(unit)
    exposure, sample = nanoseconds(component.exposure), nanoseconds(component.sample)
    if exposure > sample:
        raise ValueError(f"exposure ({component.exposure}) is longer than sample ({component.sample})")
    gain = component.gain if isinstance(component.gain, list) else [component.gain] * size
    bias = component.bias if isinstance(component.bias, list) else [component.bias] * size
    low = -math.inf if component.minimum is None else component.minimum.to(unit)
    high = math.inf if component.maximum is None else component.maximum.to(unit)
    if low >= high:
        raise ValueError(f"minimum ({component.minimum}) is not below maximum ({component.maximum})")
    return SensorUnit(
        name,
        SensorDesign(
            size,
            unit,
            sample,
            component.lag.to("s"),
            exposure,
            nanoseconds(component.delay),
            np.array(_of_size(gain, size, "gain"), dtype=np.float64),
            np.array([_difference(b, unit) for b in _of_size(bias, size, "bias")]),
            0.0 if component.drift is None else component.drift.to(f"{unit}/s"),
            _not_negative(component.noise, unit, "noise"),
            low,
            high,
            _not_negative(component.quantum, unit, "quantum"),
            component.seed,
            tuple(_fault(f, size, unit) for f in component.faults),
            component.dim,
        ),
    )


def build_controller(name: str, component: ControllerComponent, source: Path) -> ControllerUnit | StringControllers:
    """A controller; raises ValueError for a number that does not fit, InputError where its FMU cannot be built.

    Args:
        name: Name of the component.
        component: What the scenario says.
        source: File of the scenario, beside which the law of a user's own lies.
    """
    unit, command = component.measured_unit, component.command_unit
    _check_absolute(unit)
    low, high = component.lowest.to(command), component.highest.to(command)
    check_limits(low, high)
    groups = component.groups if component.supply == "per_string" else [sum(component.groups)]
    given = component.setpoint if isinstance(component.setpoint, list) else [component.setpoint] * len(groups)
    setpoint = np.array([v.to(unit) for v in _of_size(given, len(groups), "setpoint")])
    demand = f"({command})^2" if component.drive == "squared" else command
    design = ControllerDesign(
        tuple(groups),
        unit,
        command,
        nanoseconds(component.sample),
        low,
        high,
        setpoint,
        component.combine,
        component.drive == "squared",
        component.supply == "common",
    )
    law = _law(component.law, unit, demand, source)
    supervisor = None if component.supervisor is None else _supervisor(component.supervisor, unit)
    if component.fmu is None:
        return ControllerUnit(name, design, law, supervisor)
    if isinstance(law, UserLaw):
        raise ValueError("fmu: a law of kind `python` runs in this program alone; leave `fmu` out")
    return build_controller_fmu(name, component, design, law, supervisor, source)


def _law(
    given: OnOffLaw | PiLaw | HoldLaw | PythonLaw, unit: str, demand: str, source: Path
) -> OnOff | Pi | Hold | UserLaw:
    if isinstance(given, PythonLaw):
        return UserLaw((source.parent / given.file).resolve(), {n: v.number for n, v in given.parameters.items()})
    if isinstance(given, HoldLaw):
        hold, reheat = given.hold_at.to(unit), given.reheat_below.to(unit)
        if reheat >= hold:
            raise ValueError(f"law: reheat_below ({given.reheat_below}) is not below hold_at ({given.hold_at})")
        return Hold(hold, reheat, _simple(given.inner, unit, demand))
    return _simple(given, unit, demand)


def _simple(given: OnOffLaw | PiLaw, unit: str, demand: str) -> OnOff | Pi:
    if isinstance(given, OnOffLaw):
        return OnOff(_not_negative(given.band, unit, "band"))
    return Pi(
        given.gain.to(f"({demand})/({unit})"),
        given.integral_time.to("s"),
        0.0 if given.feedforward is None else given.feedforward.to(f"({demand})/({unit})"),
        0.0 if given.ambient is None else given.ambient.to(unit),
    )


def _supervisor(given: SupervisorSettings, unit: str) -> Supervisor:
    rise = given.fastest_rise.to(f"{unit}/s")
    if rise <= 0.0:
        raise ValueError(f"supervisor: fastest_rise is {given.fastest_rise}; it must be positive")
    slowest = 0.0 if given.slowest_rise is None else given.slowest_rise.to(f"{unit}/s")
    if not 0.0 <= slowest <= rise:
        raise ValueError(f"supervisor: slowest_rise is {given.slowest_rise}; give 0 to {given.fastest_rise}")
    return Supervisor(
        given.limit.to(unit),
        _not_negative(given.margin, unit, "margin"),
        rise,
        slowest,
        1.0 if given.cooling_time is None else given.cooling_time.to("s"),
        0.0 if given.ambient is None else given.ambient.to(unit),
        math.inf if given.tolerance is None else _not_negative(given.tolerance, unit, "tolerance"),
        given.delay.to("s"),
        given.lag.to("s"),
        -math.inf if given.lowest is None else given.lowest.to(unit),
        math.inf if given.highest is None else given.highest.to(unit),
        0.0 if given.frozen_after is None else given.frozen_after.to("s"),
    )


def _fault(given: SensorFault, size: int, unit: str) -> Fault:
    if given.element > size:
        raise ValueError(f"faults: there is no element {given.element}; the sensor has {size}")
    reads = None if given.reads is None else given.reads.to(unit)
    return Fault(given.element - 1, nanoseconds(given.instant), reads)


def _of_size(values: Sequence[T], size: int, key: str) -> Sequence[T]:
    if len(values) != size:
        raise ValueError(f"{key} has {len(values)} values; there are {size} elements")
    return values


def _check_absolute(unit: str) -> None:
    """Differences in degC are ambiguous; kelvin is not, and quantities may still be written in degC."""
    if unit in ("degC", "degF"):
        raise ValueError(f"the unit is {unit}; take K (values may still be written in degC)")


def _difference(value: PhysicalValue | None, unit: str) -> float:
    """A difference of readings: 0.3 degC of noise are 0.3 K."""
    if value is None:
        return 0.0
    return value.number * conversion(value.unit or unit, unit)[0]


def _not_negative(value: PhysicalValue | None, unit: str, key: str) -> float:
    found = _difference(value, unit)
    if found < 0.0:
        raise ValueError(f"{key} is {value}; it must not be negative")
    return found
