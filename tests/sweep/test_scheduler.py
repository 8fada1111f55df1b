"""A sweep on a real scheduler with workers in processes of their own: one is killed, nothing is lost."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time as clock
from pathlib import Path

import pytest
import xarray as xr

from cosim.compute.cache import Cache
from cosim.compute.cluster import DaskPlace, Here
from cosim.sweep.command import sweep
from tests.sweep.files import ROOT, written

SLOW = """
title: t
scenario: coil.yaml
axes:
  volume: {key: actuator.parameters.volume, range: {from: 7 mm^3, to: 8 mm^3, count: 12}}
outputs:
  hottest: {quantity: actuator.temperature, over: max}
  energy: {quantity: energy}
series:
  temperature: {quantity: actuator.temperature}
"""
#: Long enough that a worker dies in the middle of a run: about a second each.
STOP = "300 s"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "COSIM_FMU_PATH": str(ROOT / "build" / "fmus")}


def _begin(folder: Path, *arguments: str) -> subprocess.Popen[bytes]:
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "log.txt").open("wb") as log:
        return subprocess.Popen(
            [sys.executable, "-m", *arguments],
            env=ENVIRONMENT,
            cwd=folder,
            stdout=log,
            stderr=log,
            start_new_session=True,
        )


def _wait(condition, what: str) -> None:
    end = clock.monotonic() + 120
    while not condition():
        assert clock.monotonic() < end, what
        clock.sleep(0.02)


def _end(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


@pytest.mark.slow
def test_a_killed_worker_costs_the_run_under_way_and_nothing_else(tmp_path):
    """Scheduler and workers know nothing of the folder of the scenario: its files travel."""
    path = written(tmp_path / "here", SLOW, STOP)
    shutil.copy(ROOT / "build" / "fmus" / "thermal_stiffness_fmi3.fmu", tmp_path / "here" / "own.fmu")
    scenario = tmp_path / "here" / "coil.yaml"
    scenario.write_text(scenario.read_text().replace("fmu: thermal_stiffness", "fmu: own.fmu"))
    sweep(path, tmp_path / "alone", Here(), False)
    told = tmp_path / "scheduler.json"
    begun = [
        _begin(
            tmp_path / "s",
            "distributed.cli.dask_scheduler",
            "--host",
            "127.0.0.1",
            "--port",
            "0",
            "--no-dashboard",
            "--scheduler-file",
            str(told),
        )
    ]
    try:
        _wait(told.is_file, "no scheduler")
        address = json.loads(told.read_text())["address"]
        for number in range(2):
            begun.append(
                _begin(
                    tmp_path / f"w{number}",
                    "distributed.cli.dask_worker",
                    address,
                    "--nthreads",
                    "1",
                    "--no-nanny",
                    "--no-dashboard",
                )
            )
        from distributed import Client

        with Client(address) as client:
            client.wait_for_workers(2, timeout=60)
        command = _begin(
            tmp_path / "command", "cosim.cli", "sweep", str(path), "--cluster", address, "--out", str(tmp_path / "out")
        )
        begun.append(command)
        kept = Cache(tmp_path / "out" / "runs")
        _wait(lambda: kept.count() >= 3, "no run was made")
        # Moved away before the kill: what is made from here on is made from what has travelled.
        (tmp_path / "here").rename(tmp_path / "gone")
        os.kill(begun[1].pid, signal.SIGKILL)
        at_the_kill = kept.count()
        _wait(lambda: command.poll() is not None, "the sweep did not end")
        assert command.returncode == 0, (tmp_path / "command" / "log.txt").read_text()
        assert at_the_kill < 12, "the worker was killed too late to show anything"
        assert json.loads((tmp_path / "out" / "summary.json").read_text())["failed"] == 0
        for name in ("sweep.nc", "table.csv"):
            assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "alone" / name).read_bytes()
    finally:
        for process in reversed(begun):
            _end(process)


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_a_sweep_that_was_ended_goes_on_to_the_same_result(tmp_path, how):
    path = written(tmp_path / "here", SLOW, STOP)
    sweep(path, tmp_path / "alone", Here(), False)
    command = ("cosim.cli", "sweep", str(path), "--jobs", "2", "--out", str(tmp_path / "out"))
    kept = Cache(tmp_path / "out" / "runs")
    first = _begin(tmp_path / "first", *command)
    try:
        _wait(lambda: kept.count() >= 3, "no run was made")
        if how is signal.SIGINT:
            os.killpg(first.pid, how)
        else:
            os.kill(first.pid, how)
        _wait(lambda: first.poll() is not None, "it did not end")
    finally:
        _end(first)
    if how is signal.SIGINT:
        assert first.returncode == 130
        assert "--resume" in (tmp_path / "first" / "log.txt").read_text()
    before = {p: os.stat(p).st_mtime_ns for p in kept.folder.rglob("*.npz")}
    assert 3 <= len(before) < 12
    second = _begin(tmp_path / "second", *command, "--resume")
    try:
        _wait(lambda: second.poll() is not None, "it did not end")
    finally:
        _end(second)
    assert second.returncode == 0, (tmp_path / "second" / "log.txt").read_text()
    assert all(os.stat(p).st_mtime_ns == stamp for p, stamp in before.items())
    assert (tmp_path / "out" / "sweep.nc").read_bytes() == (tmp_path / "alone" / "sweep.nc").read_bytes()


@pytest.mark.slow
def test_a_run_that_kills_its_process_is_one_failure_and_the_others_go_on(tmp_path, monkeypatch):
    from cosim.compute.batch import Batches
    from cosim.compute.result import Task
    from tests.sweep.deadly import deadly

    place = DaskPlace(2, goes_on=True)
    try:
        found = Batches(place).results(deadly, 2.0, [Task(f"d{n}", n) for n in range(4)])
    finally:
        place.close()
    assert [r.is_complete for r in found] == [True, True, False, True]
    assert "its process died" in found[2].failure


def test_the_data_set_opens_with_its_labels(tmp_path):
    path = written(tmp_path, SLOW.replace("count: 12", "count: 2"), "2 s")
    sweep(path, tmp_path / "out", Here(), False)
    with xr.open_dataset(tmp_path / "out" / "sweep.nc") as data:
        assert data["volume"].attrs == {"units": "mm^3", "key": "actuator.parameters.volume"}
        assert data["temperature"].dims == ("volume", "time")
