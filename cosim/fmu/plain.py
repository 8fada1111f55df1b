"""Values of any FMI type as arrays that a file can hold."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import AnyArray, VariableType


def plain(values: AnyArray) -> AnyArray:
    """A copy that a file of arrays can hold: text as fixed-width text, binary data as hexadecimal text."""
    if values.dtype != object:
        return values.copy()
    texts = [v.hex() if isinstance(v, bytes) else v for v in values.flat]
    return np.array(texts, dtype=np.str_).reshape(values.shape)


def unplain(values: AnyArray, vtype: VariableType) -> AnyArray:
    """Values of a type from what `plain` gave."""
    if vtype is not VariableType.BINARY:
        return values
    result: AnyArray = np.empty(values.shape, dtype=object)
    for i, text in enumerate(values.flat):
        result.flat[i] = bytes.fromhex(str(text))
    return result
