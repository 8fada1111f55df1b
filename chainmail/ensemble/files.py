"""Results of an ensemble as files; those of one run are written from its trace (`cosim.results_file`)."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cosim.results_file import netcdf_name


def write_netcdf(path: Path, dataset: xr.Dataset) -> None:
    """Write a dataset; a variable whose name NetCDF does not allow has its own as attribute `name`.

    Args:
        path: File to write.
        dataset: With names of any kind.

    Raises:
        OSError, RuntimeError: The file cannot be written.
    """
    names = {n: netcdf_name(str(n)) for n in (*dataset.variables, *dataset.dims)}
    changed = {old: new for old, new in names.items() if old != new}
    stored = dataset.rename(changed)
    for old, new in changed.items():
        if new in stored.variables:
            stored[new].attrs = {**stored[new].attrs, "name": str(old)}
    numbers = [name for name, values in stored.data_vars.items() if values.dtype.kind in "biuf"]
    stored.to_netcdf(path, engine="netcdf4", encoding={n: {"zlib": True, "complevel": 1} for n in numbers})


def write_series(path: Path, dataset: xr.Dataset) -> None:
    """Main series: scalars and string quantities against time, and mean, lowest and highest value over the coils.

    Args:
        path: File to write.
        dataset: Variables with dimension `time` first.

    Raises:
        OSError: The file cannot be written.
    """
    columns: dict[str, np.ndarray[Any, Any]] = {"time [s]": dataset["time"].values}
    for name, values in dataset.data_vars.items():
        if values.dtype.kind not in "biuf":  # text is in the NetCDF file
            continue
        unit = f" [{values.attrs['units']}]" if "units" in values.attrs else ""
        if values.ndim == 1:
            columns[f"{name}{unit}"] = values.values
        elif values.dims[1:] == ("string",):
            for i in range(values.sizes["string"]):
                columns[f"{name}[{i + 1}]{unit}"] = values.values[:, i]
        elif values.ndim == 2 and values.shape[1]:
            for kind in ("mean", "min", "max"):
                columns[f"{kind} {name}{unit}"] = getattr(np, kind)(values.values, axis=1)
    rows = zip(*columns.values(), strict=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([f"{value:.9g}" for value in row] for row in rows)
