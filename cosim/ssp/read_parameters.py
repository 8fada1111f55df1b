"""Parameter sets (SSV) and parameter mappings (SSM): XML to `cosim.ssp.model`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from cosim.ssp.document import Document, validate
from cosim.ssp.model import (
    BASE_UNITS,
    Linear,
    MappingEntry,
    Parameter,
    ParameterSet,
    Place,
    Table,
    Transformation,
    Unit,
)
from cosim.ssp.namespaces import FLOAT_TYPES, INTEGER_TYPES, SSC, SSM, SSV, tag
from cosim.ssp.units import UnitFault, known_unit

_TRUE = {"true": True, "1": True, "false": False, "0": False}


class Definitions:
    """Units and enumerations of one file: they hold for that file alone.

    Args:
        document: The file.
        top: Its top-level element.
        namespace: Namespace of the elements `Units` and `Enumerations` of that file.
    """

    def __init__(self, document: Document, top: Any, namespace: str) -> None:
        self._document = document
        self.units = {u.get("name"): _unit(u) for u in top.iterfind(f"{tag(namespace, 'Units')}/{tag(SSC, 'Unit')}")}
        listed = top.iterfind(f"{tag(namespace, 'Enumerations')}/{tag(SSC, 'Enumeration')}")
        self.enumerations: dict[str, dict[str, int]] = {
            e.get("name"): {i.get("name"): int(i.get("value")) for i in e.iterfind(tag(SSC, "Item"))} for e in listed
        }

    def unit(self, element: Any) -> Unit | None:
        """Unit that an element names; one that the file fails to define is taken by its name, with a note."""
        name = element.get("unit")
        if name is None:
            return None
        if name not in self.units:
            self.units[name], meaning = _undefined(name)
            self._document.notes.append(f"{self._document.file}: the unit `{name}` is not defined there; {meaning}")
        return self.units[name]

    def enumeration(self, element: Any) -> Mapping[str, int] | None:
        """Items of the enumeration that an element names."""
        name = element.get("name")
        if name is None:
            return None
        if name not in self.enumerations:
            raise self._document.place(element).error(
                f"the enumeration `{name}` is not defined in the file", "define it under Enumerations"
            )
        return self.enumerations[name]


def _undefined(name: str) -> tuple[Unit, str]:
    try:
        return known_unit(name), "it was taken for what its name means"
    except UnitFault:
        return Unit(name, ()), "it fits variables with a unit of the same name only"


def _unit(element: Any) -> Unit:
    base = element.find(tag(SSC, "BaseUnit"))
    exponents = tuple(int(base.get(name, "0")) for name in BASE_UNITS)
    return Unit(element.get("name"), exponents, float(base.get("factor", "1")), float(base.get("offset", "0")))


def read_parameter_set(document: Document, element: Any) -> ParameterSet:
    """A parameter set, checked against its schema.

    Raises:
        InputError: It breaks the schema, a name stands twice, a value is not finite, or the number of values does not
            fit the dimensions.
    """
    validate(document, element, tag(SSV, "ParameterSet"))
    definitions = Definitions(document, element, SSV)
    found: dict[str, Parameter] = {}
    for entry in element.iterfind(f"{tag(SSV, 'Parameters')}/{tag(SSV, 'Parameter')}"):
        parameter = _parameter(document, entry, definitions)
        if parameter.name in found:
            raise parameter.place.error(f"the parameter `{parameter.name}` stands twice", "remove one of the two")
        found[parameter.name] = parameter
    return ParameterSet(element.get("name"), tuple(found.values()))


def _parameter(document: Document, entry: Any, definitions: Definitions) -> Parameter:
    place = document.place(entry)
    typed = next(c for c in entry if isinstance(c.tag, str) and c.tag != tag(SSC, "Dimension"))
    kind = typed.tag.removeprefix(f"{{{SSV}}}")
    shape = _shape(entry, place)
    values = tuple(_value(kind, text, place) for text in _texts(kind, typed))
    if len(values) != math.prod(shape):
        raise place.error(
            f"`{entry.get('name')}` has {len(values)} values; its dimensions ask for {math.prod(shape)}",
            "give one value per element, in row-major order",
        )
    unit = definitions.unit(typed) if kind in FLOAT_TYPES else None
    items = definitions.enumeration(typed) if kind == "Enumeration" else None
    return Parameter(entry.get("name"), kind, values, shape, unit, items, entry.get("description", ""), place)


def _shape(entry: Any, place: Place) -> tuple[int, ...]:
    sizes = [d.get("size") for d in entry.iterfind(tag(SSC, "Dimension"))]
    if None in sizes:
        raise place.error("a dimension of a parameter has no size", "give its size")
    return tuple(int(s) for s in sizes)


def _texts(kind: str, typed: Any) -> list[str]:
    """Texts of the elements: `Value` children, or the attribute: a list where the type's texts hold no blank."""
    children = [v.get("value") for v in typed.iterfind(tag(SSV, "Value"))]
    written = typed.get("value")
    if children or written is None:
        return children
    return written.split() if kind in FLOAT_TYPES | INTEGER_TYPES | {"Boolean"} else [written]


def _value(kind: str, text: str, place: Place) -> Any:
    if kind in FLOAT_TYPES:
        number = float(text.replace("INF", "inf"))
        if not math.isfinite(number):
            raise place.error(f"`{text}` is not a finite number", "give a finite value")
        return number
    if kind in INTEGER_TYPES:
        return int(text)
    return _TRUE[text] if kind == "Boolean" else text


def read_mapping(document: Document, element: Any) -> tuple[MappingEntry, ...]:
    """A parameter mapping, checked against its schema.

    Raises:
        InputError: It breaks the schema, or two entries lead to one name.
    """
    validate(document, element, tag(SSM, "ParameterMapping"))
    entries: dict[str, MappingEntry] = {}
    for entry in element.iterfind(tag(SSM, "MappingEntry")):
        place = document.place(entry)
        target = entry.get("target")
        if target in entries:
            raise place.error(f"two parameters are mapped to `{target}`", "remove one of the two entries")
        entries[target] = MappingEntry(
            entry.get("source"),
            target,
            is_true(entry, "suppressUnitConversion"),
            transformation(document, entry),
            place,
        )
    return tuple(entries.values())


def is_true(element: Any, attribute: str) -> bool:
    """Value of a Boolean attribute; absent is false."""
    return _TRUE[element.get(attribute, "false").strip()]


def transformation(document: Document, element: Any) -> Transformation | None:
    """The transformation inside a connection or a mapping entry.

    Raises:
        InputError: Two entries map one value.
    """
    linear = element.find(tag(SSC, "LinearTransformation"))
    if linear is not None:
        factor, offset = float(linear.get("factor", "1")), float(linear.get("offset", "0"))
        if not (math.isfinite(factor) and math.isfinite(offset)):
            raise document.place(linear).error("factor or offset is not a finite number", "give finite numbers")
        return Linear(factor, offset)
    readers: dict[str, Callable[[str], Any]] = {"Boolean": lambda text: _TRUE[text], "Integer": int, "Enumeration": str}
    for kind, read in readers.items():
        table = element.find(tag(SSC, f"{kind}MappingTransformation"))
        if table is None:
            continue
        entries: dict[Any, Any] = {}
        for entry in table.iterfind(tag(SSC, "MapEntry")):
            source = read(entry.get("source"))
            if source in entries:
                raise document.place(entry).error(f"two entries map {source}", "keep one of them")
            entries[source] = read(entry.get("target"))
        return Table(kind, entries)
    return None
