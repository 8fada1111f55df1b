"""Record the outputs of all units as an xarray dataset with named dimensions, units and coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cosim.observers.channels import Channel, recorded_channels
from cosim.observers.storage import Storage
from cosim.system import System
from cosim.unit.protocol import AnyArray, Coordinate, Variable, VariableType, seconds
from cosim.unit.variable import MEAN

#: Times are converted to seconds in pieces of so many.
_TIMES_AT_ONCE = 1 << 16
#: Bytes as text: NetCDF has no bytes of variable length, and scenarios give them so too.
_HEXADECIMAL = np.frompyfunc(bytes.hex, 1, 1)


class Trace:
    """Values of every recorded output at every output time.

    Args:
        system: The system to watch.
        times: Integer output times [ns] of the whole run, the start included.
        folder: Where a long run may keep its values in a file; None: in memory.

    Raises:
        MemoryError: The values of the whole run do not fit into memory.
        OSError: They do not fit into the folder.
    """

    def __init__(self, system: System, times: Sequence[int], folder: Path | None = None) -> None:
        self.system = system
        self.times = times
        self.channels = recorded_channels(system)
        self.count = 0
        #: Name of a channel to its values, shape (output times, ...); the first `count` rows are recorded.
        shapes = [((len(times), *c.variable.shape), c.variable.type.dtype) for c in self.channels]
        self._storage = Storage([((len(times),), np.dtype(np.float64)), *shapes], folder)
        self._moments, *arrays = self._storage.arrays
        self._known_moments = 0
        self.rows: dict[str, AnyArray] = dict(zip((c.name for c in self.channels), arrays, strict=True))
        units = system.units
        bound = [(self.rows[c.name], units[c.unit].get, c.variable) for c in self.channels]
        self._numbers = [(rows, get, v.name) for rows, get, v in bound if rows.dtype != object]
        self._texts = [b for b in bound if b[0].dtype == object]

    @property
    def is_file(self) -> bool:
        """Whether the values lie in a file because they are many."""
        return self._storage.is_file

    def release(self) -> None:
        """Give back the memory of values that lie in a file."""
        self._storage.release()

    @property
    def moments(self) -> AnyArray:
        """Times recorded so far [s], shape (output times,)."""
        for begin in range(self._known_moments, self.count, _TIMES_AT_ONCE):
            end = min(begin + _TIMES_AT_ONCE, self.count)
            self._moments[begin:end] = [seconds(t) for t in self.times[begin:end]]
            self.release()
        self._known_moments = self.count
        return self._moments[: self.count]

    def record(self, time: int) -> None:
        """Keep the present outputs under the next output time, which must be `time`."""
        if self.times[self.count] != time:
            raise ValueError(f"output {self.count} belongs to {self.times[self.count]} ns, not {time} ns")
        for rows, get, name in self._numbers:
            rows[self.count] = get(name)
        for rows, get, variable in self._texts:
            keep(rows, self.count, variable, get(variable.name))
        self.count += 1

    def chunk(self, first: int) -> dict[str, np.ndarray[Any, Any]]:
        """Values recorded from output `first` on, by channel name; text as fixed-width text, which files can hold."""
        chosen = {name: values[first : self.count] for name, values in self.rows.items()}
        return {name: v.astype(np.str_) if v.dtype == object else v for name, v in chosen.items()}

    def load(self, chunk: Mapping[str, np.ndarray[Any, Any]]) -> None:
        """Append values of an earlier run of the same scenario."""
        length = 0
        for name, values in chunk.items():
            length = len(values)
            self.rows[name][self.count : self.count + length] = values
        self.count += length

    def dataset(self) -> xr.Dataset:
        """All values recorded so far; dimension `time` in seconds."""
        variables: dict[str, Any] = {}
        for channel in self.channels:
            values = self.rows[channel.name][: self.count]
            variables[channel.name] = (("time", *channel.dims), values, self.attributes(channel))
        return xr.Dataset(variables, dict(self.coordinates()))

    def attributes(self, channel: Channel) -> dict[str, str]:
        """What a file says of a channel, by the CF conventions: long_name, units, comment, cell_methods."""
        attributes = {"long_name": channel.variable.description or channel.name}
        if channel.variable.type.is_number:  # text, switches and enumerations have no unit
            attributes["units"] = channel.variable.unit
        if channel.variable.type is VariableType.BINARY:
            attributes["comment"] = "bytes in hexadecimal"
        if channel.variable.is_mean:
            attributes["cell_methods"] = MEAN
        return attributes

    def coordinates(self) -> dict[str, tuple[tuple[str, ...], AnyArray, dict[str, str]]]:
        """Time [s] and labels of the other dimensions: name to dimensions, values, attributes."""
        found: dict[str, tuple[tuple[str, ...], AnyArray, dict[str, str]]] = {}
        found["time"] = (("time",), self.moments, {"units": "s", "long_name": "simulated time"})
        for name, (dim, values, about) in _coordinates(self.system, self.channels).items():
            found[name] = ((dim,), values, about)
        return found

    def sizes(self) -> dict[str, int]:
        """Length of every dimension."""
        shapes = [s for c in self.channels for s in zip(c.dims, c.variable.shape, strict=True)]
        labels = {dims[0]: len(values) for dims, values, _ in self.coordinates().values()}
        return {"time": self.count} | labels | dict(shapes)


def keep(rows: AnyArray, row: int, variable: Variable, value: AnyArray) -> None:
    """Record one value of a variable, bytes as text.

    Args:
        rows: Values of all output times, shape (output times, ...).
        row: Number of the output time.
        variable: What is recorded.
        value: Its value.
    """
    # without the dots a text would be kept as an array of its own
    rows[row, ...] = _HEXADECIMAL(value) if variable.type is VariableType.BINARY else value


def _coordinates(system: System, channels: list[Channel]) -> dict[str, Any]:
    sizes = {d: s for c in channels for d, s in zip(c.dims, c.variable.shape, strict=True)}
    result: dict[str, Any] = {}
    for dim in ("coil", "string", "link", "row", "marker"):
        if dim in sizes:
            result[dim] = (dim, np.arange(1, sizes[dim] + 1), {"long_name": f"{dim} number, from 1"})
    for unit in system.units.values():
        for name, coordinate in unit.coordinates.items():
            if len(coordinate.values) == sizes.get(coordinate.dim):
                if name == coordinate.dim:  # labels of the dimension itself, in place of plain numbers
                    result[name] = _entry(coordinate)
                    continue
                label = name if name not in sizes and name not in result else f"{coordinate.dim}_{name}"
                result.setdefault(label, _entry(coordinate))
    return result


def _entry(coordinate: Coordinate) -> tuple[str, np.ndarray[Any, Any], dict[str, str]]:
    return coordinate.dim, coordinate.values, {"long_name": coordinate.description}
