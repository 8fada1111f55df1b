"""Fabrics and pendulums from a scenario: parameters with units to designs in SI."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from typing import Any

from cosim.components import FabricComponent, ParameterValue, PendulumComponent
from cosim.nearest import did_you_mean
from cosim.parameters import Resolved
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue
from mechanics.added import AddedEffects, LinkEffects, OutOfRange, tilted
from mechanics.fabric import FabricDesign
from mechanics.mujoco_world import MujocoMissing
from mechanics.pendulum import PendulumDesign, PendulumUnit
from mechanics.solver import SolverSettings
from mechanics.unit import FabricUnit

#: SI unit of every number of a fabric that a parameter set or a scenario may give.
FABRIC_UNITS = {
    "bar_diameter": "m",
    "tolerance": "m",
    "width": "m",
    "length_cold": "m",
    "length_hot": "m",
    "length_offset": "m",
    "link_mass": "kg",
    "friction": "1",
    "restitution": "1",
    "steel_stiffness": "N/m",
    "steel_rest_length": "m",
    "tether_play": "m",
    "start_speed": "m/s",
    "start_number": "1",
    "tilt": "rad",
    "roll": "rad",
    "slide_friction": "N",
    "slide_damping": "N*s/m",
    "hinge_friction": "m",
    "wire_stiffness": "N/m",
    "coil_play": "m",
    "coil_contraction": "m^2/N",
    "cold_stiffness": "N/m",
    "added_friction": "1",
    "payload": "kg",
}
#: Those of them that are effects which a plain fabric leaves out.
_ADDED = frozenset(field.name for field in fields(AddedEffects)) - {"links"}
#: SI unit of what one link may have besides, given as `name[number of the link]`.
LINK_UNITS = {"steel_loss": "1", "coil_loss": "1", "heat_loss": "1", "slide_friction": "N"}
_OF_A_LINK = re.compile(r"(\w+)\[(\d+)\]")

#: The same of a pendulum.
PENDULUM_UNITS = {
    "mass": "kg",
    "centre_distance": "m",
    "central_inertia": "kg*m^2",
    "gravity": "m/s^2",
    "viscous_damping": "N*m*s/rad",
    "coulomb_friction": "N*m",
    "stiction": "N*m",
    "stribeck_speed": "rad/s",
    "quadratic_drag": "N*m*s^2/rad^2",
    "backlash": "rad",
    "tilt": "rad",
    "cubic_drag": "N*m*s^3/rad^3",
    "spring_stiffness": "N*m/rad",
    "spring_rest": "rad",
    "band_damping": "N*m*s/rad",
    "band_width": "rad",
    "periodic_torque": "N*m",
    "periodic_rate": "rad/s",
    "periodic_phase": "rad",
    "constant_torque": "N*m",
    "initial_angle": "rad",
    "initial_angular_velocity": "rad/s",
}


#: Keys of a fabric's component beside its parameters, by the name of the number.
_KEYS = {"rows": "rows", "columns": "columns", "tether_rows": "tether.rows"}


def build_fabric(name: str, component: FabricComponent, parameters: Resolved) -> FabricUnit:
    """A fabric; raises ValueError for a parameter that does not fit, InputError where its engine is not installed."""
    numbers: dict[str, Any] = {}
    of_links: dict[int, dict[str, float]] = {}
    for key, value in parameters.values.items():
        if of_link := _OF_A_LINK.fullmatch(key):
            own, number = of_link[1], int(of_link[2])
            links = component.rows * (2 * component.columns - 1)
            if not 1 <= number <= links:
                where = f"{name}.parameters.{key}"
                raise InputError("scenario", where, f"the fabric has links 1 to {links}", "name one of them")
            if own not in LINK_UNITS:
                hint = did_you_mean(own, list(LINK_UNITS))
                known = ", ".join(f"{n}[{number}]" for n in LINK_UNITS)
                raise ValueError(f"a link has no parameter `{own}`{hint}; link {number} may have {known}")
            of_links.setdefault(number - 1, {})[own] = _in_unit(key, _quantity(value), LINK_UNITS[own])
        elif key == "gravity":
            numbers[key] = _gravity(value)
        elif key not in FABRIC_UNITS:
            raise ValueError(_no_parameter("fabric", key, ["gravity", *FABRIC_UNITS]))
        elif not isinstance(value, PhysicalValue):
            raise ValueError(f"{key} must be one number with a unit")
        else:
            numbers[key] = _in_unit(key, value, FABRIC_UNITS[key])
    added = _added(name, component, numbers, of_links)
    leaning = numbers.pop("tilt", 0.0), numbers.pop("roll", 0.0)
    numbers["gravity"] = tilted(numbers.get("gravity", FabricDesign.gravity), *leaning)
    numbers["start_number"] = round(numbers.get("start_number", 0))
    with _refused_by_key(name):
        design = FabricDesign(
            rows=component.rows,
            columns=component.columns,
            tether_rows=component.tether.rows,
            tether_kind=component.tether.kind,
            added=added,
            **numbers,
        )
    solver = SolverSettings(
        micro_step=component.solver.micro_step.to("s"),
        iterations=component.solver.iterations,
        penetration_limit=component.solver.penetration_limit.to("m"),
        springs=component.solver.springs,
        engine=component.engine,
        friction_model=component.solver.friction_model,
        friction_anchors=component.solver.friction_anchors,
    )
    try:
        return FabricUnit(name, design, solver)
    except MujocoMissing as error:
        raise InputError(
            "scenario",
            f"{name}.engine",
            "the package mujoco is not installed",
            'install it with `pip install "active-chainmail[mujoco]"`, or write `engine: bullet`',
        ) from error


def build_pendulum(name: str, component: PendulumComponent, parameters: Resolved) -> PendulumUnit:
    """A pendulum; raises ValueError for a parameter that is missing or does not fit."""
    numbers: dict[str, float] = {}
    for key, value in parameters.values.items():
        if key not in PENDULUM_UNITS:
            raise ValueError(_no_parameter("pendulum", key, list(PENDULUM_UNITS)))
        numbers[key] = _quantity(value).to(PENDULUM_UNITS[key])
    missing = [key for key in ("mass", "centre_distance", "central_inertia") if key not in numbers]
    if missing:
        raise ValueError(f"a pendulum needs {missing[0]}: give it under parameters or in a parameter set")
    return PendulumUnit(name, PendulumDesign(**numbers), component.micro_step.to("s"))


def _no_parameter(kind: str, key: str, known: list[str]) -> str:
    hint = did_you_mean(key, known)
    return f"a {kind} has no parameter `{key}`{f'{hint} It has' if hint else '; it has'}: {', '.join(known)}"


def _added(
    name: str, component: FabricComponent, numbers: dict[str, Any], of_links: dict[int, dict[str, float]]
) -> AddedEffects:
    """Effects that are added, which are taken out of the numbers."""
    links = tuple((number, _effects_of_a_link(name, number, own)) for number, own in sorted(of_links.items()))
    with _refused_by_key(name):
        added = AddedEffects(links=links, **{key: numbers.pop(key) for key in sorted(_ADDED & set(numbers))})
    has_friction = added.slide_friction or any(own.slide_friction for _, own in links)
    if has_friction and component.solver.springs == "motor":
        raise ValueError("slide_friction needs solver.springs `force`: springs as motors use up the joint's motor")
    return added


def _effects_of_a_link(name: str, number: int, own: dict[str, float]) -> LinkEffects:
    with _refused_by_key(name, f"[{number + 1}]"):
        return LinkEffects(**own)


@contextmanager
def _refused_by_key(name: str, index: str = "") -> Iterator[None]:
    """Say of a number that cannot be which key of the component it stands under, with its unit.

    Args:
        name: Of the component.
        index: What follows the name of the number in its key.
    """
    try:
        yield
    except OutOfRange as error:
        key = _KEYS.get(error.name, f"parameters.{error.name}{index}")
        unit = (LINK_UNITS | FABRIC_UNITS).get(error.name, "1").removeprefix("1")
        raise InputError("scenario", f"{name}.{key}", f"it is {error.value:g} {unit}".rstrip(), error.remedy) from error


def _in_unit(key: str, value: PhysicalValue, unit: str) -> float:
    try:
        return value.to(unit)
    except ValueError as error:
        raise ValueError(f"{key}: {error}") from error


def _gravity(value: ParameterValue) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("gravity is a list of three accelerations, for example [0 m/s^2, 0 m/s^2, -9.81 m/s^2]")
    try:
        x, y, z = (_quantity(element).to("m/s^2") for element in value)
    except ValueError as error:
        raise ValueError(f"gravity: {error}") from error
    return x, y, z


def _quantity(value: object) -> PhysicalValue:
    if not isinstance(value, PhysicalValue):
        raise ValueError(f"{value!r} is not a number with a unit")
    return value
