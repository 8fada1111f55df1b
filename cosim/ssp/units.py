"""Units by their definition: an SSP and an FMU say what a unit's name means; pint is asked where they do not."""

from __future__ import annotations

import math
from typing import Any

from cosim.ssp.model import BASE_UNITS, Unit
from cosim.unit.quantity import cycles_and_angles, parse_unit, registry

_PINT_NAMES = ("kilogram", "meter", "second", "ampere", "kelvin", "mole", "candela", "radian")


class UnitFault(ValueError):
    """Two units measure different things, or a unit is not known."""


def known_unit(name: str) -> Unit:
    """Definition of a unit by its name.

    Raises:
        UnitFault: pint does not know it, or it has no whole exponents of the SI base units.

    >>> known_unit("degC")
    Unit(name='degC', exponents=(0, 0, 0, 0, 1, 0, 0, 0), factor=1.0, offset=273.15)
    """
    try:
        unit = parse_unit(name)
        zero = registry().Quantity(0.0, unit).to_base_units()
        one = registry().Quantity(1.0, unit).to_base_units()
    except ValueError as error:
        raise UnitFault(str(error)) from error
    powers: dict[str, Any] = dict(one.units._units)
    exponents = tuple(powers.pop(base, 0) for base in _PINT_NAMES)
    if powers or any(e != int(e) for e in exponents):
        raise UnitFault(f"`{name}` has no whole exponents of {', '.join(BASE_UNITS)}")
    offset = float(zero.magnitude)
    factor = float(f"{float(one.magnitude) - offset:.15g}")
    return Unit(name, tuple(int(e) for e in exponents), factor, offset)


def convert(source: Unit, target: Unit) -> tuple[float, float]:
    """(factor, offset) with value in target = factor * value in source + offset.

    Exponents of rad are not compared: rad is 1 (BIPM SI Brochure, 9th edition, table 4); tools differ in writing it.
    Where one unit is named with Hz and the other has rad in its place, a cycle is 2 pi rad
    (`cosim.unit.quantity.turns`).

    Raises:
        UnitFault: They measure different things.
    """
    if source == target or (source.name == target.name and not (source.exponents and target.exponents)):
        return 1.0, 0.0
    if source.exponents[:-1] != target.exponents[:-1]:
        raise UnitFault(f"{source.name} cannot be converted to {target.name}")
    angles = target.exponents[-1] - source.exponents[-1]
    cycles = _cycles(source.name) - _cycles(target.name)
    factor = source.factor / target.factor * ((2.0 * math.pi) ** cycles if cycles == angles else 1.0)
    offset = (source.offset - target.offset) / target.factor
    return float(f"{factor:.15g}"), float(f"{offset:.15g}")


def _cycles(name: str) -> float:
    """Power of hertz in a unit's name; 0 where pint does not know it."""
    try:
        return cycles_and_angles(name)[0]
    except ValueError:
        return 0.0


def across(source: Unit | None, target: Unit | None) -> tuple[float, float]:
    """The same between a connector and the variable behind it: no unit, or 1, on one side leaves the number as it is.

    Raises:
        UnitFault: They measure different things.
    """
    if source is None or target is None or _is_bare(source) or _is_bare(target):
        return 1.0, 0.0
    return convert(source, target)


def _is_bare(unit: Unit) -> bool:
    return (any(unit.exponents[:-1]), unit.factor, unit.offset) == (False, 1.0, 0.0) and bool(unit.exponents)


def means_the_same(unit: Unit) -> bool:
    """Whether the name means to pint what this definition says."""
    try:
        own = known_unit(unit.name)
    except UnitFault:
        return False
    return (
        own.exponents[:-1] == unit.exponents[:-1]
        and _close(own.factor, unit.factor)
        and _close(own.offset, unit.offset)
    )


def plain(unit: Unit, number: float) -> str:
    """A number with its unit as a scenario writes it: by the unit's name where that means what is defined, else in SI.

    >>> plain(Unit("Nm", (1, 2, -2, 0, 0, 0, 0, 0)), 3.0)
    '3.0 kg*m**2/s**2'
    """
    if means_the_same(unit) or not unit.exponents:
        return f"{number!r} {unit.name}" if unit.name != "1" else repr(number)
    if unit.factor != 1.0 or unit.offset != 0.0:
        number = float(f"{unit.factor * number + unit.offset:.15g}")
    return f"{number!r} {base_expression(unit)}"


def base_expression(unit: Unit) -> str:
    """The base units of a unit, for pint.

    >>> base_expression(Unit("km/h", (0, 1, -1, 0, 0, 0, 0, 0), 1 / 3.6))
    'm/s'
    """
    powers = [(name, e) for name, e in zip(BASE_UNITS, unit.exponents, strict=True) if e]
    above, below = ("*".join(_power(n, abs(e)) for n, e in powers if (e > 0) is sign) for sign in (True, False))
    return (above or "1") + (f"/({below})" if "*" in below.replace("**", "") else f"/{below}" if below else "")


def _power(name: str, exponent: int) -> str:
    return name if exponent == 1 else f"{name}**{exponent}"


def _close(a: float, b: float) -> bool:
    return abs(a - b) <= 1e-12 * max(abs(a), abs(b))
