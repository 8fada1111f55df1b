"""Results of several starts as one dataset, and what their spread is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from chainmail.measures import band, switches

#: A value at a moment is the mean over so long before it [s]: a fabric at its stops rattles.
WINDOW = 0.5
#: Scalar outputs of a fabric that the summary tells.
TOLD = ("max_curvature", "fabric_length", "max_penetration")


def combined(runs: Mapping[int, xr.Dataset]) -> xr.Dataset:
    """All starts as one dataset.

    Args:
        runs: Start, counted from 1, to its results; all with the same times.

    Returns:
        Variables in which starts differ have the dimension `start` after `time`; the others (supply, room) are as in
        any of them.
    """
    numbers, datasets = list(runs), list(runs.values())
    first = datasets[0]
    found = {}
    for name, values in first.data_vars.items():
        others = [d[name] for d in datasets]
        if all(np.array_equal(values.values, o.values) for o in others):
            found[name] = values
            continue
        stacked = np.stack([o.values for o in others], axis=1)
        found[name] = xr.DataArray(stacked, dims=(values.dims[0], "start", *values.dims[1:]), attrs=values.attrs)
    start = ("start", np.array(numbers), {"long_name": "start, counted from 1; 1 is the scenario as it is"})
    attributes = {k: v for k, v in first.attrs.items() if not k.startswith(("wall_time", "energy_"))}
    return xr.Dataset(found, coords={**first.coords, "start": start}, attrs=attributes)


def moments(run: xr.Dataset) -> list[tuple[str, float]]:
    """Names and times [s] at which a fabric is looked at: before each switch of the supply, and at the end."""
    begin, end = float(run["time"][0]), float(run["time"][-1])
    found = [(f"before the switch at {t:g} s", t) for t in switches(run) if t - WINDOW > begin]
    return [*found, ("at the end", end)]


def spread(run: xr.Dataset) -> list[dict[str, Any]]:
    """Median, 5 and 95 per cent and the value of every start, of scalar outputs of fabrics at each moment.

    Args:
        run: With a dimension `start`.
    """
    found: list[dict[str, Any]] = []
    for name, values in run.data_vars.items():
        if str(name).rpartition(".")[2] not in TOLD or values.dims != ("time", "start"):
            continue
        for what, moment in moments(run):
            own = values.sel(time=slice(moment - WINDOW, moment)).mean("time")
            low, middle, high = (float(q) for q in band(own))
            found.append(
                {
                    "variable": str(name),
                    "unit": str(values.attrs.get("units", "")),
                    "moment": what,
                    "median": middle,
                    "5 %": low,
                    "95 %": high,
                    "starts": {str(s): float(v) for s, v in zip(run["start"].values, own.values)},
                }
            )
    return found


def bands(run: xr.Dataset) -> xr.Dataset:
    """Median, 5 and 95 per cent over the starts of every scalar series; other variables without starts as they are."""
    found: dict[str, xr.DataArray] = {}
    for name, values in run.data_vars.items():
        if "start" not in values.dims:
            found[str(name)] = values
        elif values.dims == ("time", "start"):
            for label, own in zip(("5 % of", "median of", "95 % of"), band(values)):
                found[f"{label} {name}"] = own.assign_attrs(values.attrs)
    return xr.Dataset(found, coords={"time": run["time"]})
