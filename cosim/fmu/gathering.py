"""Scalars named `x[1]`, `x[2]`, ... or `a[1,2]`, gathered to arrays."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from fmpy.model_description import ModelDescription, ModelVariable

from cosim.fmu.sizes import MOST_DIMENSIONS, StructureFault
from cosim.fmu.units import UnitNames
from cosim.fmu.variables import FmuVariable, declared_array, sizes, variable_of
from cosim.unit.protocol import Causality

_ELEMENT = re.compile(r"^(?P<name>.+)\[(?P<index>\d{1,9}(\s*,\s*\d{1,9})*)\]$", re.ASCII)

Index = tuple[int, ...]


def fmu_variables(
    description: ModelDescription, structure: Mapping[str, int], units: UnitNames
) -> dict[str, FmuVariable]:
    """All variables of an FMU by name, with the shapes that `structure` gives.

    Scalars whose indices leave a gap, or that differ in type, unit or causality, stay separate scalars.

    Args:
        description: The model description.
        structure: Values of structural parameters that differ from their start value. FMI 2.0 has none: there its
            value of `coils` is compared with the size that the FMU was built for.
        units: Units that the FMU declares.

    Raises:
        StructureFault: `structure` does not fit the FMU.
    """
    is_fmi2 = description.fmiVersion.startswith("2")
    coils = structure.get("coils") if is_fmi2 else None
    given = sizes(description, {k: v for k, v in structure.items() if not is_fmi2 or k != "coils"})
    result: dict[str, FmuVariable] = {}
    elements: dict[str, dict[Index, ModelVariable]] = {}
    for v in description.modelVariables:
        match = _ELEMENT.match(v.name)
        if match and not v.dimensions:
            index = tuple(int(i) for i in match["index"].split(","))
            elements.setdefault(match["name"], {})[index] = v
        else:
            result[v.name] = declared_array(v, given, units)
    for name, members in elements.items():
        first = _first_index(members)
        if name in result or first is None or not _are_alike(members, units):
            result.update({v.name: declared_array(v, given, units) for v in members.values()})
        else:
            result[name] = _gathered(name, members, first, units)
    if coils is not None:
        _check_size(result, coils)
    return result


def _first_index(members: Mapping[Index, ModelVariable]) -> int | None:
    """Number of the first element (0 or 1) of a complete box of indices; None where it is none."""
    ranks = {len(index) for index in members}
    if len(ranks) != 1:
        return None
    first = min(i for index in members for i in index)
    last = [max(column) for column in zip(*members)]
    # Indices lie in the box and differ, so as many as it has elements fill it; it is never written out, because the
    # largest index alone decides how large it is.
    is_full = math.prod(end - first + 1 for end in last) == len(members)
    return first if first in (0, 1) and is_full and len(last) <= MOST_DIMENSIONS else None


def _are_alike(members: Mapping[Index, ModelVariable], units: UnitNames) -> bool:
    return (
        len({(v.type, v.causality, v.variability, v.initial, units.of(v), v.declaredType) for v in members.values()})
        == 1
    )


def _gathered(name: str, members: Mapping[Index, ModelVariable], first: int, units: UnitNames) -> FmuVariable:
    indices = sorted(members)
    declared = tuple(members[i] for i in indices)
    shape = tuple(end - first + 1 for end in indices[-1])
    dims = ("coil",) if len(shape) == 1 else tuple(f"{name}_{i}" for i in range(len(shape)))
    variable = variable_of(name, declared, shape, dims, units, first)
    return FmuVariable(variable, tuple(v.valueReference for v in declared), declared)


def _check_size(variables: Mapping[str, FmuVariable], coils: int) -> None:
    arrays = [v.variable for v in variables.values() if v.variable.causality is not Causality.LOCAL]
    for v in arrays:
        if len(v.shape) == 1 and v.shape != (coils,):
            raise StructureFault(f"this FMI 2.0 FMU is built for {v.size} coils ({v.name}), not for {coils}")
    if not any(v.shape for v in arrays):
        raise StructureFault("FMI 2.0 has no structural parameters, and this FMU has no arrays")
