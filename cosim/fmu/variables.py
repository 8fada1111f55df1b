"""The variables of an FMU as named arrays.

FMI 3.0 has arrays. FMI 2.0 has scalars named `power[1]`, `power[2]`, ... or `a[1,2]`, which `cosim.fmu.gathering`
puts into one array, so that an FMI 2.0 twin has the same variables as its FMI 3.0 original.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from fmpy.model_description import ModelDescription, ModelVariable

from cosim.fmu.sizes import StructureFault, check_shape
from cosim.fmu.types import TYPES
from cosim.fmu.units import UnitNames
from cosim.unit.protocol import AnyArray, Causality, Variable, VariableType

_CAUSALITIES = {
    "input": Causality.INPUT,
    "output": Causality.OUTPUT,
    "parameter": Causality.PARAMETER,
    "structuralParameter": Causality.PARAMETER,
}


@dataclass(frozen=True)
class FmuVariable:
    """One variable, or one array gathered from scalars.

    Args:
        variable: Name, type, shape, unit and causality as every unit declares them.
        value_references: One for an FMI 3.0 array; one per element, in order, for gathered scalars; none of an input
            that the FMU does not have.
        declared: Its entries in the model description, in the same order.
    """

    variable: Variable
    value_references: tuple[int, ...]
    declared: tuple[ModelVariable, ...]

    @property
    def is_added(self) -> bool:
        """Whether it is an input for added terms alone, of which the FMU knows nothing."""
        return not self.value_references

    @property
    def is_structural(self) -> bool:
        """Whether it sets the size of others (FMI 3.0 structural parameter)."""
        return bool(self.declared[0].causality == "structuralParameter")

    @property
    def is_size(self) -> bool:
        """Whether it is a structural parameter that can be the size of arrays."""
        return self.is_structural and self.variable.type.dtype.kind in "iu"

    @property
    def is_discrete(self) -> bool:
        """Whether it changes at events only."""
        return bool(self.declared[0].variability == "discrete")

    @property
    def is_constant(self) -> bool:
        """Whether nothing may set it."""
        return bool(self.declared[0].variability == "constant")

    @property
    def has_start(self) -> bool:
        """Whether its start value may be set (initial exact or approx)."""
        return not self.is_constant and self.declared[0].initial in ("exact", "approx")

    @property
    def items(self) -> Mapping[str, int]:
        """Names of an enumeration's items."""
        kind = self.declared[0].declaredType
        return {} if kind is None else {i.name: int(i.value) for i in kind.items if i.value is not None}


@dataclass(frozen=True)
class Sizes:
    """Values and names of the structural parameters and constants that dimensions refer to, by value reference."""

    values: Mapping[int, int]
    names: Mapping[int, str]


def sizes(description: ModelDescription, structure: Mapping[str, int]) -> Sizes:
    """What the dimensions of arrays refer to.

    Raises:
        StructureFault: `structure` names no structural parameter, or a value outside its declared range.
    """
    structural = {v.name: v for v in description.modelVariables if v.causality == "structuralParameter"}
    unknown = set(structure) - set(structural)
    if unknown:
        there = ", ".join(structural) or "none"
        raise StructureFault(f"no structural parameter {', '.join(sorted(unknown))}; there are: {there}")
    for name, value in structure.items():
        low, high = structural[name].min, structural[name].max
        if (low is not None and value < int(low)) or (high is not None and value > int(high)):
            raise StructureFault(f"{name} = {value} is outside {low or 0} to {high or 'any'}")
    values = {
        v.valueReference: int(structure.get(v.name, (v.start or "0").split()[0]))
        for v in description.modelVariables
        if v.type.startswith(("UInt", "Int")) and (v.name in structural or v.variability == "constant")
    }
    return Sizes(values, {v.valueReference: v.name for v in description.modelVariables if v.valueReference in values})


def added_input(name: str, unit: str) -> FmuVariable:
    """An input that the FMU does not have: one floating-point number, 0 until the first exchange."""
    declared = ModelVariable(name, causality="input", variability="continuous")
    return FmuVariable(Variable(name, Causality.INPUT, (), unit, start=0.0), (), (declared,))


