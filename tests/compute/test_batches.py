"""Batches of simulations: each is made once, kept whole, and counted."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.progress import Progress
from cosim.compute.result import Task
from cosim.unit.errors import InputError
from tests.compute.work import interrupted_at_three, square


def tasks(*numbers: float) -> list[Task]:
    return [Task(f"{number:04.1f}", number) for number in numbers]


def test_results_come_in_the_order_of_their_tasks_and_equal_ones_are_made_once():
    batches = Batches()
    found = batches.results(square, 2.0, tasks(3, 1, 2, 1))
    assert [r.arrays[0][0] for r in found] == [18.0, 2.0, 8.0, 2.0]
    assert batches.made == 3


def test_a_kept_result_has_the_same_bits(tmp_path):
    made = Batches(cache=Cache(tmp_path)).results(square, 2.0, tasks(3, -1))
    again = Batches(cache=Cache(tmp_path))
    kept = again.results(square, 2.0, tasks(3, -1))
    assert again.made == 0
    np.testing.assert_array_equal(kept[0].arrays[0], made[0].arrays[0])
    assert kept[1].failure == "-1 is below 0"
    assert not kept[1].is_complete


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut off", b"no archive"])
def test_a_damaged_file_is_made_again(tmp_path, content):
    cache = Cache(tmp_path)
    Batches(cache=cache).results(square, 2.0, tasks(3))
    cache.file("03.0").write_bytes(content)
    again = Batches(cache=cache)
    assert again.results(square, 2.0, tasks(3))[0].arrays[0][0] == 18.0
    assert again.made == 1
    assert cache.get("03.0") is not None


def test_after_an_interrupt_only_the_rest_is_made(tmp_path):
    first = Batches(cache=Cache(tmp_path))
    with pytest.raises(KeyboardInterrupt):
        first.results(interrupted_at_three, 1.0, tasks(1, 2, 3, 4))
    assert Cache(tmp_path).count() == 2
    second = Batches(cache=Cache(tmp_path))
    found = second.results(square, 1.0, tasks(1, 2, 3, 4))
    assert second.made == 2
    assert [r.arrays[0][0] for r in found] == [1.0, 4.0, 9.0, 16.0]


def test_a_folder_that_cannot_be_written_is_said(tmp_path):
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(InputError, match="cannot be kept"):
        Batches(cache=Cache(tmp_path / "file")).results(square, 1.0, tasks(1))


def test_progress_counts_and_estimates_the_time_left(tmp_path):
    lines: list[str] = []
    progress = Progress(lines.append)
    batches = Batches(cache=Cache(tmp_path), progress=progress)
    progress.enter("recalibrating", expected=10)
    batches.results(square, 1.0, tasks(1, 2, 3, 4))
    # six of half a second each, one at a time
    assert progress.remaining == pytest.approx(3.0)
    assert lines[-1] == "recalibrating: 4 of about 10 simulations, 4 s left"
    progress.parallel = 2
    assert progress.remaining == pytest.approx(1.5)


def test_what_comes_from_the_disk_is_told_apart(tmp_path):
    Batches(cache=Cache(tmp_path)).results(square, 1.0, tasks(1, 2))
    lines: list[str] = []
    Batches(cache=Cache(tmp_path), progress=Progress(lines.append)).results(square, 1.0, tasks(1, 2, 3))
    assert lines[-1] == ": 3 simulations (2 from the disk)"
