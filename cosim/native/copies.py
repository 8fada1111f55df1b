"""Connections as operations: what is copied where, scaled or converted."""

from __future__ import annotations

import numpy as np

from cosim.connection import Connection
from cosim.native.layout import ELEMENT_TYPES, Code, Operation
from cosim.unit.protocol import AnyArray


def copy_operation(connection: Connection, source: AnyArray, target: AnyArray, unit: int) -> Operation | None:
    """Copy a source's array, or one element, to the target's array, or one element of it.

    Args:
        connection: Elements, factor and offset.
        source: Live array of the output.
        target: Live array of the input.
        unit: Whose wall time it counts for.

    Returns:
        None where only numpy can do it: a scaled value that becomes an integer.
    """
    begin, count = _part(target, connection.target_element)
    first, available = _part(source, connection.source_element)
    common = {
        "unit": unit,
        "source": source.ctypes.data + first * source.itemsize,
        "target": target.ctypes.data + begin * target.itemsize,
    }
    if source.dtype == target.dtype and not connection.is_scaled and available == count:
        if count == 1 and source.dtype == np.float64:
            return Operation(code=Code.COPY_DOUBLE, count=1, **common)
        return Operation(code=Code.COPY_BYTES, count=count * source.itemsize, **common)
    if connection.is_scaled and target.dtype.kind != "f":
        return None
    return Operation(
        code=Code.CONVERT,
        source_type=ELEMENT_TYPES[source.dtype.name],
        target_type=ELEMENT_TYPES[target.dtype.name],
        count=count,
        source_step=0 if available == 1 else 1,
        factor=connection.factor,
        offset=connection.offset,
        **common,
    )


def _part(array: AnyArray, element: tuple[int, ...] | None) -> tuple[int, int]:
    """First element and number of elements."""
    if element is None:
        return 0, array.size
    return (int(np.ravel_multi_index(element, array.shape)) if element else 0), 1
