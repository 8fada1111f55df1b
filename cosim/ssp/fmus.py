"""What import and export need to know of an FMU's variables: types, units, which scalars form an array."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cosim.fmu.description import read_packed_description
from cosim.fmu.gathering import fmu_variables
from cosim.fmu.units import UnitNames
from cosim.fmu.values import array_of
from cosim.ssp.model import BASE_UNITS, Unit
from cosim.ssp.units import UnitFault, known_unit
from cosim.unit.variable import AnyArray


@dataclass(frozen=True)
class Variable:
    """One variable as the FMU's description has it.

    Args:
        name: Name.
        causality: As in FMI.
        type: Type name of its FMI version.
        unit: Unit with the FMU's own definition.
        items: Item name to value of an enumeration.
        is_settable: Whether a value can be set before initialisation (SSP, section ParameterBindings).
        start: Start value as text.
    """

    name: str
    causality: str
    type: str
    unit: Unit | None
    items: Mapping[str, int] | None
    is_settable: bool
    start: str


class Fmu:
    """An FMU, by its description.

    Args:
        path: Its file.

    Raises:
        InputError: It cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        #: A model description alone: an SSP can be read where its FMUs have no binary for this platform.
        self._description = read_packed_description(path)
        self._units = UnitNames(self._description)
        units = {u.name: _defined(u) for u in self._description.unitDefinitions}
        #: Name, and every alias, to variable.
        self.variables: dict[str, Variable] = {}
        for v in self._description.modelVariables:
            variable = _variable(v, units)
            for name in (v.name, *(a.name for a in v.aliases or ())):
                self.variables[name] = variable
        gathered = fmu_variables(self._description, {}, self._units).items()
        #: Name of an array gathered from scalars `x[1]`, `x[2]`, ... to their names, in row-major order.
        self.arrays = {n: tuple(d.name for d in v.declared) for n, v in gathered if n not in self.variables}
        #: Name of such a scalar to its array and to its index as written.
        self.elements: dict[str, tuple[str, tuple[int, ...]]] = {}
        for name, v in gathered:
            indices = (tuple(i + v.variable.first_index for i in index) for index in np.ndindex(v.variable.shape))
            if name in self.arrays:
                self.elements |= {d.name: (name, index) for d, index in zip(v.declared, indices, strict=True)}

    @property
    def is_fmi2(self) -> bool:
        """Whether it is of FMI 2.0."""
        return str(self._description.fmiVersion).startswith("2")

    @property
    def interfaces(self) -> Mapping[str, Any]:
        """CoSimulation, ModelExchange: what it has of them, as described."""
        present = {"CoSimulation": self._description.coSimulation, "ModelExchange": self._description.modelExchange}
        return {name: interface for name, interface in present.items() if interface is not None}

    @property
    def can_serialise(self) -> bool:
        """Whether its state can be written to a checkpoint."""
        return all(i.canSerializeFMUstate for i in self.interfaces.values())

    def array(self, name: str, value: Any, structure: Mapping[str, int]) -> AnyArray:
        """A scenario's value for a variable or gathered array: in the FMU's type, shape and unit.

        Raises:
            ValueError: It does not fit, or there is no such variable.
        """
        table = fmu_variables(self._description, {} if self.is_fmi2 else structure, self._units)
        if name not in table:
            raise ValueError(f"the FMU has no variable `{name}`")
        return array_of(table[name], value, self._units)


def _defined(unit: Any) -> Unit:
    base = unit.baseUnit
    if base is None:
        return _named(unit.name)
    return Unit(unit.name, tuple(int(getattr(base, n)) for n in BASE_UNITS), float(base.factor), float(base.offset))


def _named(name: str) -> Unit:
    """A unit that the FMU does not define: what its name means, or nothing that could be converted."""
    try:
        return known_unit(name)
    except UnitFault:
        return Unit(name, ())


def _variable(v: Any, units: Mapping[str, Unit]) -> Variable:
    declared = v.declaredType
    name = v.unit or (declared.unit if declared is not None else None)
    items = {i.name: int(i.value) for i in declared.items} if declared is not None and declared.items else None
    is_settable = v.variability != "constant" and (v.causality == "input" or v.initial in ("exact", "approx"))
    unit = None if name is None else units.get(name) or _named(name)
    return Variable(v.name, v.causality or "local", v.type, unit, items, is_settable, str(v.start or ""))
