"""Parameter bindings applied: which value every variable of every component gets, by the standard's priorities."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from cosim.ssp.graph import Edge, Flow, Graph, Node, Path
from cosim.ssp.model import IDENTITY, Binding, Component, Linear, MappingEntry, Parameter, Place, System, Table, Unit
from cosim.ssp.namespaces import FLOAT_TYPES
from cosim.ssp.units import UnitFault, across

_TAKEN = frozenset({"input", "parameter", "structuralParameter"})


@dataclass(frozen=True)
class Value:
    """A value on its way to a variable.

    Args:
        parameter: Where it comes from; its values are those written unless `is_changed`.
        values: Elements in row-major order.
        unit: Unit of the elements; None where nothing says.
        is_changed: Whether a conversion or transformation has been applied.
        set_name: Name of the parameter set.
    """

    parameter: Parameter
    values: tuple[Any, ...]
    unit: Unit | None
    is_changed: bool
    set_name: str

    @property
    def place(self) -> Place:
        """Where it stands."""
        return self.parameter.place

    def in_unit(self, unit: Unit | None) -> Value:
        """The value in the unit of its target; one whose unit, or whose target's, is not known stays as it is.

        Raises:
            InputError: The units measure different things.
        """
        try:
            factor, offset = across(self.unit, unit)
        except UnitFault as error:
            raise self.place.error(f"`{self.parameter.name}`: {error}", "correct the unit") from error
        if (factor, offset) == (1.0, 0.0):
            return replace(self, unit=self.unit if unit is None else unit)
        return self.scaled(factor, offset, unit)

    def scaled(self, factor: float, offset: float, unit: Unit | None) -> Value:
        """factor * value + offset, through 15 digits, as quantities with units are converted everywhere here."""
        values = tuple(float(f"{factor * v + offset:.15g}") for v in self.values)
        return replace(self, values=values, unit=unit, is_changed=True)


class Bindings:
    """Values of all variables of all components of a graph.

    Args:
        graph: Elements and connections.
        has_variable: Whether a component has a variable of that name.
        notes: Bindings that reach nothing are named here.

    Raises:
        InputError: A unit or transformation does not fit.
    """

    def __init__(self, graph: Graph, has_variable: Any, notes: list[str]) -> None:
        self._graph, self._has_variable = graph, has_variable
        self.values: dict[Node, Value] = {}
        # Deepest first: what is bound at a higher level, and later at one level, replaces what was there.
        for path in sorted(graph.elements, key=len, reverse=True):
            for binding in graph.elements[path].bindings:
                if not self._apply(path, binding):
                    notes.append(f"{binding.place}: no parameter of this binding reaches a variable")
        self._hand_down()

    def _apply(self, path: Path, binding: Binding) -> int:
        count = 0
        for name, parameter, entry in _named(binding):
            for node in self._nodes(path, name):
                self.values[node] = self._transformed(parameter, entry, node, binding.parameters.name)
                count += 1
        return count or not binding.parameters.parameters

    def _nodes(self, path: Path, name: str) -> Iterator[Node]:
        """Every variable that a hierarchical name means inside an element."""
        element = self._graph.elements[path]
        if isinstance(element, Component):
            if self._has_variable(path, name):
                yield path, name
        elif isinstance(element, System):
            if name in element.connectors:
                yield path, name
            for child in element.elements:
                if name.startswith(f"{child}."):
                    yield from self._nodes((*path, child), name.removeprefix(f"{child}."))

    def _transformed(self, parameter: Parameter, entry: MappingEntry | None, node: Node, set_name: str) -> Value:
        unit = self._graph.inner_unit(node) or self._graph.unit(node)
        value = Value(parameter, parameter.values, parameter.unit, False, set_name)
        if entry is None:
            return value if unit is None or value.unit is not None else replace(value, unit=unit)
        value = replace(value, unit=unit, is_changed=True) if entry.suppress_unit_conversion else value.in_unit(unit)
        if isinstance(entry.transformation, Linear):
            if parameter.type not in FLOAT_TYPES:
                raise entry.place.error(
                    f"a linear transformation of a value of type {parameter.type}", "it is for floating point only"
                )
            return value.scaled(entry.transformation.factor, entry.transformation.offset, value.unit)
        if isinstance(entry.transformation, Table):
            entries = entry.transformation.entries
            return replace(value, values=tuple(entries.get(v, v) for v in value.values), is_changed=True)
        return value

    def _hand_down(self) -> None:
        """Values of systems' inputs and parameters go on to what these are connected to, and hold there."""
        for path in sorted(self._graph.elements, key=len):
            element = self._graph.elements[path]
            if not isinstance(element, System):
                continue
            for name, connector in element.connectors.items():
                value = self.values.get((path, name))
                if value is not None and connector.kind in _TAKEN and not self._graph.flows((path, name)):
                    for edge in self._graph.outgoing.get((path, name), ()):
                        self._carry(edge, value)

    def _carry(self, edge: Edge, value: Value) -> None:
        if edge.source_indices is not None or edge.target_indices is not None:
            raise edge.place.error(
                "a parameter value cannot go through a connection of single elements",
                "bind the value to the component itself",
            )
        value = value.in_unit(self._graph.unit(edge.source))
        if value.parameter.type in FLOAT_TYPES:
            behind = self._graph.through(edge, Flow(edge.source, value.unit, edge.place))
            unit = self._graph.inner_unit(edge.target) or behind.unit
            if behind.total != IDENTITY:
                value = value.scaled(behind.total.factor, behind.total.offset, unit)
            else:
                value = replace(value, unit=unit)
        self.values[edge.target] = value


def _named(binding: Binding) -> Iterator[tuple[str, Parameter, MappingEntry | None]]:
    """Every parameter of a binding under the name that applies, with its mapping entry."""
    by_name = {f"{binding.prefix}{p.name}": p for p in binding.parameters.parameters}
    if binding.mapping is None:
        yield from ((name, parameter, None) for name, parameter in by_name.items())
        return
    for entry in binding.mapping:
        if entry.source in by_name:
            yield entry.target, by_name[entry.source], entry
