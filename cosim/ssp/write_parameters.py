"""Values of an FMU component to a parameter set (SSV)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from lxml import etree

from cosim.components import ParameterValue
from cosim.quantity import PhysicalValue
from cosim.ssp.elements import add_dimensions, add_units, number, root, type_name
from cosim.ssp.fmus import Fmu, Variable
from cosim.ssp.model import Unit
from cosim.ssp.namespaces import FLOAT_TYPES, INTEGER_TYPES, SSV, Version, tag
from cosim.ssp.units import UnitFault, known_unit


@dataclass(frozen=True)
class Entry:
    """One value to be written.

    Args:
        name: Variable, or array of variables, of the FMU.
        value: As a scenario holds it.
        source: Where it comes from.
    """

    name: str
    value: ParameterValue
    source: str = ""


def parameter_set(name: str, entries: list[Entry], fmu: Fmu, structure: Mapping[str, int], version: Version) -> Any:
    """`ssv:ParameterSet` of a component.

    Args:
        name: Name of the set.
        entries: Values.
        fmu: The FMU that they are for.
        structure: Its structural parameters, for the shapes of arrays.
        version: Version of SSP.

    Raises:
        ValueError: A value does not fit its variable, or SSP 1.0 cannot hold it.
    """
    top = root(SSV, "ParameterSet", version, name=name)
    listed = etree.SubElement(top, tag(SSV, "Parameters"))
    units: dict[str, Unit] = {}
    for entry in entries:
        for variable, values, shape in _variables(entry, fmu, structure):
            if shape and version == "1.0":
                raise ValueError(f"{variable.name} is an array, which SSP 1.0 does not have")
            element = etree.SubElement(listed, tag(SSV, "Parameter"), name=variable.name)
            if entry.source:
                element.set("description", entry.source)
            _add_value(element, variable, values, units, version)
            add_dimensions(element, shape)
    add_units(top, SSV, units.values())
    return top


def _variables(
    entry: Entry, fmu: Fmu, structure: Mapping[str, int]
) -> Iterator[tuple[Variable, list[Any], tuple[int, ...]]]:
    """Variables of the FMU that a value reaches, with their elements and shapes."""
    flat = _flat(entry.value)
    if entry.name in fmu.arrays:
        indices = fmu.arrays[entry.name]
        for index, value in zip(indices, _filled(entry, flat, len(indices)), strict=True):
            yield fmu.variables[f"{entry.name}[{index}]"], [value], ()
        return
    variable = fmu.variables[entry.name]
    shape = fmu.shape(variable, structure)
    yield variable, _filled(entry, flat, math.prod(shape)), shape


def _flat(value: ParameterValue) -> list[Any]:
    if isinstance(value, list):
        return list(itertools.chain.from_iterable(_flat(v) for v in value))
    return [value]


def _filled(entry: Entry, values: list[Any], size: int) -> list[Any]:
    if len(values) == size:
        return values
    if len(values) == 1:  # a single value fills an array
        return values * size
    raise ValueError(f"{entry.name} has {len(values)} values for {size} elements")


def _add_value(element: Any, variable: Variable, values: list[Any], units: dict[str, Unit], version: Version) -> None:
    typed = etree.SubElement(element, tag(SSV, type_name(variable.type, version)))
    if variable.type in FLOAT_TYPES:
        numbers, unit = _numbers(variable, values)
        typed.set("value", " ".join(map(number, numbers)))
        if unit is not None:
            units[unit.name] = unit
            typed.set("unit", unit.name)
    elif variable.type in INTEGER_TYPES:
        typed.set("value", " ".join(str(_integer(v)) for v in values))
    elif variable.type == "Boolean":
        typed.set("value", " ".join(str(bool(v)).lower() for v in values))
    else:
        texts = [_item(variable, v) if variable.type == "Enumeration" else _text(v) for v in values]
        if len(texts) == 1:
            typed.set("value", texts[0])
        for text in texts if len(texts) > 1 else ():
            etree.SubElement(typed, tag(SSV, "Value"), value=text)


def _numbers(variable: Variable, values: list[Any]) -> tuple[list[float], Unit | None]:
    """Numbers in the unit in which they were written; in the FMU's where they were written in several."""
    given = {v.unit for v in values}
    if given == {""}:
        return [v.number for v in values], None
    if len(given) == 1:
        try:
            return [v.number for v in values], known_unit(given.pop())
        except UnitFault:
            pass
    own = variable.unit.name if variable.unit is not None else "1"
    return [v.to(own) for v in values], variable.unit if variable.unit and variable.unit.exponents else None


def _integer(value: Any) -> int:
    if isinstance(value, PhysicalValue):
        return int(value.text) if value.text.strip().lstrip("+-").isdigit() else int(value.number)
    return int(value)


def _text(value: Any) -> str:
    """A text that looks like a quantity was read as one."""
    return (value.text or str(value)) if isinstance(value, PhysicalValue) else str(value)


def _item(variable: Variable, value: Any) -> str:
    """Name of an enumeration's item; SSP writes names."""
    items = variable.items or {}
    if isinstance(value, str) and value in items:
        return value
    for name, of in items.items():
        if isinstance(value, PhysicalValue) and of == value.number:
            return name
    raise ValueError(f"{variable.name} has no item {value}; it has: {', '.join(items) or 'none'}")
