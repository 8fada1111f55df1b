"""FMI's types: which functions move them and how C stores them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.unit.protocol import VariableType


@dataclass(frozen=True)
class CType:
    """How C sees one type.

    Args:
        suffix: End of the set and get functions' names, for example `Float64` of `fmi3SetFloat64`.
        dtype: Element type of their buffers; addresses for text and binary data.
    """

    suffix: str
    dtype: np.dtype[Any]


_ADDRESS = np.dtype(np.uintp)

#: FMI type name in modelDescription.xml to type; FMI 2.0 has the first two, and Boolean, String and Enumeration.
TYPES: dict[str, VariableType] = {
    "Real": VariableType.FLOAT64,
    "Integer": VariableType.INT32,
    **{t.value: t for t in VariableType},
}

#: FMI 2.0, section 2.1.2: fmi2Boolean is an int, and an Enumeration is set as Integer.
FMI2: dict[VariableType, CType] = {
    VariableType.FLOAT64: CType("Real", np.dtype(np.float64)),
    VariableType.INT32: CType("Integer", np.dtype(np.intc)),
    VariableType.BOOLEAN: CType("Boolean", np.dtype(np.intc)),
    VariableType.ENUMERATION: CType("Integer", np.dtype(np.intc)),
    VariableType.STRING: CType("String", _ADDRESS),
}

#: FMI 3.0, section 2.2.2: fmi3Boolean and fmi3Clock are C's bool, and an Enumeration is set as Int64.
FMI3: dict[VariableType, CType] = {
    **{t: CType(t.value, t.dtype) for t in VariableType if t.dtype.kind in "fiub"},
    VariableType.ENUMERATION: CType("Int64", np.dtype(np.int64)),
    VariableType.STRING: CType("String", _ADDRESS),
    VariableType.BINARY: CType("Binary", _ADDRESS),
}
