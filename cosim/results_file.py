"""Recorded values as a NetCDF 4 file, written piece by piece so that memory does not grow with the run.

It is what `xarray.Dataset.to_netcdf` would write of the trace's dataset, and xarray reads it back as that.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

from cosim.observers.trace import Trace
from cosim.unit.protocol import AnyArray

#: Values are compressed in pieces of about this size [byte].
_PIECE = 1 << 19
#: Level of zlib: on trajectories level 4 takes twice as long for a file that is a few per cent smaller.
_LEVEL = 1
_NOT_NETCDF = re.compile(r"[\x00-\x1f\x7f/]| $")


def netcdf_name(name: str) -> str:
    """A name that NetCDF allows.

    Not allowed are control characters, `/` and a blank at the end (NetCDF Users Guide, names); they are written as in
    addresses, with `%` and two hexadecimal digits, and so is `%` itself in such a name.

    >>> netcdf_name("a/b"), netcdf_name("100 %")
    ('a%2Fb', '100 %')
    """
    if not _NOT_NETCDF.search(name):
        return name
    return _NOT_NETCDF.sub(lambda found: f"%{ord(found[0]):02X}", name.replace("%", "%25"))


def write_results(path: Path, trace: Trace, attributes: Mapping[str, Any]) -> None:
    """Write everything recorded so far.

    Args:
        path: File to write.
        trace: Recorded values.
        attributes: Of the whole file: title, status, timings.

    Raises:
        OSError, RuntimeError: The file cannot be written.
    """
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.setncatts(dict(attributes))
        coordinates = trace.coordinates()
        for name, size in trace.sizes().items():
            file.createDimension(netcdf_name(name), size)
        labels = {n: dims for n, (dims, *_) in coordinates.items() if dims != (n,)}
        for name, (dims, values, about) in coordinates.items():
            _write(file, name, dims, values, about, trace)
        for channel in trace.channels:
            dims = ("time", *channel.dims)
            along = [netcdf_name(n) for n, own in labels.items() if set(own) <= set(dims)]
            about = trace.attributes(channel) | ({"coordinates": " ".join(along)} if along else {})
            _write(file, channel.name, dims, trace.rows[channel.name][: trace.count], about, trace)


def _write(
    file: netCDF4.Dataset, name: str, dims: tuple[str, ...], values: AnyArray, about: Mapping[str, Any], trace: Trace
) -> None:
    stored = netcdf_name(name)
    attributes = dict(about) | ({"name": name} if stored != name else {})
    kind: Any = values.dtype
    options: dict[str, Any] = {}
    if values.dtype.kind in "OU":
        kind = str
    else:
        options = {"zlib": True, "complevel": _LEVEL, "shuffle": True} if values.size else {}
        if values.dtype == np.bool_:
            kind, attributes = np.int8, attributes | {"dtype": "bool"}  # as xarray marks them
        if values.size:
            row = max(1, math.prod(values.shape[1:]) * np.dtype(kind).itemsize)
            options["chunksizes"] = (min(len(values), max(1, _PIECE // row)), *values.shape[1:])
    variable = file.createVariable(stored, kind, tuple(netcdf_name(d) for d in dims), fill_value=False, **options)
    if values.size:  # whole pieces are written once: HDF5 need not hold 16 MB of each variable
        variable.set_var_chunk_cache(size=2 * _PIECE)
    variable.set_auto_maskandscale(False)
    variable.setncatts(attributes)
    for begin, end in _pieces(values):
        piece = values[begin:end]
        variable[begin:end] = piece.astype(object) if kind is str else piece.astype(kind, copy=False)
        trace.release()


def _pieces(values: AnyArray) -> Iterator[tuple[int, int]]:
    """Ranges of rows of several compressed pieces each."""
    if not values.size:
        return
    rows = max(1, 16 * _PIECE // max(1, math.prod(values.shape[1:]) * values.dtype.itemsize))
    for begin in range(0, len(values), rows):
        yield begin, min(begin + rows, len(values))
