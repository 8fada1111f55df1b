"""What of a scenario can be driven in an experiment, and how far."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from cosim.assemble import assemble
from cosim.components import HangingMassComponent
from cosim.connection import Connection
from cosim.programme import Course, ProgrammeUnit
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.judge.next_experiment import Course as Driven
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme
from diagnosis.models.coil_network.translate import Translation

Target = Literal["voltage", "power", "ambient"]
_TARGETS: Mapping[str, Target] = {"supply_voltage": "voltage", "power": "power", "ambient_temperature": "ambient"}


@dataclass(frozen=True)
class Driver:
    """An output of a programme that an experiment may change.

    Args:
        component: Programme.
        output: Its output.
        unit: Unit of the output, in which all values here are.
        target: What it drives.
        columns: Elements of the output; 0 where it is a single value.
        is_linear: Whether the scenario has it linear between its points: then it cannot jump.
        lowest: Least value that was ever given.
        highest: Greatest value that was ever given, or the limit that was stated.
        slew: Fastest change that was ever given [unit/s]; infinite where it may jump.
        connections: Ways from the output to what it drives.
    """

    component: str
    output: str
    unit: str
    target: Target
    columns: int
    is_linear: bool
    lowest: float
    highest: float
    slew: float
    connections: tuple[Connection, ...]

    @property
    def name(self) -> str:
        """As a user writes it."""
        return f"{self.component}.{self.output}"

    def values(self, heat: Array) -> Array:
        """Values that give shares of the greatest steady heating: a voltage goes with its square root.

        Args:
            heat: Shares in [0, 1], any shape.
        """
        share = np.sqrt(heat) if self.target == "voltage" else heat
        return np.asarray(self.lowest + share * (self.highest - self.lowest))


@dataclass(frozen=True)
class Rig:
    """What can be driven, by what limits.

    Args:
        drivers: Outputs of programmes; at least one.
        load: Component of the hanging load, or None.
        mass: Its greatest mass that was ever hung [kg]; 0 without one.
        start: First instant of the scenario [s].
        macro_step: Grid of all switching times [s].
        duration: Of the longest recording [s].
    """

    drivers: tuple[Driver, ...]
    load: str | None
    mass: float
    start: float
    macro_step: float
    duration: float

    @property
    def columns(self) -> int:
        """How many courses can differ from each other."""
        return sum(max(d.columns, 1) for d in self.drivers)

    def limits(self) -> tuple[str, ...]:
        """What an experiment keeps, in words."""
        told = [f"{d.name} from {d.lowest:.4g} to {d.highest:.4g} {d.unit}" for d in self.drivers]
        told += [f"{d.name} changes by at most {d.slew:.3g} {d.unit}/s" for d in self.drivers if np.isfinite(d.slew)]
        return tuple(told)


def rig(scenario: Scenario, conditions: Sequence[Scenario], longest: float, limits: Mapping[str, float]) -> Rig | None:
    """What can be driven in an experiment, or None where nothing can.

    Args:
        scenario: The model as it is.
        conditions: The scenario under the conditions of each recording.
        longest: Duration of the longest recording [s].
        limits: `component.output` to its greatest value in the unit of that output.

    Raises:
        InputError: A limit names no output that can be driven.
    """
    found: dict[tuple[str, str], Driver] = {}
    for one in (scenario, *conditions):
        for driver in _drivers(one):
            key = (driver.component, driver.output)
            found[key] = _wider(found[key], driver) if key in found else driver
    drivers = [_limited(d, limits) for d in found.values() if d.highest > d.lowest or d.name in limits]
    unknown = sorted(set(limits) - {d.name for d in found.values()})
    if unknown:
        known = ", ".join(sorted(d.name for d in found.values())) or "none"
        raise InputError("--limit", unknown[0], "the scenario drives no such output", f"it has: {known}")
    if not drivers:
        return None
    loads = [
        (n, c.mass.to("kg"))
        for s in (scenario, *conditions)
        for n, c in s.components.items()
        if isinstance(c, HangingMassComponent)
    ]
    return Rig(
        tuple(drivers),
        loads[0][0] if loads else None,
        max((m for _, m in loads), default=0.0),
        scenario.time.start.to("s"),
        scenario.time.macro_step.to("s"),
        longest,
    )


def _drivers(scenario: Scenario) -> list[Driver]:
    assembly = assemble(scenario)
    try:
        connections = list(assembly.system.connections)
        units = dict(assembly.system.units)
    finally:
        assembly.system.terminate()
    grouped: dict[tuple[str, str], list[Connection]] = {}
    for connection in connections:
        if isinstance(units[connection.source[0]], ProgrammeUnit) and connection.target[1] in _TARGETS:
            grouped.setdefault(connection.source, []).append(connection)
    found = []
    for (component, output), ways in grouped.items():
        unit = units[component]
        assert isinstance(unit, ProgrammeUnit)
        target = _TARGETS[ways[0].target[1]]
        course = unit.courses[output]
        # A room that is given as constant is no bath that somebody can set.
        if target != "ambient" or len(course.times) > 1:
            found.append(_driver((component, output), course, target, tuple(ways)))
    return found


def _driver(source: tuple[str, str], course: Course, target: Target, ways: tuple[Connection, ...]) -> Driver:
    columns = course.values.shape[1] if course.values.ndim == 2 else 0
    slew = np.inf
    if course.is_linear and len(course.times) > 1:
        change = np.abs(np.diff(course.values, axis=0)).reshape(len(course.times) - 1, -1).max(axis=1)
        slew = float(np.max(change / (np.diff(np.array(course.times)) * 1e-9)))
    # Heating may always be switched off; a bath cannot be colder than it was.
    low = float(course.values.min()) if target == "ambient" else min(float(course.values.min()), 0.0)
    high = float(course.values.max())
    return Driver(*source, course.unit, target, columns, course.is_linear, low, high, slew, ways)


def _wider(one: Driver, other: Driver) -> Driver:
    slews = [s for s in (one.slew, other.slew) if np.isfinite(s)]
    slew = max(slews) if slews and one.is_linear and other.is_linear else np.inf
    return Driver(
        one.component,
        one.output,
        one.unit,
        one.target,
        one.columns,
        one.is_linear and other.is_linear,
        min(one.lowest, other.lowest),
        max(one.highest, other.highest),
        slew,
        one.connections,
    )


def _limited(driver: Driver, limits: Mapping[str, float]) -> Driver:
    highest = limits.get(driver.name, driver.highest)
    if not highest > driver.lowest:
        raise InputError(
            "--limit",
            driver.name,
            f"{highest:g} {driver.unit} leaves nothing to drive",
            f"give more than {driver.lowest:g} {driver.unit}",
        )
    return Driver(
        driver.component,
        driver.output,
        driver.unit,
        driver.target,
        driver.columns,
        driver.is_linear,
        driver.lowest,
        highest,
        driver.slew,
        driver.connections,
    )


def drive(rig: Rig, courses: Sequence[Driven], like: Translation) -> Drive:
    """Programmes of a network under given courses; what no course is given for stays as it is in `like`.

    Args:
        rig: What can be driven.
        courses: One for each driver, in their order.
        like: A scenario of the same kind.
    """
    programmes: dict[Target, Programme | None] = {
        "ambient": like.drive.ambient,
        "voltage": like.drive.voltage,
        "power": like.drive.power,
    }
    for target in ("ambient", "voltage", "power"):
        own = [(d, c) for d, c in zip(rig.drivers, courses) if d.target == target]
        if own:
            programmes[target] = _together(own, like)
    ambient = programmes["ambient"]
    assert ambient is not None
    return Drive(ambient, programmes["voltage"], programmes["power"])


def _together(own: Sequence[tuple[Driver, Driven]], like: Translation) -> Programme:
    """The course of an input from those of the outputs that feed it."""
    coils = like.layout.coils
    times = np.unique(np.concatenate([c.times for _, c in own]))
    is_linear = any(c.is_linear for _, c in own)
    total: Array | None = None
    for driver, course in own:
        values = _at(course, times)
        values = values if driver.columns else values[:, 0]
        for way in driver.connections:
            part = values if way.source_element is None else values[:, way.source_element[0]]
            part = way.factor * part + way.offset
            if way.target_element is not None:
                total = np.zeros((len(times), coils)) if total is None else total
                total[:, way.target_element[0]] = part
            elif driver.target == "power" and part.ndim == 1:
                total = np.repeat(part[:, None], coils, axis=1)
            else:
                total = part
    assert total is not None
    return Programme(times, total, is_linear)


def _at(course: Driven, times: Array) -> Array:
    own, values = np.array(course.times), np.array(course.values)
    if not course.is_linear:
        return np.asarray(values[np.maximum(np.searchsorted(own, times, side="right") - 1, 0)])
    return np.stack([np.interp(times, own, c) for c in values.T], axis=-1)
