"""Which figures a run gets."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from cosim.errors import InputError
from cosim.figures import currents, curvature, lengths, side_view, stiffness_loops, temperatures
from cosim.paper.measures import band, switches
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


def draw_run(folder: Path) -> list[Path]:
    """Draw every figure that the results of one run allow."""
    return draw_runs([folder])


def draw_runs(folders: Sequence[Path]) -> list[Path]:
    """Draw the figures of the first run; Figure 3 holds the curvature of all of them.

    Of an ensemble Figure 3 and the lengths show median and band over its starts; the other figures show the start whose
    curvature is nearest to the median; the side view names it.

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
        first = one_start(first)
        if "fabric.max_curvature" in first:
            drawn.append(side_view.draw(target / "side_view.png", first, marks))
        if "actuator.temperature" in first:
            drawn.append(temperatures.draw(target / "temperatures.png", first, marks))
            drawn.append(stiffness_loops.draw(target / "stiffness_loops.png", first))
        if "circuit.current" in first:
            drawn.append(currents.draw(target / "currents.png", first, marks))
    return drawn


def one_start(run: xr.Dataset) -> xr.Dataset:
    """Of an ensemble the start whose curvature is nearest to the median, over all times; any other run as it is."""
    if "start" not in run.dims:
        return run
    curvature_of = run["fabric.max_curvature"]
    distance = ((curvature_of - band(curvature_of)[1]) ** 2).mean("time")
    return run.isel(start=int(distance.argmin("start")))
