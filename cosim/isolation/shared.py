"""Memory that the simulation and the process of an isolated unit have in common.

The memory has no name, so nothing has to be removed when either of them ends.
"""

from __future__ import annotations

import mmap
import os
import tempfile
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import AnyArray, Causality, Variable

#: Bytes of the header; a mapping must begin at a multiple of the granularity.
HEADER_SIZE = mmap.ALLOCATIONGRANULARITY
_NAME_SIZE = 64
_MEMORY = slice(_NAME_SIZE, _NAME_SIZE + 8)
_ALIGNMENT = 64


def create_memory() -> int:
    """Descriptor of nameless memory that holds the header."""
    if hasattr(os, "memfd_create"):
        descriptor = os.memfd_create("cosim-unit")
    else:  # macOS: a file whose name is gone at once
        with tempfile.TemporaryFile() as file:
            descriptor = os.dup(file.fileno())
    os.ftruncate(descriptor, HEADER_SIZE)
    return descriptor


class Header:
    """What the unit's process notes about itself, readable after it has died.

    Args:
        descriptor: From `create_memory`.
    """

    def __init__(self, descriptor: int) -> None:
        self.map = mmap.mmap(descriptor, HEADER_SIZE)

    @property
    def function(self) -> str:
        """FMI function that is being called; empty: none."""
        return self.map[:_NAME_SIZE].rstrip(b"\0").decode("ascii", "replace")

    @property
    def memory(self) -> int:
        """Memory of the process when it was last looked at [byte]."""
        return int.from_bytes(self.map[_MEMORY], "little")

    @memory.setter
    def memory(self, size: int) -> None:
        self.map[_MEMORY] = size.to_bytes(8, "little")

    def close(self) -> None:
        """Unmap it."""
        self.map.close()


def function_label(name: str) -> bytes:
    """What to write to the begin of the header while the function is called."""
    return name.encode("ascii")[:_NAME_SIZE].ljust(_NAME_SIZE, b"\0")


NO_FUNCTION = function_label("")


class SharedArrays:
    """The variables of a unit, seen by both processes; text and binary data, which have no fixed size, by one only.

    Args:
        descriptor: From `create_memory`.
        variables: Variables of the unit; the same on both sides.
        is_owner: Whether this side gives the memory its size.
    """

    def __init__(self, descriptor: int, variables: Mapping[str, Variable], is_owner: bool) -> None:
        self.inputs = [n for n, v in variables.items() if v.causality is Causality.INPUT]
        self.texts = frozenset(n for n, v in variables.items() if v.type.dtype.kind == "O")
        offsets, size = _layout(variables, len(self.inputs))
        if is_owner:
            os.ftruncate(descriptor, HEADER_SIZE + size)
        memory = mmap.mmap(descriptor, size, offset=HEADER_SIZE)
        #: Whether each input was set since the unit has last seen it, shape (inputs,).
        self.changed: npt.NDArray[np.uint8] = np.ndarray(len(self.inputs), np.uint8, memory)
        self.arrays: dict[str, AnyArray] = {}
        for name, variable in variables.items():
            dtype: np.dtype[Any] = variable.type.dtype
            if name in self.texts:
                self.arrays[name] = np.full(variable.shape, None, dtype)
            else:
                self.arrays[name] = np.ndarray(variable.shape, dtype, memory, offsets[name])


def _layout(variables: Mapping[str, Variable], inputs: int) -> tuple[dict[str, int], int]:
    """Offset of every array, and the size of all [byte]; arrays begin on cache lines of their own."""
    offsets, size = {}, _aligned(max(inputs, 1))
    for name, variable in variables.items():
        offsets[name] = size
        size += _aligned(variable.size * variable.type.dtype.itemsize)
    return offsets, size


def _aligned(size: int) -> int:
    return -(-size // _ALIGNMENT) * _ALIGNMENT
