"""A run's trace as CSV files: all values, or the main series."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from cosim.native.csv_file import CsvColumn, CsvWriter
from cosim.observers.channels import Channel
from cosim.observers.trace import Trace
from cosim.unit.protocol import AnyArray, VariableType

#: Rows that are written before memory is given back.
_ROWS = 1 << 16


def write_trace(path: Path, trace: Trace) -> None:
    """Write what was recorded so far: `time [s]`, then `component.variable [unit]`, arrays element by element.

    Args:
        path: File to write.
        trace: Recorded values; text is quoted, Booleans are 0 and 1.

    Raises:
        OSError: The file cannot be written.
    """
    rows = trace.chunk(0)
    columns = [CsvColumn(c.name, c.variable.unit, rows[c.name], c.variable.first_index) for c in trace.channels]
    _write(path, trace, columns)


def write_series(path: Path, trace: Trace) -> None:
    """Write the main series: scalars and string quantities against time; of other vectors mean, min, max.

    Args:
        path: File to write.
        trace: Recorded values; text is left out, it is in the NetCDF file.

    Raises:
        OSError: The file cannot be written.
    """
    columns = [column for channel in trace.channels for column in _series(channel, trace)]
    _write(path, trace, columns)


def _series(channel: Channel, trace: Trace) -> Iterator[CsvColumn]:
    values: AnyArray = trace.rows[channel.name][: trace.count]
    if values.dtype == object:
        return
    # switches and enumerations have no unit
    unit = channel.variable.unit if channel.variable.type.is_number else None
    if values.ndim == 1:
        yield CsvColumn(channel.name, unit, values)
    elif channel.dims == ("string",):
        for i in range(values.shape[1]):
            yield CsvColumn(f"{channel.name}[{i + 1}]", unit, np.ascontiguousarray(values[:, i]))
    elif values.ndim == 2 and values.shape[1] and channel.variable.type is not VariableType.CLOCK:
        yield CsvColumn(f"mean {channel.name}", unit, values.mean(axis=1))
        yield CsvColumn(f"min {channel.name}", unit, values.min(axis=1))
        yield CsvColumn(f"max {channel.name}", unit, values.max(axis=1))


def _write(path: Path, trace: Trace, columns: list[CsvColumn]) -> None:
    with path.open("wb") as file:
        writer = CsvWriter(file, trace.moments, columns)
        for stop in range(_ROWS, trace.count + _ROWS, _ROWS):
            writer.write(min(stop, trace.count))
            trace.release()
