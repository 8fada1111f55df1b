"""Flows of a graph to connections of a scenario; element-wise ones that cover whole arrays become one."""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cosim.ssp.fmus import Fmu
from cosim.ssp.graph import Flow, Graph, Indices, Node, Path
from cosim.ssp.model import BASE_UNITS, Linear, Unit
from cosim.ssp.units import UnitFault, convert

_OWN_ELEMENT = re.compile(r"^(?P<name>\w+)\[(?P<index>[\d,]+)\]$")


@dataclass(frozen=True)
class Variable:
    """A variable of a scenario's component, whole or one element of it."""

    path: Path
    name: str
    element: Indices

    def text(self, component: str) -> str:
        """As a scenario writes it."""
        index = "" if self.element is None else f"[{','.join(map(str, self.element))}]"
        return f"{component}.{self.name}{index}"


class Ends:
    """Connectors of an SSP as variables of a scenario's components.

    Args:
        names: Path to component.
        fmus: Path to FMU.
        graph: The system.
    """

    def __init__(self, names: Mapping[Path, str], fmus: Mapping[Path, Fmu], graph: Graph) -> None:
        self.names, self.fmus, self._graph = names, fmus, graph
        self.locals: dict[Path, list[str]] = {}

    def variable(self, node: Node, indices: Indices) -> Variable:
        """Variable of a component's connector: `x[3]` of FMI 2.0 is an element of the array `x`."""
        path, name = node
        if path in self.fmus:
            own_name = self.fmus[path].variables[name].name  # of which `name` may be an alias
            gathered = self.fmus[path].elements.get(own_name)
            return Variable(path, own_name, indices) if gathered is None else Variable(path, *gathered)
        match = _OWN_ELEMENT.match(name)
        if match:
            return Variable(path, match["name"], tuple(int(i) for i in match["index"].split(",")))
        return Variable(path, name, indices)

    def elements(self, variable: Variable) -> list[tuple[int, ...]]:
        """Every element of the array, in row-major order; empty where its size is not known."""
        path, name = variable.path, variable.name
        if path in self.fmus and name in self.fmus[path].arrays:
            return [self.fmus[path].elements[e][1] for e in self.fmus[path].arrays[name]]
        connectors = self._graph.elements[path].connectors
        if name in connectors:
            sizes = [s for s in connectors[name].dimensions if s is not None]
            whole = len(sizes) == len(connectors[name].dimensions) > 0
            return list(itertools.product(*(range(1, s + 1) for s in sizes))) if whole else []
        matches = (_OWN_ELEMENT.match(c) for c in connectors)
        return sorted(tuple(int(i) for i in m["index"].split(",")) for m in matches if m and m["name"] == name)

    def unit(self, node: Node) -> Unit:
        """Unit that the variable has in a scenario: the FMU's own declaration, that of a connector of ours."""
        path, name = node
        found = self.fmus[path].variables[name].unit if path in self.fmus else self._graph.unit(node)
        return found if found is not None else Unit("1", (0,) * len(BASE_UNITS))


def connections(graph: Graph, ends: Ends) -> list[str | dict[str, Any]]:
    """Connections of the scenario, in the order of components and connectors.

    Raises:
        InputError: What a connection asks for cannot be carried out.
    """
    found: list[str | dict[str, Any]] = []
    for path, component in graph.components.items():
        groups: dict[Any, list[tuple[Flow, Variable, Variable]]] = {}
        for name in component.connectors:
            node = (path, name)
            for flow in graph.flows(node):
                _check_causality(graph, ends, flow, node)
                source, target = (
                    ends.variable(flow.source, flow.source_indices),
                    ends.variable(node, flow.target_indices),
                )
                key = (source.path, source.name, target.name, _scaling(ends, flow, node))
                groups.setdefault(key, []).append((flow, source, target))
        for (*_, scaling), members in groups.items():
            found += [_written(text, scaling) for text in _texts(ends, members)]
    return found


def _check_causality(graph: Graph, ends: Ends, flow: Flow, target: Node) -> None:
    """A connection of a scenario leads from an output (or a local variable) to an input."""
    fmu = ends.fmus.get(target[0])
    if fmu is not None and fmu.variables[target[1]].causality != "input":
        raise flow.place.error(
            f"`{'.'.join(target[0])}.{target[1]}` is a {fmu.variables[target[1]].causality}; only inputs are connected",
            "bind a value to it in a parameter set",
        )
    source = ends.fmus.get(flow.source[0])
    if source is None:
        return
    variable = source.variables[flow.source[1]]
    if variable.causality == "local":
        recorded = ends.locals.setdefault(flow.source[0], [])
        name = ends.variable(flow.source, None).name
        recorded += [name] if name not in recorded else []
    elif variable.causality != "output":
        raise flow.place.error(
            f"`{'.'.join(flow.source[0])}.{flow.source[1]}` is a {variable.causality}; only outputs and locals "
            "are read",
            "bind a value to the target in a parameter set",
        )


def _scaling(ends: Ends, flow: Flow, target: Node) -> tuple[float, float, bool]:
    """(factor, offset, whether units are converted before) that a scenario's connection needs for a flow."""
    try:
        ours: Linear | None = Linear(*convert(ends.unit(flow.source), ends.unit(target)))
    except UnitFault:
        ours = None
    if ours is not None and _close(flow.conversion.factor, ours.factor) and _close(flow.conversion.offset, ours.offset):
        return flow.linear.factor, flow.linear.offset, True
    return flow.total.factor, flow.total.offset, False


def _close(a: float, b: float) -> bool:
    return abs(a - b) <= 1e-12 * max(abs(a), abs(b))


def _texts(ends: Ends, members: list[tuple[Flow, Variable, Variable]]) -> list[str]:
    _, first_source, first_target = members[0]
    source, target = (ends.names[v.path] for v in (first_source, first_target))
    pairs = [(s.element, t.element) for _, s, t in members]
    all_targets = ends.elements(first_target)
    if all_targets and [t for _, t in pairs] == all_targets:
        froms = [s for s, _ in pairs]
        if froms == ends.elements(first_source):
            return [f"{source}.{first_source.name} -> {target}.{first_target.name}"]
        if len(set(froms)) == 1:
            return [f"{first_source.text(source)} -> {target}.{first_target.name}"]
    return [f"{s.text(source)} -> {t.text(target)}" for _, s, t in members]


def _written(text: str, scaling: tuple[float, float, bool]) -> str | dict[str, Any]:
    factor, offset, converts = scaling
    if scaling == (1.0, 0.0, True):
        return text
    given: dict[str, Any] = {"connect": text}
    if factor != 1.0:
        given["factor"] = factor
    if offset != 0.0:
        given["offset"] = offset
    if not converts:
        given["convert_units"] = False
    return given
