"""Where recorded rows lie: in memory, or beyond some size in a file of the run folder that nobody else sees.

The file has no name, so that nothing is left of it however the process ends. Its whole size is reserved at the start: a
disk that is too full is told then, not by a signal in the middle of the run. `release` gives the memory of pages back
that were written; their content stays in the file.
"""

from __future__ import annotations

import math
import mmap
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import AnyArray

#: Rows that take less than this stay in memory [byte].
LARGEST_IN_MEMORY = 64 << 20


class Storage:
    """Arrays of given shapes and types.

    Args:
        wanted: Shape and element type of every array.
        folder: Where a file may be made; None: everything stays in memory.

    Raises:
        MemoryError: They do not fit into memory.
        OSError: The file cannot be made, for example because the disk is full.
    """

    def __init__(self, wanted: Sequence[tuple[tuple[int, ...], np.dtype[Any]]], folder: Path | None = None) -> None:
        sizes = [-(-math.prod(shape) * dtype.itemsize // mmap.PAGESIZE) * mmap.PAGESIZE for shape, dtype in wanted]
        plain = [size if dtype.kind != "O" else 0 for size, (_, dtype) in zip(sizes, wanted)]
        self._pages: mmap.mmap | None = None
        if folder is None or sum(plain) < LARGEST_IN_MEMORY:
            self.arrays: list[AnyArray] = [np.empty(shape, dtype) for shape, dtype in wanted]
            return
        with tempfile.TemporaryFile(dir=folder) as file:
            os.posix_fallocate(file.fileno(), 0, sum(plain))
            self._pages = mmap.mmap(file.fileno(), sum(plain))
        self.arrays, begin = [], 0
        for (shape, dtype), size in zip(wanted, plain):
            if dtype.kind == "O":
                self.arrays.append(np.empty(shape, dtype))
                continue
            flat = np.frombuffer(self._pages, dtype, math.prod(shape), begin) if size else np.empty(0, dtype)
            self.arrays.append(flat.reshape(shape))
            begin += size

    @property
    def is_file(self) -> bool:
        """Whether the arrays lie in a file."""
        return self._pages is not None

    def release(self) -> None:
        """Let the system take back the memory of the file's pages."""
        if self._pages is not None and hasattr(mmap, "MADV_DONTNEED"):
            self._pages.madvise(mmap.MADV_DONTNEED)
