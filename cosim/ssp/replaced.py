"""An export of FMUs alone: what stands in for the components that are left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from cosim.components import ProgrammeComponent
from cosim.connection import Connection
from cosim.ssp.export_parts import Part, Port
from cosim.ssp.model import IDENTITY, End, Linear
from cosim.unit.quantity import PhysicalValue


class Replaced:
    """Start values and inputs of the system in place of what left-out components give.

    Args:
        left_out: Their names.
        parts: All components.
    """

    def __init__(self, left_out: set[str], parts: Mapping[str, Part]) -> None:
        self._left_out, self._parts = left_out, parts
        self.starts: dict[str, dict[str, Any]] = {}
        self.inputs: dict[str, Port] = {}
        self._notes = [f"`{n}` ({parts[n].component.kind}) is left out: it is no FMU" for n in parts if n in left_out]

    @property
    def notes(self) -> tuple[str, ...]:
        """What is left out, and the inputs that stay open."""
        opened = [f"the system's input `{name}` is open: whoever runs it gives its values" for name in self.inputs]
        return (*self._notes, *opened)

    def as_start_value(self, connection: Connection, linear: Linear, suppress: bool) -> bool:
        """Take a constant of a programme as start value of the input that it leads to; False if it is none."""
        component = self._parts[connection.source[0]].component
        if not isinstance(component, ProgrammeComponent) or connection.target_element is not None or suppress:
            return False
        given = component.outputs[connection.source[1]]
        value = given.constant
        if value is None and given.points is not None and len(given.points) == 1:
            value = given.points[0][1]
        if not isinstance(value, PhysicalValue):
            return False
        if linear != IDENTITY:
            unit = self._parts[connection.target[0]].unit.variables[connection.target[1]].unit
            value = PhysicalValue(linear.factor * value.to(unit) + linear.offset, unit)
        self.starts.setdefault(connection.target[0], {})[connection.target[1]] = value
        return True

    def end(self, end: End, variable: str) -> End:
        """Source of a connection: where it is left out, an input of the system with its name."""
        if end.element not in self._left_out:
            return end
        name = f"{end.element}.{end.connector}"
        if name not in self.inputs:
            ports = {p.name: p for p in self._parts[end.element].ports(())}
            self.inputs[name] = replace(ports[end.connector], name=name, kind="input")
        return End(None, name, end.indices)
