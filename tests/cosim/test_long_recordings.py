"""Recordings that are too long for memory: the same values and files, from a file of the run folder."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from cosim.observers import storage
from cosim.observers.storage import Storage
from cosim.run import record, run
from cosim.unit.errors import InputError
from tests.cosim.short_runs import heating


@pytest.fixture
def few_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(storage, "LARGEST_IN_MEMORY", 1)


def test_values_in_a_file_are_those_in_memory(few_in_memory: None, tmp_path: Path) -> None:
    recorded = record(heating(), tmp_path / "run", csv=True)
    assert recorded.trace.is_file
    whole = run(heating())
    stored = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert set(stored.variables) == set(whole.variables)
    for name in whole.variables:
        np.testing.assert_array_equal(stored[name].values, whole[name].values)
        assert stored[name].attrs == whole[name].attrs
        assert stored[name].dims == whole[name].dims
    assert set(stored.coords) == set(whole.coords)
    assert not [p for p in (tmp_path / "run").iterdir() if p.name.startswith("tmp")]


def test_a_stopped_run_goes_on_from_a_file_to_the_same_values(few_in_memory: None, tmp_path: Path) -> None:
    scenario = heating()

    def interrupt(progress: Any) -> None:
        if progress.time > 1.5:
            raise KeyboardInterrupt

    with pytest.raises(BaseException, match="interrupted"):
        record(scenario, tmp_path / "run", on_progress=interrupt)
    record(scenario, tmp_path / "run", resume=True)
    xr.testing.assert_equal(xr.load_dataset(tmp_path / "run" / "results.nc"), run(scenario))


def test_a_file_of_netcdf_is_what_xarray_writes(tmp_path: Path) -> None:
    whole = run(heating(), tmp_path / "run")
    whole.to_netcdf(tmp_path / "xarray.nc", engine="netcdf4")
    xr.testing.assert_identical(
        xr.load_dataset(tmp_path / "run" / "results.nc"), xr.load_dataset(tmp_path / "xarray.nc")
    )


def test_released_pages_keep_their_values(few_in_memory: None, tmp_path: Path) -> None:
    kept = Storage(
        [((100_000,), np.dtype(np.float64)), ((7, 0), np.dtype(np.int32)), ((2,), np.dtype(object))], tmp_path
    )
    assert kept.is_file
    kept.arrays[0][:] = np.arange(100_000.0)
    kept.arrays[2][:] = ["a", "b"]
    kept.release()
    np.testing.assert_array_equal(kept.arrays[0], np.arange(100_000.0))
    assert kept.arrays[1].shape == (7, 0)
    assert kept.arrays[2].tolist() == ["a", "b"]


def test_a_disk_that_is_too_full_is_told_before_the_run(
    few_in_memory: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(InputError, match=r"outputs do not fit into .*run") as caught:
        record(heating(), tmp_path / "run")
    assert "make room" in caught.value.remedy
    assert not (tmp_path / "run").exists()
