"""Numbers of the fabric that a design may vary, by their paths in the scenario."""

from __future__ import annotations

from pathlib import Path

from chainmail.design.candidate import Rig
from chainmail.design.task import Span
from cosim.components import FabricComponent
from cosim.mechanics_assembly import FABRIC_UNITS
from cosim.nearest import did_you_mean
from cosim.parameters import resolve
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue
from mechanics.fabric import FabricDesign

#: Numbers that may be negative.
_ANY_SIGN = ("tilt", "roll")
#: Numbers that say where and how a run begins: a check takes fresh starts by them.
_NOT_VARIED = ("start_number", "start_speed")


def check_keys(spans: dict[str, Span], rig: Rig, path: Path) -> None:
    """Refuse a range of anything but a number of the fabric, and ranges in which nothing can be woven.

    Raises:
        InputError: A key is none, its unit is another, or no corner of the ranges can be woven.
    """
    known = [n for n in FABRIC_UNITS if n not in _NOT_VARIED]
    for key, span in spans.items():
        head, _, name = key.partition(".parameters.")
        if head != rig.fabric or name not in known:
            paths = [f"{rig.fabric}.parameters.{n}" for n in known]
            raise InputError(
                path,
                f"vary.{key}",
                f"this is no number of the fabric{did_you_mean(key, paths)}",
                f"write for example `{rig.fabric}.parameters.bar_diameter: 8 mm to 9 mm`; rows, voltages and "
                "temperatures have keys of their own",
            )
        for end in (span.low, span.high):
            try:
                if end.to(FABRIC_UNITS[name]) < 0.0 and name not in _ANY_SIGN:
                    raise ValueError(f"`{end}` is below 0")
            except ValueError as error:
                remedy = f"give it in {FABRIC_UNITS[name]}, not below 0"
                raise InputError(path, f"vary.{key}", str(error), remedy) from error
    if spans and not any(weave_of(corner, rig) for corner in corners(spans)):
        raise InputError(
            path,
            "vary",
            "at no corner of the ranges can the fabric be woven: " + _why_not(rig.with_keys(corners(spans)[0])),
            "thinner bars or longer links",
        )


def corners(spans: dict[str, Span]) -> list[tuple[tuple[str, str], ...]]:
    """Every combination of the ends of the ranges."""
    found: list[tuple[tuple[str, str], ...]] = [()]
    for key, span in spans.items():
        found = [(*corner, (key, span.at(end))) for corner in found for end in (0.0, 1.0)]
    return found


def weave_of(keys: tuple[tuple[str, str], ...], rig: Rig) -> FabricDesign | None:
    """Geometry of a fabric with other numbers; None where it cannot be woven."""
    try:
        return rig.with_keys(keys).weave
    except ValueError:
        return None


def _why_not(rig: Rig) -> str:
    try:
        assert rig.weave
    except ValueError as error:
        return str(error)
    return ""


def value_of(rig: Rig, key: str) -> PhysicalValue:
    """What the scenario gives for a number of the fabric; 0 where it gives nothing."""
    name = key.rpartition(".")[2]
    fabric = rig.scenario.components[rig.fabric]
    assert isinstance(fabric, FabricComponent)
    given = resolve(fabric.parameter_set, fabric.parameters, rig.scenario.path or Path("scenario")).values.get(name)
    return given if isinstance(given, PhysicalValue) else PhysicalValue(0.0, FABRIC_UNITS[name])
