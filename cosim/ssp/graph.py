"""Connections of nested systems followed from every component's input back to the output that feeds it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from cosim.ssp.model import (
    IDENTITY,
    Component,
    Connection,
    Connector,
    DictionaryReference,
    Element,
    End,
    Linear,
    Place,
    System,
    Table,
    Transformation,
    Unit,
)
from cosim.ssp.namespaces import FLOAT_TYPES
from cosim.ssp.units import UnitFault, across, convert

Path = tuple[str, ...]
#: A connector: path of its element from the root system, which is `()`, and its name.
Node = tuple[Path, str]
Indices = tuple[int, ...] | None

_GIVES = frozenset({"output", "calculatedParameter", "constant", "local"})
_TAKES = frozenset({"input", "parameter", "structuralParameter"})


@dataclass(frozen=True)
class Edge:
    """A connection whose direction is known."""

    source: Node
    source_indices: Indices
    target: Node
    target_indices: Indices
    suppress_unit_conversion: bool
    transformation: Transformation | None
    place: Place


@dataclass(frozen=True)
class Flow:
    """What reaches a node: target = linear(conversion(source)).

    Args:
        source: Connector of a component.
        unit: Unit at this point of the way.
        place: The last connection.
        source_indices: The one element that is read.
        target_indices: The one element that is reached.
        conversion: Of units, before anything else happens to the value.
        linear: Everything after that.
    """

    source: Node
    unit: Unit | None
    place: Place
    source_indices: Indices = None
    target_indices: Indices = None
    conversion: Linear = IDENTITY
    linear: Linear = IDENTITY

    @property
    def total(self) -> Linear:
        """Both together."""
        return _after(self.conversion, self.linear)


class Graph:
    """All elements of a system with those of its subsystems, and the connections between them.

    Args:
        system: Root system.
        unit_of: Unit of a component's variable where its connector declares none.

    Raises:
        InputError: A connection names what is not there, or cannot have a direction.
    """

    def __init__(self, system: System, unit_of: Callable[[Path, str], Unit | None]) -> None:
        self.elements: dict[Path, Element] = {}
        self.edges: list[Edge] = []
        self._unit_of = unit_of
        self._incoming: dict[Node, list[Edge]] = {}
        self.outgoing: dict[Node, list[Edge]] = {}
        self._add(system, (), {})

    @cached_property
    def components(self) -> Mapping[Path, Component]:
        """Every component by its path, in the order of the file."""
        return {path: e for path, e in self.elements.items() if isinstance(e, Component)}

    def _add(self, system: System, path: Path, dictionaries: Mapping[str, Path]) -> None:
        self.elements[path] = system
        known = {**dictionaries, **{name: (*path, f"\0{name}") for name in system.dictionaries}}
        for name, element in system.elements.items():
            if isinstance(element, System):
                self._add(element, (*path, name), known)
            else:
                self.elements[*path, name] = element
        for connection in system.connections:
            edge = self._edge(system, path, connection, known)
            self._incoming.setdefault(edge.target, []).append(edge)
            self.outgoing.setdefault(edge.source, []).append(edge)
            self.edges.append(edge)

    def connector(self, node: Node) -> Connector | None:
        """Connector at a node; None for an entry of a signal dictionary."""
        element = self.elements.get(node[0])
        return element.connectors.get(node[1]) if element is not None else None

    def unit(self, node: Node) -> Unit | None:
        """Unit that holds at a node: its connector's, else that of the component's variable."""
        connector = self.connector(node)
        return connector.unit if connector is not None and connector.unit is not None else self.inner_unit(node)

    def inner_unit(self, node: Node) -> Unit | None:
        """Unit of the component's variable behind a connector; that of the connector where there is none."""
        if not isinstance(self.elements.get(node[0]), Component):
            return None
        found = self._unit_of(*node)
        connector = self.connector(node)
        return found if found is not None or connector is None else connector.unit

    def _crossed(self, node: Node, flow: Flow, inwards: bool) -> Flow:
        """A flow behind the connector of a component: in the unit of the variable, or the other way round."""
        inner, outer = self.inner_unit(node), self.unit(node)
        try:
            step = Linear(*(across(outer, inner) if inwards else across(inner, outer)))
        except UnitFault as error:
            raise flow.place.error(
                f"connector `{node[1]}`: {error}", "give the connector the unit of its variable"
            ) from error
        return _converted(flow, step)

    def _edge(self, system: System, path: Path, c: Connection, dictionaries: Mapping[str, Path]) -> Edge:
        (start, gives), (end, takes) = (self._end(system, path, e, c.place, dictionaries) for e in (c.start, c.end))
        forward, backward = gives[0] and takes[1], takes[0] and gives[1]
        if forward == backward:
            why = "either end could be the source" if forward else "neither end can be the source of the other"
            raise c.place.error(
                f"{c.start} -- {c.end}: {why}, by the kinds of the two connectors",
                "connect an output to an input (SSP, section Allowed Connections)",
            )
        ends = [(start, c.start.indices), (end, c.end.indices)]
        (source, source_indices), (target, target_indices) = ends if forward else reversed(ends)
        self._check_transformation(c, source)
        return Edge(
            source, source_indices, target, target_indices, c.suppress_unit_conversion, c.transformation, c.place
        )

    def _end(
        self, system: System, path: Path, end: End, place: Place, dictionaries: Mapping[str, Path]
    ) -> tuple[Node, tuple[bool, bool]]:
        """Node of an end, and whether it can give and take a value as seen from inside `system`."""
        element = system if end.element is None else system.elements.get(end.element)
        if element is None:
            raise place.error(f"there is no element `{end.element}`", f"there are: {', '.join(system.elements)}")
        connector = element.connectors.get(end.connector)
        if connector is None:
            there = ", ".join(element.connectors) or "none"
            raise place.error(f"`{element.name}` has no connector `{end.connector}`", f"it has: {there}")
        if isinstance(element, DictionaryReference):
            scope = dictionaries.get(element.dictionary)
            if scope is None:
                raise element.place.error(f"there is no signal dictionary `{element.dictionary}`", "correct the name")
            return (scope, end.connector), (True, True)
        gives, takes = connector.kind in _GIVES, connector.kind in _TAKES
        if end.element is None:  # an input of a system gives what it takes from outside to what is inside
            gives, takes = takes, gives
        if not gives and not takes:  # inout, unspecified: whatever the other end needs
            gives = takes = True
        return (path if end.element is None else (*path, end.element), end.connector), (gives, takes)

    def _check_transformation(self, c: Connection, source: Node) -> None:
        """Refuse what a connection of ours cannot carry out."""
        if isinstance(c.transformation, Table) and any(a != b for a, b in c.transformation.entries.items()):
            raise c.place.error(
                f"{c.start} -- {c.end}: connections do not carry out a {c.transformation.kind}MappingTransformation",
                "do it in a component; only linear transformations are carried out",
            )
        connector = self.connector(source)
        kind = connector.type if connector is not None else None
        if isinstance(c.transformation, Linear) and kind is not None and kind not in FLOAT_TYPES:
            raise c.place.error(
                f"{c.start} -- {c.end}: a linear transformation of a value of type {kind}",
                "it is for floating point only",
            )

    def flows(self, node: Node, way: tuple[Node, ...] = ()) -> list[Flow]:
        """Every output that feeds a node, element by element where connections have indices.

        Raises:
            InputError: Units do not fit, connections form a ring without a component, or two lead to one place.
        """
        found: list[Flow] = []
        for edge in self._incoming.get(node, ()):
            if edge.source in way:
                raise edge.place.error("connections of systems form a ring without a component", "cut it")
            if edge.source[0] in self.components:
                origin = Flow(edge.source, self.unit(edge.source), edge.place)
                arriving = [self._crossed(edge.source, origin, inwards=False)]
            else:
                arriving = self.flows(edge.source, (*way, node))
            found += [self.through(edge, f) for f in _selected(arriving, edge)]
        reached: set[Indices] = set()
        for flow in found:
            if flow.target_indices in reached or (reached and None in (*reached, flow.target_indices)):
                raise flow.place.error(
                    f"another connection already leads into `{'.'.join(node[0])}.{node[1]}`", "remove one"
                )
            reached.add(flow.target_indices)
        return found

    def through(self, edge: Edge, flow: Flow) -> Flow:
        """A flow behind one more connection."""
        unit = self.unit(edge.target)
        if unit is not None and flow.unit is not None and not edge.suppress_unit_conversion:
            try:
                step = Linear(*convert(flow.unit, unit))
            except UnitFault as error:
                raise edge.place.error(
                    str(error), "correct the units of the connectors, or set suppressUnitConversion"
                ) from error
            flow = _converted(flow, step)
        if isinstance(edge.transformation, Linear):
            flow = replace(flow, linear=_after(flow.linear, edge.transformation))
        new = unit if unit is not None or edge.suppress_unit_conversion else flow.unit
        flow = replace(flow, unit=new, place=edge.place)
        return self._crossed(edge.target, flow, inwards=True) if edge.target[0] in self.components else flow


def _converted(flow: Flow, step: Linear) -> Flow:
    if flow.linear == IDENTITY:
        return replace(flow, conversion=_after(flow.conversion, step))
    return replace(flow, linear=_after(flow.linear, step))


def _after(first: Linear, second: Linear) -> Linear:
    """Both in a row; one that does nothing leaves the other as it is written."""
    if first == IDENTITY:
        return second
    if second == IDENTITY:
        return first
    return Linear(second.factor * first.factor, second.factor * first.offset + second.offset)


def _selected(arriving: list[Flow], edge: Edge) -> list[Flow]:
    """What of the flows into an edge's source goes on through it, with the elements that it reaches."""
    if edge.source_indices is None and edge.target_indices is None:
        return arriving
    if edge.source_indices is None:
        return [replace(f, target_indices=edge.target_indices) for f in arriving]
    exact = [f for f in arriving if f.target_indices == edge.source_indices]
    whole = [replace(f, source_indices=edge.source_indices) for f in arriving if f.target_indices is None]
    return [replace(f, target_indices=edge.target_indices) for f in exact or whole]
