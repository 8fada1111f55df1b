"""What an import needs to know of a component's variables: types, units, which scalars form an array."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cosim.fmu.archive import open_fmu
from cosim.ssp.model import BASE_UNITS, Unit
from cosim.ssp.units import UnitFault, known_unit

_ELEMENT = re.compile(r"^(?P<name>.+)\[(?P<index>\d+)\]$")


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
        dimensions: Size of each dimension, or the name of the structural parameter that gives it.
    """

    name: str
    causality: str
    type: str
    unit: Unit | None
    items: Mapping[str, int] | None
    is_settable: bool
    start: str
    dimensions: tuple[int | str, ...] = ()


@dataclass(frozen=True)
class Fmu:
    """An FMU.

    Args:
        variables: Name, and every alias, to variable.
        arrays: Name of an array gathered from FMI 2.0 scalars `x[1]`, `x[2]`, ... to their indices in order.
        interfaces: CoSimulation, ModelExchange.
        can_serialise: Whether its state can be written to a checkpoint.
        version: FMI version.
    """

    variables: Mapping[str, Variable]
    arrays: Mapping[str, tuple[int, ...]]
    interfaces: frozenset[str]
    can_serialise: bool
    version: str

    def shape(self, variable: Variable, structure: Mapping[str, int]) -> tuple[int, ...]:
        """Shape of a variable under a choice of structural parameters."""
        return tuple(
            d if isinstance(d, int) else int(structure.get(d, int(self.variables[d].start or 0)))
            for d in variable.dimensions
        )


def read_fmu(path: Path) -> Fmu:
    """Description of an FMU.

    Raises:
        InputError: It cannot be opened.
    """
    archive = open_fmu(path)
    archive.remove()
    description = archive.description
    units = {u.name: _defined(u) for u in description.unitDefinitions}
    variables: dict[str, Variable] = {}
    arrays: dict[str, list[int]] = {}
    by_reference = {v.valueReference: v.name for v in description.modelVariables}
    for v in description.modelVariables:
        sizes = tuple(by_reference[d.valueReference] if d.start is None else int(d.start) for d in v.dimensions)
        variable = _variable(v, units, sizes)
        for name in (v.name, *(a.name for a in v.aliases or ())):
            variables[name] = variable
        match = _ELEMENT.match(v.name)
        if match and not v.dimensions:
            arrays.setdefault(match["name"], []).append(int(match["index"]))
    interfaces = {"CoSimulation": description.coSimulation, "ModelExchange": description.modelExchange}
    present = {name: interface for name, interface in interfaces.items() if interface is not None}
    return Fmu(
        variables, {n: tuple(sorted(i)) for n, i in arrays.items()}, frozenset(present),
        all(i.canSerializeFMUstate for i in present.values()), description.fmiVersion,
    )  # fmt: skip


def array_element(name: str, arrays: Mapping[str, tuple[int, ...]]) -> tuple[str, int] | None:
    """(array, index) of a scalar that belongs to a gathered array; None for any other name."""
    match = _ELEMENT.match(name)
    return (match["name"], int(match["index"])) if match and match["name"] in arrays else None


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


def _variable(v: Any, units: Mapping[str, Unit], sizes: tuple[int | str, ...]) -> Variable:
    declared = v.declaredType
    name = v.unit or (declared.unit if declared is not None else None)
    items = {i.name: int(i.value) for i in declared.items} if declared is not None and declared.items else None
    initial = v.initial or ("exact" if v.start is not None else "calculated")
    is_settable = v.variability != "constant" and (v.causality == "input" or initial in ("exact", "approx"))
    unit = None if name is None else units.get(name) or _named(name)
    return Variable(v.name, v.causality or "local", v.type, unit, items, is_settable, str(v.start or ""), sizes)
