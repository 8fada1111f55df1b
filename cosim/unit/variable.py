"""The variables of a unit: named arrays of one type, with shape and unit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
#: Values of a variable of any type.
AnyArray: TypeAlias = npt.NDArray[Any]


class Causality(Enum):
    """Role of a variable, with the names of FMI."""

    INPUT = "input"
    OUTPUT = "output"
    PARAMETER = "parameter"
    LOCAL = "local"


#: What a file says of the mean over the step that ends at its time, by the CF conventions (`cell_methods`).
MEAN = "time: mean"


class VariableType(Enum):
    """Type of a variable, with the names of FMI 3.0. FMI 2.0: Real is Float64, Integer is Int32."""

    FLOAT64 = "Float64"
    FLOAT32 = "Float32"
    INT8 = "Int8"
    UINT8 = "UInt8"
    INT16 = "Int16"
    UINT16 = "UInt16"
    INT32 = "Int32"
    UINT32 = "UInt32"
    INT64 = "Int64"
    UINT64 = "UInt64"
    BOOLEAN = "Boolean"
    STRING = "String"
    BINARY = "Binary"
    ENUMERATION = "Enumeration"
    CLOCK = "Clock"

    @property
    def dtype(self) -> np.dtype[Any]:
        """Element type of its arrays; text and binary are arrays of Python objects (str, bytes)."""
        return _DTYPES[self]

    @property
    def is_float(self) -> bool:
        """Whether it is a floating-point number: only these have units, and are checked to be finite."""
        return self in (VariableType.FLOAT64, VariableType.FLOAT32)

    @property
    def is_number(self) -> bool:
        """Whether it is a number that may be scaled; an enumeration, a Boolean and a clock are none."""
        return self.dtype.kind in "fiu" and self is not VariableType.ENUMERATION

    def accepts(self, source: VariableType) -> bool:
        """Whether a value of type `source` can be connected to an input of this type without loss.

        The same type, a number type whose every value this one holds (Int32 to Float64, not Float64 to Int32), or a
        Boolean to any number, as 0 or 1.
        """
        if source is self:
            return True
        if source is VariableType.BOOLEAN:
            return self.is_number
        return self.is_number and source.is_number and bool(np.can_cast(source.dtype, self.dtype, "safe"))


_DTYPES: dict[VariableType, np.dtype[Any]] = {
    **{t: np.dtype(t.value.lower()) for t in VariableType if t.value.lower().startswith(("float", "int", "uint"))},
    VariableType.BOOLEAN: np.dtype(np.bool_),
    VariableType.STRING: np.dtype(object),
    VariableType.BINARY: np.dtype(object),
    VariableType.ENUMERATION: np.dtype(np.int64),
    VariableType.CLOCK: np.dtype(np.bool_),
}


@dataclass(frozen=True)
class Variable:
    """One named array of a unit.

    Args:
        name: Name within the unit, for example `power`.
        causality: Whether the algorithm writes it (input) or reads it (output, local).
        shape: Shape of the array; `()` is a scalar.
        unit: Unit as text that pint parses (`W`, `K`, `N/m`, `1/m`, `1`); SI for our own units, whatever it declares
            for an FMU.
        dims: Name of each dimension, for example `("coil",)`; same length as `shape`.
        description: One sentence for results and error texts.
        start: Value of an input that nothing is connected to; a scalar fills the shape. None: must be connected.
        recorded: Whether a trace keeps it.
        type: Type of the elements.
        first_index: Number of the first element in the names that a user writes: 1, or 0 for an array gathered from
            FMI 2.0 scalars `x[0]`, `x[1]`, ...
        is_mean: Whether it is the mean over the step that ends at its time.
        least: Smallest value for which the unit is made, in `unit`; None: any.
        most: Largest value for which it is made; None: any.
    """

    name: str
    causality: Causality
    shape: tuple[int, ...]
    unit: str
    dims: tuple[str, ...] = ()
    description: str = ""
    start: Any = None
    recorded: bool = True
    type: VariableType = VariableType.FLOAT64
    first_index: int = 1
    is_mean: bool = False
    least: float | None = None
    most: float | None = None

    def __post_init__(self) -> None:
        if len(self.dims) != len(self.shape):
            raise ValueError(f"{self.name}: {len(self.dims)} dimension names for shape {self.shape}")

    @property
    def size(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)


@dataclass(frozen=True)
class Coordinate:
    """A labelled axis of results, for example the row of every link.

    Args:
        dim: Dimension that it runs along.
        values: Shape (size of dim,); numbers or text.
        description: One sentence for the result file.
    """

    dim: str
    values: npt.NDArray[np.generic]
    description: str = ""
