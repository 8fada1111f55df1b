"""Components of a scenario as an SSP shows them: connectors, and the names of array elements."""

from __future__ import annotations

import itertools
from collections.abc import Collection
from dataclasses import dataclass

from cosim.components import Component, FmuComponent
from cosim.ssp.fmus import Fmu
from cosim.ssp.model import Unit
from cosim.ssp.namespaces import FLOAT_TYPES, Version
from cosim.ssp.units import UnitFault, known_unit
from cosim.unit.protocol import Causality
from cosim.unit.protocol import Unit as SimulatedUnit
from cosim.unit.variable import Variable

_KINDS = {Causality.INPUT: "input", Causality.OUTPUT: "output"}


@dataclass(frozen=True)
class Port:
    """A connector to be written."""

    name: str
    kind: str
    type: str
    unit: Unit | None
    shape: tuple[int, ...]
    items: dict[str, int] | None = None


@dataclass(frozen=True)
class Part:
    """A component to be written.

    Args:
        name: Its name.
        component: What the scenario says.
        unit: The assembled unit: variables and shapes.
        fmu: Its FMU; None for a component of ours.
        version: Version of SSP.
    """

    name: str
    component: Component
    unit: SimulatedUnit
    fmu: Fmu | None
    version: Version

    @property
    def structure(self) -> dict[str, int]:
        """Structural parameters of its FMU."""
        return dict(self.component.structure) if isinstance(self.component, FmuComponent) else {}

    def is_split(self, name: str) -> bool:
        """Whether an array is written as one connector per element.

        Raises:
            ValueError: It would have to be, but is one variable of its FMU.
        """
        if not self.unit.variables[name].shape:
            return False
        if self.fmu is not None:
            is_split = name in self.fmu.arrays
            if not is_split and self.version == "1.0":
                raise ValueError(
                    f"components.{self.name}: `{name}` is an array of FMI 3.0, which SSP 1.0 does not have"
                )
            return is_split
        return self.version == "1.0"

    def ports(self, connected: Collection[str]) -> list[Port]:
        """Every output, and the inputs that are connected.

        An input that is not listed keeps its start value in every tool; some set listed ones to 0.

        Args:
            connected: Names of inputs.
        """
        found = []
        for name, variable in self.unit.variables.items():
            if variable.causality is Causality.OUTPUT or name in connected:
                found += [self._port(name, written, variable) for written in self.element_names(name)]
        return found

    def element_names(self, name: str) -> list[str]:
        """Names of the connectors of a variable, in row-major order."""
        variable = self.unit.variables[name]
        if not self.is_split(name):
            return [name]
        ranges = [range(variable.first_index, variable.first_index + size) for size in variable.shape]
        return [f"{name}[{','.join(map(str, index))}]" for index in itertools.product(*ranges)]

    def end(self, name: str, element: tuple[int, ...] | None) -> tuple[str, tuple[int, ...] | None]:
        """Connector and indices, counted from 1, of a variable or of one element of it, counted from 0."""
        if element is None:
            return name, None
        variable = self.unit.variables[name]
        if self.is_split(name):
            return f"{name}[{','.join(str(i + variable.first_index) for i in element)}]", None
        return name, tuple(i + 1 for i in element)

    def _port(self, name: str, written: str, variable: Variable) -> Port:
        kind = _KINDS[variable.causality]
        shape = () if self.is_split(name) else variable.shape
        if self.fmu is None:
            return Port(written, kind, variable.type.value, _own_unit(variable), shape)
        declared = self.fmu.variables[written]
        unit = declared.unit if declared.unit is not None and declared.unit.exponents else None
        items = dict(declared.items) if declared.items else None
        return Port(written, kind, declared.type, unit if declared.type in FLOAT_TYPES else None, shape, items)


def _own_unit(variable: Variable) -> Unit | None:
    if not variable.type.is_float:
        return None
    try:
        return known_unit(variable.unit)
    except UnitFault:
        return None
