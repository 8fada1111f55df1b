"""Values of an FMU component to a parameter set (SSV)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from lxml import etree

from cosim.components import ParameterValue
from cosim.ssp.elements import add_dimensions, add_units, number, root, type_name
from cosim.ssp.fmus import Fmu, Variable
from cosim.ssp.model import Unit
from cosim.ssp.namespaces import FLOAT_TYPES, SSV, Version, tag


@dataclass(frozen=True)
class Entry:
    """One value to be written.

    Args:
        name: Variable, or array of variables, of the FMU.
        value: As a scenario holds it.
        source: Where it comes from.
    """

    name: str
    value: ParameterValue | int
    source: str = ""


def parameter_set(name: str, entries: list[Entry], fmu: Fmu, structure: Mapping[str, int], version: Version) -> Any:
    """`ssv:ParameterSet` of a component.

    Numbers are written in the unit of their variable, so that tools that do not convert units read them right.

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
        array = fmu.array(entry.name, entry.value, structure)
        names = fmu.arrays.get(entry.name)  # gathered from scalars: one parameter for each of them
        parts = [array] if names is None else [np.full((), array[i], array.dtype) for i in np.ndindex(array.shape)]
        written = [(fmu.variables[n], part) for n, part in zip(names or (entry.name,), parts, strict=True)]
        for variable, values in written:
            if values.ndim and version == "1.0":
                raise ValueError(f"`{variable.name}` is an array of FMI 3.0, which SSP 1.0 does not have")
            element = etree.SubElement(listed, tag(SSV, "Parameter"), name=variable.name)
            if entry.source:
                element.set("description", entry.source)
            _add_value(element, variable, values.ravel().tolist(), units, version)
            add_dimensions(element, values.shape)
    add_units(top, SSV, units.values())
    return top


def _add_value(element: Any, variable: Variable, values: list[Any], units: dict[str, Unit], version: Version) -> None:
    typed = etree.SubElement(element, tag(SSV, type_name(variable.type, version)))
    if variable.unit is not None and variable.unit.exponents:
        units[variable.unit.name] = variable.unit
        typed.set("unit", variable.unit.name)
    texts = [_text(variable, v) for v in values]
    if variable.type not in ("String", "Enumeration", "Binary"):
        typed.set("value", " ".join(texts))
    elif len(texts) == 1:
        typed.set("value", texts[0])
    else:
        for text in texts:
            etree.SubElement(typed, tag(SSV, "Value"), value=text)


def _text(variable: Variable, value: Any) -> str:
    if variable.type in FLOAT_TYPES:
        return number(value)
    if variable.type == "Boolean":
        return str(bool(value)).lower()
    if variable.type == "Enumeration":
        return next(name for name, of in (variable.items or {}).items() if of == value)
    return value.hex() if isinstance(value, bytes) else str(value)
