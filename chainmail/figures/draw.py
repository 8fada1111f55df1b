"""Which figures a run gets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path

import xarray as xr

from chainmail.figures import (
    closed_loop,
    currents,
    curvature,
    lengths,
    quantities,
    side_view,
    stiffness_loops,
    temperatures,
)
from chainmail.figures.setpoints import loop_of
from chainmail.figures.usual_names import with_usual_names
from chainmail.measures import one_start, switches
from cosim.alone import alone
from cosim.run_folder import RunFolder, writing
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError


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


def draw_run(folder: Path, formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw every figure that the results of one run allow."""
    return draw_runs([folder], formats)


def draw_runs(folders: Sequence[Path], formats: Sequence[str] = ("png",)) -> list[Path]:
    """Draw the figures of the first run; that of the curvature holds all of them.

    Of an ensemble the curvature and the lengths show median and band over its starts; the other figures show the start
    whose curvature is nearest to the median; the side view names it.

    Args:
        folders: Run folders.
        formats: Of `FORMATS`; each figure is written once in each.

    Returns:
        The files written, in the first run's folder `figures/`.

    Raises:
        InputError: A folder holds no results, or the figures cannot be written.
    """
    runs = [with_usual_names(open_run(f)) for f in folders]
    scenario = _scenario_of(folders[0]) if closed_loop.controllers(runs[0]) else None
    target = folders[0] / "figures"
    drawn: list[Path] = []
    with alone(folders[0], "drawing"), writing(target):
        target.mkdir(parents=True, exist_ok=True)
        for name, draw in _figures(runs, switches(runs[0]), scenario).items():
            drawn += [draw(target / f"{name}.{ending}") for ending in formats]
    return drawn


def _scenario_of(folder: Path) -> Scenario | None:
    """The scenario of a run; None where the folder has none that this version reads."""
    path = RunFolder(folder).scenario
    with suppress(InputError):
        return load_scenario(path) if path.is_file() else None
    return None


def _figures(
    runs: Sequence[xr.Dataset], marks: list[float], scenario: Scenario | None
) -> dict[str, Callable[[Path], Path]]:
    """Name to what draws it, for what the first run has recorded."""
    first, single = runs[0], one_start(runs[0])
    found: dict[str, Callable[[Path], Path]] = {}
    if "fabric.max_curvature" in first:
        with_curvature = [r for r in runs if "fabric.max_curvature" in r]
        found["curvature"] = partial(curvature.draw, runs=with_curvature, marks=marks)
        found["lengths"] = partial(lengths.draw, run=first, marks=marks)
        found["side_view"] = partial(side_view.draw, run=single, marks=marks)
    if "actuator.temperature" in first:
        found["temperatures"] = partial(temperatures.draw, run=single, marks=marks)
        found["stiffness_loops"] = partial(stiffness_loops.draw, run=single)
    if "circuit.current" in first:
        found["currents"] = partial(currents.draw, run=single, marks=marks)
    for name in closed_loop.controllers(single):
        loop = loop_of(scenario, single, name) if scenario is not None else None
        found[f"closed_loop_{name}"] = partial(closed_loop.draw, run=single, controller=name, loop=loop)
    if not found and quantities.by_unit(single):
        found["quantities"] = partial(quantities.draw, run=single, marks=marks)
    return found
