"""Two runs in one folder, and an FMU that changes the working folder: nothing is lost."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest
import xarray as xr

from cosim.alone import LOCK, alone
from cosim.run import run
from cosim.run_folder import RunFolder
from cosim.unit.errors import InputError


def test_a_second_run_into_a_folder_is_refused_and_the_first_keeps_its_results(tmp_path, fmu, scenario, start):
    loaded = scenario({"faulty": fmu("nap", "step")}, stop=20.0)
    out = tmp_path / "run"
    first = start("run", loaded.path, "--out", out)
    while not (out / LOCK).exists() and first.poll() is None:
        time.sleep(0.01)
    for resume in (False, True):
        with pytest.raises(InputError, match="another run is at work in this folder"):
            run(loaded, out, resume)
    _, errors = first.communicate()
    assert first.returncode == 0, errors
    assert RunFolder(out).is_complete()
    assert not (out / LOCK).exists()
    with pytest.raises(InputError, match="already holds a run"):
        run(loaded, out)


def test_two_resumed_runs_do_not_meet(tmp_path, fmu, scenario):
    loaded = scenario({"faulty": fmu()})
    with alone(tmp_path / "run", "run"), pytest.raises(InputError, match="another run is at work"):
        run(loaded, tmp_path / "run", resume=True)
    assert not (tmp_path / "run").exists()  # nothing was written


def test_a_run_that_cannot_begin_leaves_no_folder(tmp_path, fmu, scenario):
    with pytest.raises(InputError):
        run(scenario({"faulty": fmu("give_up", "initialise")}), tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_an_fmu_that_changes_the_working_folder_takes_no_results_with_it(tmp_path, fmu, scenario, monkeypatch):
    monkeypatch.chdir(tmp_path)
    loaded = scenario({"faulty": fmu("wander", "step")}, isolation="none")
    run(loaded, Path("run"))
    assert Path(os.getcwd()) == tmp_path
    assert xr.load_dataset(tmp_path / "run" / "results.nc").sizes["time"] == 11
