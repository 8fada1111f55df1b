"""Recorded values as comma-separated text that reads back to the same doubles.

Numbers are written as Python's `repr` writes them: the shortest text that reads back unchanged. The compiled library
does that about ten times faster; without it the same bytes are written in Python.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from cosim.native.compiled import LibraryAbsent, library
from cosim.native.layout import ELEMENT_TYPES
from cosim.native.powers import powers_of_ten
from cosim.unit.protocol import AnyArray, Array

#: Text is handed to the file in pieces of this size [byte].
PIECE = 1 << 20
#: Bytes of the longest number and its separator, see decimal.h.
_LONGEST = 26


@dataclass(frozen=True)
class CsvColumn:
    """One recorded variable.

    Args:
        name: `component.variable`.
        unit: Unit of its values; None: none is written.
        values: Shape (rows, ...); may be longer than what is written.
        first_index: Number of the first element in the header.
    """

    name: str
    unit: str | None
    values: AnyArray
    first_index: int = 1

    @property
    def headings(self) -> list[str]:
        """Heading of every element, last index fastest: `fabric.position[1,3] [m]`."""
        shape = self.values.shape[1:]
        indices = [",".join(str(i + self.first_index) for i in index) for index in np.ndindex(shape)]
        unit = "" if self.unit is None else f" [{self.unit}]"
        return [f"{self.name}{f'[{index}]' if shape else ''}{unit}" for index in indices]


class CsvWriter:
    """Writes rows of recorded variables to a file, header first.

    Args:
        file: Opened for writing bytes.
        times: Times [s], shape (rows,).
        columns: Recorded variables, all with at least as many rows.

    Raises:
        OSError: The file cannot be written.
    """

    def __init__(self, file: BinaryIO, times: Array, columns: Sequence[CsvColumn]) -> None:
        self._file = file
        self._columns = [CsvColumn("time", "s", times), *columns]
        headings = [_quoted(h) for c in self._columns for h in c.headings]
        file.write((",".join(headings) + "\n").encode())
        self._native = _native_columns(self._columns)
        self.written = 0

    def write(self, stop: int) -> None:
        """Write all rows up to `stop` that are not yet written; raises OSError."""
        if self.written >= stop:
            return
        if self._native is not None:
            self._native.write(self._file, self.written, stop)
        else:
            self._write_in_python(stop)
        self.written = stop

    def _write_in_python(self, stop: int) -> None:
        flat = [c.values[self.written : stop].reshape(stop - self.written, -1).tolist() for c in self._columns]
        for row in zip(*flat):
            self._file.write((",".join(_text(v) for values in row for v in values) + "\n").encode())


def write_csv(path: Path, times: Array, columns: Sequence[CsvColumn]) -> None:
    """Write a whole table.

    Args:
        path: File to write.
        times: Times [s], shape (rows,).
        columns: Recorded variables; their first `len(times)` rows are written.

    Raises:
        OSError: The file cannot be written.
    """
    with path.open("wb") as file:
        CsvWriter(file, times, columns).write(len(times))


def _text(value: object) -> str:
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, bytes):
        return value.hex()
    return _quoted(value) if isinstance(value, str) else repr(value)


def _quoted(text: str) -> str:
    """Text as RFC 4180 wants it."""
    if any(c in text for c in ',"\r\n'):
        return '"' + text.replace('"', '""') + '"'
    return text


class _ColumnLayout(ctypes.Structure):
    _fields_ = (("values", ctypes.c_void_p), ("elements", ctypes.c_size_t), ("type", ctypes.c_int64))


class _NativeColumns:
    """The columns as the library sees them."""

    def __init__(self, format_rows: Callable[..., int], columns: Sequence[CsvColumn]) -> None:
        self._format = format_rows
        self._columns = columns  # kept: their addresses are used
        sizes = [int(np.prod(c.values.shape[1:])) for c in columns]
        layouts = [
            _ColumnLayout(c.values.ctypes.data, n, ELEMENT_TYPES[c.values.dtype.name]) for c, n in zip(columns, sizes)
        ]
        self._layouts = (_ColumnLayout * len(layouts))(*layouts)
        self._powers = powers_of_ten()
        self._text = ctypes.create_string_buffer(max(PIECE, _LONGEST * sum(sizes)))

    def write(self, file: BinaryIO, first: int, stop: int) -> None:
        row = ctypes.c_size_t(first)
        view = memoryview(self._text)
        while row.value < stop:
            count = self._format(
                self._layouts,
                ctypes.c_size_t(len(self._layouts)),
                ctypes.c_void_p(self._powers.ctypes.data),
                ctypes.byref(row),
                ctypes.c_size_t(stop),
                self._text,
                ctypes.c_size_t(len(self._text)),
            )
            file.write(view[:count])


def _native_columns(columns: Sequence[CsvColumn]) -> _NativeColumns | None:
    """None where Python has to write them: no library, text, or values that do not lie row after row."""
    try:
        format_rows = library().cosim_format_rows
    except LibraryAbsent:
        return None
    if any(c.values.dtype.name not in ELEMENT_TYPES or not c.values.flags["C_CONTIGUOUS"] for c in columns):
        return None
    return _NativeColumns(format_rows, columns)
