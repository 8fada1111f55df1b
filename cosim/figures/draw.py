"""Which figures a run gets."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.errors import InputError
from cosim.figures import closed_loop, currents, curvature, lengths, side_view, stiffness_loops, temperatures
from cosim.run_folder import RunFolder, writing


def open_run(folder: Path) -> xr.Dataset:
    """Results of a run folder, loaded.

    Raises:
        InputError: There are none, or they cannot be read.
    """
    path = RunFolder(folder).results
    if not path.is_file():
        raise InputError(folder, "results.nc", "there are no results here", "give a run folder (runs/NAME)")
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            return dataset.load()
    except (OSError, ValueError) as error:
        raise InputError(path, "", f"it cannot be read: {error}", "run the scenario again") from error


def switches(run: xr.Dataset) -> list[float]:
    """Times [s] at which a supply voltage changes."""
    if "supply.voltage" not in run:
        return []
    values = run["supply.voltage"].values.reshape(run.sizes["time"], -1)
    changed = np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))
    return [float(run["time"].values[i]) for i in changed]


def draw_run(folder: Path) -> list[Path]:
    """Draw every figure that the results of one run allow."""
    return draw_runs([folder])


def draw_runs(folders: Sequence[Path]) -> list[Path]:
    """Draw the figures of the first run; Figure 3 holds the curvature of all of them.

    Returns:
        The files written, in the first run's folder `figures/`.
    """
    runs = [open_run(f) for f in folders]
    first, target = runs[0], folders[0] / "figures"
    marks = switches(first)
    drawn: list[Path] = []
    with writing(target):
        target.mkdir(parents=True, exist_ok=True)
        if "fabric.max_curvature" in first:
            with_curvature = [r for r in runs if "fabric.max_curvature" in r]
            drawn.append(curvature.draw(target / "figure3_curvature.png", with_curvature, marks))
            drawn.append(lengths.draw(target / "lengths.png", first, marks))
            drawn.append(side_view.draw(target / "side_view.png", first, marks))
        if "actuator.temperature" in first:
            drawn.append(temperatures.draw(target / "temperatures.png", first, marks))
            drawn.append(stiffness_loops.draw(target / "stiffness_loops.png", first))
        if "circuit.current" in first:
            drawn.append(currents.draw(target / "currents.png", first, marks))
        for name in closed_loop.controllers(first):
            drawn.append(closed_loop.draw(target / f"closed_loop_{name}.png", first, name))
    return drawn
