"""Work on cases: here, in processes of this machine, and on a cluster by its address."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from typing import Any

import pytest

from cosim.unit.errors import InputError
from evaluation.proof.progress import Progress
from evaluation.proof.workers import WAITING, Lost, Workers, workers


def _square(number: int) -> tuple[int, int]:
    if number == 3:
        raise ArithmeticError("no squares of three")
    if number == 5:
        os._exit(1)  # as a crash in C does
    return number * number, os.getpid()


def _given(numbers: list[int]) -> dict[str, Any]:
    return {f"case_{n}": (lambda n=n: (n,)) for n in numbers}


@pytest.fixture(scope="module")
def crew() -> Iterator[Workers]:
    with workers(2) as made:
        yield made


def test_one_worker_is_this_process() -> None:
    with workers(1) as alone:
        found = dict(alone.results(_square, _given([1, 2, 3, 4])))
    assert [found[f"case_{n}"] for n in (1, 2, 4)] == [(n * n, os.getpid()) for n in (1, 2, 4)]
    assert found["case_3"] == Lost("ArithmeticError: no squares of three")


def test_several_workers_are_other_processes_and_none_of_the_cases_is_lost(crew: Workers) -> None:
    numbers = [n for n in range(4 * WAITING) if n != 5]
    found = dict(crew.results(_square, _given(numbers)))
    assert {case: r[0] for case, r in found.items() if case != "case_3"} == {
        f"case_{n}": n * n for n in numbers if n != 3
    }
    assert os.getpid() not in {r[1] for case, r in found.items() if case != "case_3"}
    assert isinstance(found["case_3"], Lost)


def test_a_cluster_is_used_by_its_address(crew: Workers) -> None:
    with workers(7, crew.client.scheduler_info()["address"]) as other:
        assert other.count == 2
        assert dict(other.results(_square, _given([6])))["case_6"][0] == 36


def test_a_cluster_that_does_not_answer_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cosim.compute.cluster.CONNECT_TIME", 0.5)
    with pytest.raises(InputError, match="does not answer"), workers(1, "tcp://127.0.0.1:9"):
        pass


@pytest.mark.slow
def test_a_case_that_kills_its_process_is_lost_and_the_others_are_done() -> None:
    with workers(2) as made:
        found = dict(made.results(_square, _given([4, 5, 6, 7])))
    assert [found[f"case_{n}"][0] for n in (4, 6, 7)] == [16, 36, 49]
    assert found["case_5"].message.startswith("KilledWorker")


def test_progress_tells_the_time_left_and_what_went_wrong() -> None:
    told: list[str] = []
    progress = Progress("diagnosed", 4, 1, told.append)
    progress.finished("case_0001", "")
    progress.finished("case_0002", "timed out: no answer within 1 s")
    time.sleep(0.01)
    progress.finished("case_0003", "")
    assert told[0].startswith("diagnosed: 2 of 4 cases, about ")
    assert told[1:] == ["case_0002: timed out: no answer within 1 s", "diagnosed: 4 of 4 cases"]
    assert Progress("x", 10, 4, told.append).remaining(6.0) == 36.0  # six left, none made yet: one each 6 s
