"""A run's trace as a CSV file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cosim.native.csv_file import CsvColumn, write_csv
from cosim.observers.trace import Trace
from cosim.unit import seconds


def write_trace(path: Path, trace: Trace) -> None:
    """Write what was recorded so far: `time [s]`, then `component.variable [unit]`, arrays element by element.

    Args:
        path: File to write.
        trace: Recorded values; text is quoted, Booleans are 0 and 1.

    Raises:
        OSError: The file cannot be written.
    """
    rows = trace.chunk(0)
    times = np.array([seconds(t) for t in trace.times[: trace.count]])
    columns = [CsvColumn(c.name, c.variable.unit, rows[c.name], c.variable.first_index) for c in trace.channels]
    write_csv(path, times, columns)
