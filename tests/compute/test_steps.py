"""What is told of a stage: what is looked for, per cent, and the time left."""

import time

import pytest

from cosim.compute.batch import Batches
from cosim.compute.result import Task
from cosim.compute.steps import PAUSE, Steps, counted, share, watched
from diagnosis.search.explanation import Settings
from diagnosis.search.search import search
from tests.compute.work import square
from tests.search.line_model import TERMS, TIME, LineModel


class Clock:
    """A clock that runs one second with every look."""

    def __init__(self):
        self.time = 0.0

    def __call__(self):
        self.time += 1.0
        return self.time


@pytest.fixture
def told():
    return []


@pytest.fixture
def steps(told):
    with watched(Steps(told.append, Clock())) as found:
        yield found


def test_a_count_tells_what_is_done_per_cent_and_time_left(steps, told):
    steps("looking for a second effect")
    for _ in counted(range(4), "laws scored", [100, 100, 100, 112]):
        pass
    assert told[0] == "looking for a second effect"
    assert told[1] == "looking for a second effect: 0 of 412 laws scored"
    assert told[2].startswith("looking for a second effect: 100 of 412 laws scored, 24 %, about ")
    assert told[2].endswith(" s left in this step")
    assert [t.split(",")[1] for t in told[2:]] == [" 24 %", " 49 %", " 73 %", " 100 %"]


def test_the_time_left_is_that_of_the_rate_so_far(told):
    now = [0.0]
    with watched(Steps(told.append, lambda: now[0])) as steps:
        steps("fitting")
        for _ in counted(range(8), "laws fitted"):
            now[0] += 10.0
    assert told[1] == "fitting: 1 of 8 laws fitted, 12 %, about 1.2 min left in this step"  # 70 s
    assert told[4] == "fitting: 4 of 8 laws fitted, 50 %, about 41 s left in this step"  # 40 s, rounded up


def test_inner_counts_and_shares_move_the_outer_one(steps, told):
    steps("fitting")
    for _ in counted(["a", "b"], "explanations validated"):
        for _ in counted(range(2), "stretches left out"):
            share(0.5)
    per_cent = [int(t.split(", ")[1].removesuffix(" %")) for t in told if "%" in t]
    assert per_cent == sorted(per_cent)
    assert {12, 25, 38, 50, 62, 75, 88, 100} <= set(per_cent)
    assert all("explanations validated" in t for t in told[1:])


def test_a_stage_that_counts_nothing_tells_its_share(steps, told):
    steps("recalibrating")
    share(0.25)
    share(0.1)  # a fit may fall back; what was told is not taken back
    assert told[1].startswith("recalibrating: 25 %, about")
    assert told[2].startswith("recalibrating: 25 %, about")


def test_a_stage_of_several_fits_tells_how_long_it_takes_once_the_first_is_done(steps, told):
    steps("fitting what was exchanged")
    for value in (0.4, 1.0, 0.2, 0.9):
        share(value)
    assert told[2] == "fitting what was exchanged: 100 %"  # no time is left of this fit, and no other is known of
    assert told[3].endswith(" so far")
    assert told[4].endswith(" so far")
    steps("another stage")
    share(0.5)
    assert told[-1].startswith("another stage: 50 %")


def test_a_loop_that_is_left_early_is_over(steps, told):
    steps("looking")
    for _ in counted(range(10), "pairs"):
        break
    with pytest.raises(ZeroDivisionError):
        [1 // n for n in counted(range(10), "laws")]
    share(0.5)
    assert told[-1].startswith("looking: 50 %")


def test_lines_come_no_faster_than_they_can_be_read(told):
    with watched(Steps(told.append)) as steps:
        steps("scoring")
        begin = time.monotonic()
        for _ in counted(range(50_000), "laws"):
            pass
        most = 2 + (time.monotonic() - begin) / PAUSE
    assert len(told) <= most


def test_where_nobody_watches_loops_are_as_they_are(told):
    assert list(counted([1, 2, 3], "numbers")) == [1, 2, 3]
    share(0.5)
    assert told == []


def test_simulations_of_a_batch_are_shares_of_what_asked_for_them(steps, told):
    steps("recalibrating")
    Batches().results(square, 1.0, [Task(str(n), float(n)) for n in range(4)])
    assert [t.split(",")[0] for t in told[1:]] == [f"recalibrating: {n} %" for n in (25, 50, 75, 100)]


def test_every_stage_of_a_search_tells_what_it_looks_for_and_how_far_it_is(steps, told):
    model = LineModel(0.3 * TIME + 2.0 * TIME**2, seed=3)
    search(model, TERMS, Settings(), on_progress=steps)
    for stage, what in (
        ("recalibrating", "rounds of the fit"),
        ("looking for a first effect", "laws at places scored"),
        ("looking for a first effect", "laws fitted"),
        ("searching recordings without effects, for what chance alone gives", "recordings without effects searched"),
        ("looking for a second effect", "laws at places scored"),
        ("removing what is not needed", "effects left out in turn"),
    ):
        assert any(t.startswith(f"{stage}: ") and what in t and " %" in t for t in told), (stage, what)
