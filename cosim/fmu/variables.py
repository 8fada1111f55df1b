"""The variables of an FMU as named arrays.

FMI 3.0 has arrays; FMI 2.0 has scalars named `power[1]`, `power[2]`, ... which are gathered here into one array, so
that an FMI 2.0 twin has the same variables as its FMI 3.0 original.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from fmpy.model_description import ModelDescription, ModelVariable

from cosim.unit import Causality, Variable

_ELEMENT = re.compile(r"^(?P<name>.+)\[(?P<index>\d+)\]$")
_REAL_TYPES = {"Real", "Float64"}
_CAUSALITIES = {
    "input": Causality.INPUT,
    "output": Causality.OUTPUT,
    "parameter": Causality.PARAMETER,
    "structuralParameter": Causality.PARAMETER,
}


@dataclass(frozen=True)
class FmuVariable:
    """One variable, or one array gathered from the scalars of FMI 2.0.

    Args:
        variable: Name, shape, unit and causality as every unit declares them.
        value_references: One for an FMI 3.0 array; one per element, in order, for gathered scalars.
        kind: FMI type name (`Float64`, `Real`, `Boolean`, ...).
        is_structural: Whether it sets the size of others (FMI 3.0 structural parameter).
    """

    variable: Variable
    value_references: tuple[int, ...]
    kind: str
    is_structural: bool = False

    @property
    def is_real(self) -> bool:
        """Whether it is a double."""
        return self.kind in _REAL_TYPES


def fmu_variables(description: ModelDescription, structure: Mapping[str, int]) -> dict[str, FmuVariable]:
    """Inputs, outputs and parameters of an FMU, by name.

    Args:
        description: The model description.
        structure: Values of structural parameters that differ from their start value. FMI 2.0 has none: there its
            value of `coils` is compared with the size that the FMU was built for.

    Returns:
        Name to variable, with the shapes that `structure` gives.

    Raises:
        ValueError: `structure` names no structural parameter or another size than an FMI 2.0 FMU has, or gathered
            scalars leave a gap in their indices.
    """
    structural = {v.name: v for v in description.modelVariables if v.causality == "structuralParameter"}
    is_fmi2 = description.fmiVersion.startswith("2")
    unknown = set(structure) - ({"coils"} if is_fmi2 else set(structural))
    if unknown:
        raise ValueError(f"no structural parameter {', '.join(sorted(unknown))}; there are: {', '.join(structural)}")
    sizes = {v.valueReference: int(structure.get(name, v.start or 0)) for name, v in structural.items()}
    names = {v.valueReference: name for name, v in structural.items()}
    result: dict[str, FmuVariable] = {}
    elements: dict[str, dict[int, ModelVariable]] = {}
    for model_variable in description.modelVariables:
        if model_variable.causality not in _CAUSALITIES:
            continue
        match = _ELEMENT.match(model_variable.name)
        if match and not model_variable.dimensions:
            elements.setdefault(match["name"], {})[int(match["index"])] = model_variable
            continue
        result[model_variable.name] = _declared(model_variable, sizes, names)
    for name, members in elements.items():
        result[name] = _gathered(name, members)
        wanted = structure.get("coils", len(members)) if is_fmi2 else len(members)
        if wanted != len(members):
            raise ValueError(f"this FMI 2.0 FMU is built for {len(members)} coils ({name}), not for {wanted}")
    return result


def _declared(v: ModelVariable, sizes: Mapping[int, int], names: Mapping[int, str]) -> FmuVariable:
    shape: list[int] = []
    dims: list[str] = []
    for position, dimension in enumerate(v.dimensions):
        if dimension.start is not None:
            shape.append(int(dimension.start))
            dims.append(f"{v.name}_{position}")
        else:
            shape.append(sizes[dimension.valueReference])
            dims.append(names[dimension.valueReference].removesuffix("s"))
    return FmuVariable(
        _variable(v.name, v, tuple(shape), tuple(dims)),
        (v.valueReference,),
        v.type,
        v.causality == "structuralParameter",
    )


def _gathered(name: str, members: Mapping[int, ModelVariable]) -> FmuVariable:
    indices = sorted(members)
    if indices != list(range(indices[0], indices[0] + len(indices))) or indices[0] not in (0, 1):
        raise ValueError(f"the elements of {name} are numbered {indices[:5]}...: a gap, or not from 0 or 1")
    first = members[indices[0]]
    references = tuple(members[i].valueReference for i in indices)
    return FmuVariable(_variable(name, first, (len(indices),), ("coil",)), references, first.type)


def _variable(name: str, v: ModelVariable, shape: tuple[int, ...], dims: tuple[str, ...]) -> Variable:
    declared = v.declaredType
    unit = v.unit or (declared.unit if declared is not None else None) or "1"
    causality = _CAUSALITIES[v.causality]
    start = _start(v) if causality is Causality.INPUT and v.type in _REAL_TYPES else None
    return Variable(name, causality, shape, unit, dims, v.description or "", start)


def _start(v: ModelVariable) -> float | None:
    try:
        values = {float(text) for text in (v.start or "").split()}
    except ValueError:
        return None
    return values.pop() if len(values) == 1 and not any(map(math.isnan, values)) else None
