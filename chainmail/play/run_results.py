"""The results of a run folder, or what to do where there are none."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from cosim.run_folder import RunFolder
from cosim.terminal import as_argument
from cosim.unit.errors import InputError


def is_run(folder: Path) -> bool:
    """Whether a run was begun in a folder."""
    run = RunFolder(folder)
    return run.results.is_file() or (run.scenario.is_file() and (folder / "checkpoints").is_dir())


def run_results(folder: Path) -> xr.Dataset:
    """Results of a run, loaded; a run that was interrupted has those up to there.

    Raises:
        InputError: There is no such folder, no run in it, no results yet, or they cannot be read.
    """
    run = RunFolder(folder)
    if not folder.is_dir():
        raise InputError(folder, "", "there is no such folder", "give a run folder (runs/NAME)")
    if not is_run(folder):
        raise InputError(folder, "", "there is no run in this folder", "give a run folder (runs/NAME)")
    if not run.results.is_file():
        raise InputError(
            folder,
            "results.nc",
            "this run has no results yet: it still goes on, or its program was killed",
            f"wait for its end, or go on with `cosim run {as_argument(folder)} --resume`",
        )
    try:
        with xr.open_dataset(run.results, engine="netcdf4") as dataset:
            return dataset.load()
    except (OSError, ValueError) as error:
        raise InputError(run.results, "", f"it cannot be read: {error}", "run the scenario again") from error
