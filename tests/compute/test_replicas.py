"""Copies in other processes: answers in order whoever gave them, and nothing lost where a process is."""

from __future__ import annotations

import gc
import os
import signal
import time
from collections.abc import Callable

import pytest

from cosim.compute import replicas
from cosim.compute.replicas import Replicas
from tests.compute import work


@pytest.fixture(autouse=True)
def begin_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replicas, "WORTH", 0.0)


def _answering(
    make: Callable[[int], Callable[[int], tuple[int, int]]], count: int = 1
) -> Replicas[int, tuple[int, int]]:
    """What answers with the process that did, and the square of a question and a number."""
    return Replicas(make, 3, work.squares(3), count)


def _ready(asked: Replicas[int, tuple[int, int]]) -> None:
    """Ask until every process is ready, or is gone."""
    asked.answers([1, 2])
    end = time.monotonic() + 60.0
    while any(r.process.poll() is None and not r.look() for r in asked._replicas):
        assert time.monotonic() < end, "a process does not answer"
        time.sleep(0.01)


@pytest.mark.parametrize("count", [1, 2])
def test_answers_keep_their_order_and_come_from_all(count: int) -> None:
    asked = _answering(work.squares, count)
    _ready(asked)
    found = asked.answers(list(range(60)))
    assert [value for _, value in found] == [n * n + 3 for n in range(60)]
    assert os.getpid() in {process for process, _ in found}
    assert len({process for process, _ in found}) == 1 + count
    asked.close()


def test_one_question_is_answered_here() -> None:
    asked = _answering(work.squares)
    _ready(asked)
    assert asked.answers([7]) == [(os.getpid(), 52)]
    assert asked.answers([]) == []
    asked.close()


def test_nothing_is_begun_before_it_is_worth_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replicas, "WORTH", 3600.0)
    asked = _answering(work.squares)
    asked.answers(list(range(20)))
    assert not asked._replicas


def test_what_a_lost_process_was_asked_is_answered_here() -> None:
    asked = _answering(work.squares)
    _ready(asked)
    (replica,) = asked._replicas
    os.kill(replica.process.pid, signal.SIGKILL)
    found = asked.answers(list(range(40)))
    assert [value for _, value in found] == [n * n + 3 for n in range(40)]
    assert not asked._replicas


def test_a_copy_that_cannot_be_made_is_done_without() -> None:
    asked = _answering(work.no_squares)
    asked.answers([1, 2])
    asked._replicas[0].process.wait(60.0)  # with an error
    found = asked.answers(list(range(10)))
    assert found == [(os.getpid(), n * n + 3) for n in range(10)]


def test_an_error_is_raised_as_it_is_here() -> None:
    asked = _answering(work.squares)
    _ready(asked)
    with pytest.raises(ValueError, match="-1 has no square here"):
        asked.answers([-1, 2, 3, 4])  # the first is asked of the other process
    assert [value for _, value in asked.answers([2, 3])] == [7, 12]


def test_an_interruption_leaves_no_process_and_no_stale_answer() -> None:
    processes: list[int] = []

    def interrupted(question: int) -> tuple[int, int]:
        if question == 5:
            raise KeyboardInterrupt
        return work.squares(3)(question)

    asked: Replicas[int, tuple[int, int]] = Replicas(work.squares, 3, interrupted, 1)
    _ready(asked)
    processes += [r.process.pid for r in asked._replicas]
    with pytest.raises(KeyboardInterrupt):
        asked.answers([1, 2, 3, 4, 5])
    assert not asked._replicas
    assert not any(_lives(p) for p in processes)
    assert [value for _, value in asked.answers([6, 7])] == [39, 52]


def test_processes_end_with_what_asks_them() -> None:
    asked = _answering(work.squares)
    _ready(asked)
    (process,) = [r.process.pid for r in asked._replicas]
    assert _lives(process)
    del asked
    gc.collect()
    assert not _lives(process)


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True
