"""Names of measured quantities: `supply.current`, `string[3].current`, `coil[2,5].temperature`, `marker[4].z`."""

from __future__ import annotations

import re
from dataclasses import dataclass

#: SI unit of every quantity that has a name of its own.
SI_UNITS = {
    "temperature": "K",
    "current": "A",
    "voltage": "V",
    "power": "W",
    "extension": "m",
    "length": "m",
    "link_length": "m",
    "stiffness": "N/m",
    "resistance": "ohm",
    "tension": "N",
    "max_curvature": "1/m",
    "x": "m",
    "y": "m",
    "z": "m",
    "angle": "rad",
    "angular_velocity": "rad/s",
}
#: Kind of element to its quantities and the number of indices that it may have.
_KINDS = {
    "supply": ({"current", "voltage", "power"}, {0}),
    "string": ({"current", "voltage"}, {1}),
    "coil": (
        {"temperature", "current", "voltage", "power", "extension", "length", "stiffness", "resistance", "tension"},
        {1, 2},
    ),
    "link": ({"x", "y", "z", "length"}, {1}),
    "marker": ({"x", "y", "z"}, {1}),
    "fabric": ({"max_curvature", "length"}, {0}),
}
#: SI unit to the part of a model that gives quantities in it; all others are mechanical.
_DOMAINS = {
    "K": "thermal",
    "A": "electrical",
    "V": "electrical",
    "W": "electrical",
    "ohm": "electrical",
    "N/m": "stiffness",
}
#: SI units and names of quantities of a component that only a mechanism has.
_MOVING = ("N", "N*m", "rad", "rad/s", "rad/s^2", "m/s^2")
_MOTION = ("position", "displacement", "deflection", "extension", "velocity", "speed")
#: Quantities of a component whose name says what they are: its `x` or `y` may be anything.
TELLING = {name: unit for name, unit in SI_UNITS.items() if name not in ("x", "y", "z")}
_INDEX = r"(\[(?P<{}>\d+(,\d+)*)\])?"
_NAME = re.compile(
    rf"^(?P<kind>[A-Za-z]\w*){_INDEX.format('index')}\.(?P<quantity>[A-Za-z]\w*){_INDEX.format('last')}$"
)


@dataclass(frozen=True)
class Target:
    """What a channel measures.

    Args:
        kind: `supply`, `string`, `coil`, `link`, `marker`, `fabric`, or the name of a component of the scenario.
        element: Numbers of the element, from 1: (string, place in it) or (number,); empty for a scalar.
        quantity: What is measured.
        unit: SI unit where the quantity has no name of its own; of a variable of a component, as it was recorded.
            Empty: nobody said.
    """

    kind: str
    element: tuple[int, ...]
    quantity: str
    unit: str = ""

    def __str__(self) -> str:
        index = f"[{','.join(map(str, self.element))}]" if self.element else ""
        return f"{self.kind}.{self.quantity}{index}" if self.is_component else f"{self.kind}{index}.{self.quantity}"

    @property
    def si_unit(self) -> str:
        """Unit of its values."""
        if self.is_component:
            return self.unit or TELLING.get(self.quantity, "1")
        return SI_UNITS.get(self.quantity, self.unit or "1")

    @property
    def domain(self) -> str:
        """Part of a model whose output it is: electrical, thermal, stiffness or mechanical."""
        return _DOMAINS.get(self.si_unit, "mechanical")

    @property
    def is_mechanical(self) -> bool:
        """Whether it is known to belong to a mechanism: a length of a component may be the level of a tank."""
        if not self.is_component:
            return self.domain == "mechanical"
        return self.si_unit in _MOVING or (self.si_unit in ("m", "m/s") and self.quantity in _MOTION)

    @property
    def is_component(self) -> bool:
        """Whether it is a variable of a component, named `component.variable[element]`.

        A component may be called `coil` or `supply`: `coil.current` names no coil of a circuit, which has a number.
        """
        return self.kind not in _KINDS or (not self.element and not _is_whole(self.kind, self.quantity))


def _is_whole(kind: str, quantity: str) -> bool:
    """Whether an element of a kind is named without a number: `supply.current`."""
    quantities, indices = _KINDS[kind]
    return 0 in indices and quantity in quantities


def is_numbered(kind: str) -> bool:
    """Whether elements of a kind have numbers: coils, strings, links, markers."""
    return kind in _KINDS and 0 not in _KINDS[kind][1]


def parse_quantity(name: str) -> Target:
    """Target of a channel's name.

    Raises:
        ValueError: It is no such name, or the kind has no such quantity or another number of indices.

    >>> parse_quantity("coil[2,5].temperature")
    Target(kind='coil', element=(2, 5), quantity='temperature', unit='')
    >>> parse_quantity("coil[2,5].temperature").is_component, parse_quantity("coil.current").is_component
    (False, True)
    """
    match = _NAME.match(name)
    if match is None:
        raise ValueError(f"`{name}` is no name of a quantity, such as `coil[2,5].temperature` or `supply.current`")
    kind, quantity = match["kind"], match["quantity"]
    element = tuple(int(i) for i in (match["index"] or match["last"] or "").split(",") if i)
    if kind not in _KINDS or not (element or _is_whole(kind, quantity)):
        return Target(kind, element, quantity)
    quantities, indices = _KINDS[kind]
    if quantity not in quantities:
        raise ValueError(f"`{name}`: a {kind} has no {quantity}; it has: {', '.join(sorted(quantities))}")
    if len(element) not in indices:
        example = {0: kind, 1: f"{kind}[3]", 2: f"{kind}[2,5]"}[max(indices)]
        raise ValueError(f"`{name}`: write `{example}.{quantity}`, counted from 1")
    if 0 in element:
        raise ValueError(f"`{name}`: elements are counted from 1")
    return Target(kind, element, quantity)
