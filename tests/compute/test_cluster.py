"""Simulations in other processes: the same results, clear errors, and Ctrl-C that loses nothing."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time as clock
from pathlib import Path

import numpy as np
import pytest

from cosim.compute import cluster
from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.cluster import DaskPlace, Here, choose_place
from cosim.compute.result import Task
from cosim.unit.errors import InputError
from diagnosis.search.cosim_model import CosimModel, free_parameters
from diagnosis.search.pendulum_terms import pendulum_terms
from diagnosis.search.problem import Point
from tests.compute.work import deadly, square
from tests.diagnosis.test_cosim_model import made

ROOT = Path(__file__).resolve().parents[2]
INTERRUPTED = """
import sys
from pathlib import Path
from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.cluster import choose_place
from cosim.compute.result import Task
from tests.compute.work import slow

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    try:
        with Batches(choose_place(2), Cache(folder / "cache")) as batches:
            batches.results(slow, folder, [Task(f"{n:04d}", n) for n in range(1000)])
    except KeyboardInterrupt:
        sys.exit(130)
"""


@pytest.fixture(scope="module")
def two():
    place = choose_place(2)
    yield place
    place.close()


def test_one_job_needs_no_cluster():
    assert isinstance(choose_place(1), Here)
    assert isinstance(choose_place(3), DaskPlace)


def test_processes_share_a_batch_and_keep_what_it_shares(two):
    tasks = [Task(f"s{n}", float(n)) for n in range(20)]
    found = Batches(two).results(square, 2.0, tasks)
    assert [r.arrays[0][0] for r in found] == [2.0 * n**2 for n in range(20)]
    makers = {int(r.arrays[1][0]) for r in found}
    assert len(makers) == 2
    assert os.getpid() not in makers
    assert two.parallel == 2


def test_one_simulation_alone_is_made_here(two):
    assert int(Batches(two).results(square, 2.0, [Task("a", 1.0)])[0].arrays[1][0]) == os.getpid()


def test_a_model_has_the_same_residuals_and_derivatives_in_processes_to_the_last_bit(two, tmp_path):
    recording = made(tmp_path / "r", 1, viscous_damping="2e-4 N*m*s/rad")
    base = recording_scenario()
    free, terms = free_parameters(base, [recording]), pendulum_terms("arm")
    alone = CosimModel(base, [recording], free, terms)
    shared = CosimModel(base, [recording], free, terms, Batches(two, Cache(tmp_path / "cache")))
    points = [Point(np.array([0.1 * n])) for n in range(3)]
    np.testing.assert_array_equal(shared.residuals(points), alone.residuals(points))
    np.testing.assert_array_equal(shared.base_jacobian(points[1]), alone.base_jacobian(points[1]))
    assert shared.runs == 5
    assert Cache(tmp_path / "cache").count() == 4  # where derivatives are taken was simulated before


def recording_scenario():
    from cosim.scenario import load_scenario

    return load_scenario("pendulum")


def test_a_process_that_dies_is_said(monkeypatch):
    place = DaskPlace(2)
    try:
        with pytest.raises(InputError, match="a process died while it simulated"):
            Batches(place).results(deadly, 1.0, [Task("d1", 1.0), Task("d2", 2.0)])
    finally:
        place.close()


def test_a_cluster_that_does_not_answer_is_said(monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_TIME", 0.5)
    with pytest.raises(InputError, match=r"the cluster at .* does not answer"):
        Batches(DaskPlace(1, "tcp://127.0.0.1:9")).results(square, 1.0, [Task("a", 1.0)])


def test_ctrl_c_leaves_every_finished_simulation_whole(tmp_path):
    script = tmp_path / "interrupted.py"
    script.write_text(INTERRUPTED)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    # A terminal sends Ctrl-C to every process of the group, the workers too.
    process = subprocess.Popen(
        [sys.executable, str(script), str(tmp_path)], env=environment, start_new_session=True, stderr=subprocess.PIPE
    )
    end = clock.monotonic() + 60
    while Cache(tmp_path / "cache").count() < 4 and clock.monotonic() < end:
        clock.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors.decode()
    kept = sorted((tmp_path / "cache").glob("*/*"))
    assert len(kept) >= 4
    cache = Cache(tmp_path / "cache")
    for file in kept:
        result = cache.get(file.stem)
        assert result is not None
        assert result.arrays[0][0] == int(file.stem) ** 2
