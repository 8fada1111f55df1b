"""Values that left the range for which their unit is made, as its description declares it.

An FMU states by `min` and `max` of a variable the region in which it is designed to operate (FMI 2.0.4, section 2.2.7;
FMI 3.0.2, section 2.4.7). It need not refuse what lies outside, and a run goes on there without a word.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cosim.connection import Connection
from cosim.observers.trace import Trace
from cosim.system import System
from cosim.unit.protocol import AnyArray, Variable
from cosim.unit.ranges import beyond, has_range, in_words, with_unit


def outside_ranges(trace: Trace) -> list[str]:
    """One sentence for each variable that was outside its declared range: how far, where and since when.

    Outputs and inputs are looked at as they were recorded, at output times; of parameters and start values what the
    scenario gives.
    """
    system = trace.system
    given = [text for unit in system.units.values() for text in unit.outside_range]
    return [*given, *_outputs(trace), *_inputs(trace, system)]


def _outputs(trace: Trace) -> Iterator[str]:
    for channel in trace.channels:
        if has_range(channel.variable):
            yield from _departure(trace, channel.name, channel.variable, trace.rows[channel.name][: trace.count])


def _inputs(trace: Trace, system: System) -> Iterator[str]:
    for transfers in system.transfers.values():
        for transfer in transfers:
            if not has_range(transfer.variable):
                continue
            for part in transfer.parts:
                values = _handed_over(trace, part.connection)
                if values is not None:
                    name = f"{'.'.join(transfer.end)}, given by {'.'.join(part.connection.source)}"
                    yield from _departure(trace, name, transfer.variable, values)


def _handed_over(trace: Trace, connection: Connection) -> AnyArray | None:
    """What a connection led into its input at output times; None where its source is not recorded."""
    values = trace.rows.get(".".join(connection.source))
    if values is None or values.dtype.kind not in "fiu":
        return None
    values = values[: trace.count]
    if connection.source_element is not None:
        values = np.moveaxis(values, 0, -1)[connection.source_element]
    return np.asarray(connection.factor * values + connection.offset)


def _departure(trace: Trace, name: str, variable: Variable, values: AnyArray) -> Iterator[str]:
    """None, or one sentence for the value that is farthest outside."""
    if not values.size:
        return
    rows = values.reshape(len(values), -1)
    outside = beyond(variable, rows)
    if not outside.any():
        return
    row, element = np.unravel_index(int(np.argmax(outside)), outside.shape)
    first = int(np.argmax(outside.any(axis=1)))
    at = "" if values.ndim == 1 else _index(int(element), variable)
    yield (
        f"{name}{at} was outside the range for which its unit is made ({in_words(variable)}): "
        f"{with_unit(float(rows[row, element]), variable)} at {trace.moments[row]:.6g} s, "
        f"outside from {trace.moments[first]:.6g} s on"
    )


def _index(element: int, variable: Variable) -> str:
    """Which element of an array, as a user writes it."""
    index = np.unravel_index(element, variable.shape)
    return f"[{','.join(str(int(i) + variable.first_index) for i in index)}]"