def declared_array(v: ModelVariable, given: Sizes, units: UnitNames) -> FmuVariable:
    """A variable as it is declared, with the shape that the structural parameters give.

    Raises:
        StructureFault: A dimension refers to something that is neither a structural parameter nor a constant, or there
            are too many elements.
    """
    shape: list[int] = []
    sizes: list[str] = []
    dims: list[str] = []
    for position, dimension in enumerate(v.dimensions):
        reference = dimension.valueReference
        if dimension.start is not None:
            shape.append(int(dimension.start))
            dims.append(f"{v.name}_{position}")
        elif reference in given.values:
            shape.append(given.values[reference])
            dims.append(given.names[reference].removesuffix("s"))
            sizes.append(given.names[reference])
        else:
            raise StructureFault(
                f"dimension {position + 1} of {v.name} is given by value reference {reference}, which is neither a "
                "structural parameter nor a constant"
            )
    check_shape(v.name, shape, sizes)
    dims = [d if dims.count(d) == 1 else f"{d}_{i + 1}" for i, d in enumerate(dims)]  # a square matrix
    variable = variable_of(v.name, [v], tuple(shape), tuple(dims), units)
    return FmuVariable(variable, (v.valueReference,), (v,))


def variable_of(
    name: str,
    declared: Sequence[ModelVariable],
    shape: tuple[int, ...],
    dims: tuple[str, ...],
    units: UnitNames,
    first_index: int = 1,
) -> Variable:
    """What every unit says of a variable."""
    v = declared[0]
    vtype = TYPES[v.type]
    causality = _CAUSALITIES.get(v.causality, Causality.LOCAL)
    if v.alias is not None and causality is not Causality.PARAMETER:
        causality = Causality.LOCAL  # the variable itself is there under its own name
    start = start_value(declared, vtype, shape) if causality is Causality.INPUT else None
    return Variable(
        name,
        causality,
        shape,
        units.of(v) if vtype.is_float else "1",
        dims,
        v.description or "",
        start,
        type=vtype,
        first_index=first_index,
        least=_bound(declared, vtype, "min", min),
        most=_bound(declared, vtype, "max", max),
    )


def _bound(
    declared: Sequence[ModelVariable], vtype: VariableType, name: str, widest: Callable[[Iterable[float]], float]
) -> float | None:
    """What a variable, or else its declared type, says of its range; of gathered scalars the widest. None: any value.

    Source: FMI 2.0.4, section 2.2.7, and FMI 3.0.2, section 2.4.7: the region in which the FMU is designed to operate.
    """
    if not vtype.is_number:
        return None
    found = []
    for v in declared:
        text = getattr(v, name)
        if text is None and v.declaredType is not None:
            text = getattr(v.declaredType, name)
        try:
            found.append(float(text))
        except (TypeError, ValueError):
            return None
    return widest(found)


def start_value(declared: Sequence[ModelVariable], vtype: VariableType, shape: tuple[int, ...]) -> Any:
    """Declared start value: a scalar where all elements have the same, an array, or None where there is none."""
    if vtype is VariableType.CLOCK:
        return False
    if len(declared) > 1:
        texts = [v.start for v in declared]
        if any(t is None for t in texts):
            return None
    elif declared[0].start is None:
        return None
    elif vtype in (VariableType.STRING, VariableType.BINARY):
        start = declared[0].start
        texts = [start] if isinstance(start, str) else list(start)
    else:
        texts = declared[0].start.split()
    try:
        values = [parse(t, vtype) for t in texts]
    except ValueError:
        return None
    if values and all(v == values[0] for v in values):
        return values[0]
    array: AnyArray = np.empty(len(values), dtype=vtype.dtype)
    array[:] = values
    return array.reshape(shape) if array.size == np.prod(shape, dtype=int) else None


def parse(text: str, vtype: VariableType) -> Any:
    """A start value as written in modelDescription.xml.

    Raises:
        ValueError: It is no value of this type.
    """
    if vtype is VariableType.STRING:
        return text
    if vtype is VariableType.BINARY:
        return bytes.fromhex(text)
    if vtype is VariableType.BOOLEAN:
        if text not in ("true", "false", "1", "0"):
            raise ValueError(f"{text} is no Boolean")
        return text in ("true", "1")
    return float(text) if vtype.is_float else int(text)
