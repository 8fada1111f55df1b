"""What an SSP describes, as typed values: systems, components, connectors, connections, parameter bindings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cosim.unit.errors import InputError

#: Names of the SI base units of an SSP `BaseUnit`, in the order of `Unit.exponents`.
BASE_UNITS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


@dataclass(frozen=True)
class Place:
    """Where something stands, for error texts.

    Args:
        package: The .ssp (or .ssd) file that the user gave.
        file: File inside it.
        line: Line in that file.
    """

    package: Path
    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}, line {self.line}"

    def error(self, problem: str, remedy: str) -> InputError:
        """The error of a fault at this place."""
        return InputError(self.package, str(self), problem, remedy)


@dataclass(frozen=True)
class Unit:
    """A unit with its definition: value in SI = factor * value + offset.

    Args:
        name: As written.
        exponents: Of `BASE_UNITS`, shape (8,).
        factor: To SI.
        offset: To SI.
    """

    name: str
    exponents: tuple[int, ...]
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Linear:
    """target = factor * source + offset, after conversion of units."""

    factor: float = 1.0
    offset: float = 0.0


IDENTITY = Linear()


@dataclass(frozen=True)
class Table:
    """A mapping of single values; what is not listed stays as it is.

    Args:
        kind: Boolean, Integer or Enumeration (there the entries are item names).
        entries: Source to target.
    """

    kind: str
    entries: Mapping[Any, Any]


Transformation = Linear | Table


@dataclass(frozen=True)
class Connector:
    """A connector of a system or component.

    Args:
        name: Name.
        kind: input, output, parameter, calculatedParameter, structuralParameter, constant, local, inout, unspecified.
        type: Name of the type element (`Real`, `Float64`, ...); None where it is not given.
        unit: Declared unit.
        dimensions: Size of each dimension; None where it depends on another connector or is not given.
        place: Where it stands.
    """

    name: str
    kind: str
    type: str | None
    unit: Unit | None
    dimensions: tuple[int | None, ...]
    place: Place


@dataclass(frozen=True)
class End:
    """One end of a connection.

    Args:
        element: Element of the system; None is the system itself.
        connector: Connector.
        indices: One element of an array connector, counted from 1; None is the whole.
    """

    element: str | None
    connector: str
    indices: tuple[int, ...] | None = None

    def __str__(self) -> str:
        index = "" if self.indices is None else f"[{','.join(map(str, self.indices))}]"
        return f"{self.element}.{self.connector}{index}" if self.element else f"{self.connector}{index}"


@dataclass(frozen=True)
class Connection:
    """A connection between two ends; which of them is the source follows from the kinds of their connectors."""

    start: End
    end: End
    suppress_unit_conversion: bool
    transformation: Transformation | None
    place: Place


@dataclass(frozen=True)
class Parameter:
    """One entry of a parameter set.

    Args:
        name: Name.
        type: Name of the type element.
        values: Elements in row-major order: float, int, bool or text (String, Enumeration, Binary in hexadecimal).
        shape: Shape of the array; `()` is a scalar.
        unit: Unit of the values.
        enumeration: Item name to value, where the file defines them.
        description: What the file says of it.
        place: Where it stands.
    """

    name: str
    type: str
    values: tuple[Any, ...]
    shape: tuple[int, ...]
    unit: Unit | None
    enumeration: Mapping[str, int] | None
    description: str
    place: Place


@dataclass(frozen=True)
class ParameterSet:
    """A parameter set and the file that it comes from."""

    name: str
    parameters: tuple[Parameter, ...]


@dataclass(frozen=True)
class MappingEntry:
    """A parameter of the source under the name, and transformed for, the target."""

    source: str
    target: str
    suppress_unit_conversion: bool
    transformation: Transformation | None
    place: Place


@dataclass(frozen=True)
class Binding:
    """A parameter set applied to an element.

    Args:
        parameters: The set.
        mapping: Its entries, or None where names apply as they are.
        prefix: Put before every name of the set.
        place: Where it stands.
    """

    parameters: ParameterSet
    mapping: tuple[MappingEntry, ...] | None
    prefix: str
    place: Place


@dataclass(frozen=True)
class Element:
    """What components, systems and signal dictionary references have in common."""

    name: str
    connectors: Mapping[str, Connector]
    bindings: tuple[Binding, ...]
    place: Place


@dataclass(frozen=True)
class Component(Element):
    """An atomic element.

    Args:
        type: Media type.
        source: File, resolved; None where none is given.
        implementation: any, CoSimulation, ModelExchange or ScheduledExecution.
        own: Settings of ours that its annotation holds.
    """

    type: str
    source: Path | None
    implementation: str
    own: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class DictionaryReference(Element):
    """Access to a signal dictionary, by name."""

    dictionary: str


@dataclass(frozen=True)
class System(Element):
    """A system: elements and the connections between them."""

    elements: Mapping[str, Element]
    connections: tuple[Connection, ...]
    dictionaries: frozenset[str]


@dataclass(frozen=True)
class Structure:
    """A System Structure Description, read.

    Args:
        name: Its name.
        version: 1.0 or 2.0.
        description: Its description.
        system: Root system.
        start: Start time of the default experiment [s].
        stop: Its stop time [s].
        own: Settings of ours: time and algorithm.
        step: Step size [s] that an annotation of another tool gives.
        notes: What was read otherwise than written.
        place: Its root element.
    """

    name: str
    version: str
    description: str
    system: System
    start: float | None
    stop: float | None
    own: Mapping[str, Any]
    step: float | None
    notes: tuple[str, ...]
    place: Place
