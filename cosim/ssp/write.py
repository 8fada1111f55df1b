"""The System Structure Description (SSD) of a scenario."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lxml import etree

from cosim.ssp.annotations import own_annotations
from cosim.ssp.elements import add_dimensions, add_enumerations, add_units, number, root, type_name
from cosim.ssp.export_parts import Port
from cosim.ssp.model import IDENTITY, End, Linear, Unit
from cosim.ssp.namespaces import FLOAT_TYPES, SSC, SSD, Version, tag


@dataclass(frozen=True)
class WrittenComponent:
    """A component.

    Args:
        name: Name.
        type: Media type.
        source: Entry of the package.
        implementation: CoSimulation, ModelExchange or any.
        ports: Connectors.
        parameters: Entry of its parameter set, or None.
        own: Settings of ours that SSP has no place for.
    """

    name: str
    type: str
    source: str
    implementation: str
    ports: Sequence[Port]
    parameters: str | None
    own: Mapping[str, Any]


@dataclass(frozen=True)
class WrittenConnection:
    """A connection."""

    source: End
    target: End
    linear: Linear = IDENTITY
    suppress_unit_conversion: bool = False


@dataclass(frozen=True)
class WrittenStructure:
    """A whole description.

    Args:
        name: Title of the scenario.
        description: Its description.
        version: Version of SSP.
        inputs: Connectors of the system itself.
        components: Its components.
        connections: Its connections.
        start: Start time [s].
        stop: Stop time [s].
        own: Steps and algorithm.
    """

    name: str
    description: str
    version: Version
    inputs: Sequence[Port]
    components: Sequence[WrittenComponent]
    connections: Sequence[WrittenConnection]
    start: float
    stop: float
    own: Mapping[str, Any]


def description(structure: WrittenStructure) -> Any:
    """`ssd:SystemStructureDescription`.

    Raises:
        ValueError: Two units of one name differ, or SSP 1.0 cannot hold a type.
    """
    top = root(SSD, "SystemStructureDescription", structure.version, name=structure.name)
    if structure.description:
        top.set("description", structure.description)
    definitions = _Definitions(structure.version)
    system = etree.SubElement(top, tag(SSD, "System"), name="system")
    definitions.add_connectors(system, structure.inputs)
    elements = etree.SubElement(system, tag(SSD, "Elements"))
    for component in structure.components:
        elements.append(_component(component, definitions))
    if structure.connections:
        listed = etree.SubElement(system, tag(SSD, "Connections"))
        listed.extend(_connection(c) for c in structure.connections)
    add_enumerations(top, SSD, definitions.enumerations)
    add_units(top, SSD, definitions.units.values())
    experiment = etree.SubElement(top, tag(SSD, "DefaultExperiment"))
    experiment.set("startTime", number(structure.start))
    experiment.set("stopTime", number(structure.stop))
    experiment.append(own_annotations(structure.own))
    return top


class _Definitions:
    """Connectors, and the units and enumerations that they need."""

    def __init__(self, version: Version) -> None:
        self._version = version
        self.units: dict[str, Unit] = {}
        self.enumerations: dict[str, Mapping[str, int]] = {}

    def add_connectors(self, parent: Any, ports: Sequence[Port]) -> None:
        if not ports:
            return
        listed = etree.SubElement(parent, tag(SSD, "Connectors"))
        for port in ports:
            connector = etree.SubElement(listed, tag(SSD, "Connector"), name=port.name, kind=port.kind)
            typed = etree.SubElement(connector, tag(SSC, type_name(port.type, self._version)))
            if port.unit is not None and port.type in FLOAT_TYPES:
                typed.set("unit", self._unit(port.unit))
            if port.type == "Enumeration":
                typed.set("name", self._enumeration(f"{parent.get('name')}.{port.name}", port.items or {}))
            add_dimensions(connector, port.shape)

    def _unit(self, unit: Unit) -> str:
        """Name under which the file defines a unit; one that another FMU defines otherwise gets a number."""
        name, count = unit.name, 1
        while name in self.units and _differ(self.units[name], unit):
            count += 1
            name = f"{unit.name} ({count})"
        self.units.setdefault(name, Unit(name, unit.exponents, unit.factor, unit.offset))
        return name

    def _enumeration(self, name: str, items: Mapping[str, int]) -> str:
        for known, other in self.enumerations.items():
            if other == items:
                return known
        self.enumerations[name] = items
        return name


def _differ(a: Unit, b: Unit) -> bool:
    return (a.exponents[:-1], a.factor, a.offset) != (b.exponents[:-1], b.factor, b.offset)


def _component(component: WrittenComponent, definitions: _Definitions) -> Any:
    element = etree.Element(tag(SSD, "Component"), name=component.name, type=component.type, source=component.source)
    if component.implementation != "any":
        element.set("implementation", component.implementation)
    definitions.add_connectors(element, component.ports)
    if component.parameters is not None:
        bindings = etree.SubElement(element, tag(SSD, "ParameterBindings"))
        etree.SubElement(bindings, tag(SSD, "ParameterBinding"), source=component.parameters)
    if component.own:
        element.append(own_annotations(component.own))
    return element


def _connection(connection: WrittenConnection) -> Any:
    element = etree.Element(tag(SSD, "Connection"))
    for side, end in (("start", connection.source), ("end", connection.target)):
        if end.element is not None:
            element.set(f"{side}Element", end.element)
        element.set(f"{side}Connector", end.connector)
        if end.indices is not None:
            element.set(f"{side}Indices", " ".join(map(str, end.indices)))
    if connection.suppress_unit_conversion:
        element.set("suppressUnitConversion", "true")
    if connection.linear != IDENTITY:
        linear = etree.SubElement(element, tag(SSC, "LinearTransformation"))
        linear.set("factor", number(connection.linear.factor))
        linear.set("offset", number(connection.linear.offset))
    return element
