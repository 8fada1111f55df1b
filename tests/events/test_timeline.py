"""The joint axis of recordings: where each lies, what has set in by then, and what belongs to one day."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cosim.unit.errors import InputError
from diagnosis.models.timeline import ASIDE, Day, Timeline
from diagnosis.recording.recording import Recording

SPANS = [(0.0, 60.0), (10.0, 60.0), (0.0, 64.0)]


def recording(name: str, **facts: Any) -> Recording:
    return Recording(Path(name), name, {}, (), {}, 60.0, 0.3, **facts)


def timeline(*orders: int | None, days: tuple[str, ...] = ("", "", "")) -> Timeline:
    given = [recording(f"r{n}", order=o, day=d) for n, (o, d) in enumerate(zip(orders or (None,) * 3, days))]
    return Timeline.of(given, SPANS)


def test_recordings_follow_each_other_without_gaps_as_given() -> None:
    line = timeline()
    assert [s.position for s in line.seats] == [0.0, 60.0, 110.0]
    assert (line.begin, line.end) == (0.0, 174.0)
    assert line.place(118.0) == (2, 8.0)
    assert line.joint(2, 8.0) == 118.0
    assert line.place(60.0) == (1, 10.0)  # the end of one is the begin of the next, on that one's clock
    assert line.place(174.0) == (2, 64.0)


def test_one_recording_keeps_its_own_clock() -> None:
    line = Timeline.of([recording("r")], [(10.0, 60.0)])
    assert (line.begin, line.end) == (10.0, 60.0)
    assert line.seats[0].local(23.0) == 23.0


def test_what_sets_in_lasts_in_later_recordings_and_is_not_there_before() -> None:
    first, second, third = timeline().seats
    line = timeline()
    assert line.local(70.0, first, lasts=True) is None
    assert line.local(70.0, second, lasts=True) == 20.0
    assert line.local(70.0, third, lasts=True) == -ASIDE
    assert line.local(line.end, third, lasts=True) is None


def test_what_belongs_to_a_day_is_in_no_other_recording() -> None:
    line = timeline()
    assert [line.local(70.0, s, lasts=False) for s in line.seats] == [None, 20.0, None]


def test_a_day_of_two_recordings_keeps_what_set_in_within_the_first() -> None:
    line = timeline(days=("", "monday", "monday"))
    assert [line.local(70.0, s, lasts=False) for s in line.seats] == [None, 20.0, -ASIDE]
    assert line.days == (Day("", 0), Day("monday"))
    assert [d.label for d in line.days] == ["in recording 1", "on day monday"]


def test_the_order_that_recordings_say_counts() -> None:
    line = timeline(3, 1, 2)
    assert line.order == (1, 2, 0)
    assert [s.position for s in line.seats] == [124.0, 10.0, 60.0]
    assert line.place(124.0) == (0, 0.0)


def test_recordings_held_out_come_last_or_where_they_say() -> None:
    line = timeline(1, 2, 4)
    late, between, early = line.others(
        [recording("a"), recording("b", order=3), recording("c", order=0)], [(0.0, 50.0)] * 3
    )
    for instant, expected in (
        (5.0, (True, True, False)),
        (109.0, (True, True, False)),
        (118.0, (True, False, False)),
        (174.0, (True, False, False)),
    ):
        found = tuple(line.local(instant, s, lasts=True) for s in (late, between, early))
        assert found == tuple(-ASIDE if there else None for there in expected), instant
    assert line.local(118.0, late, lasts=False) is None


def test_a_recording_held_out_of_the_same_day_has_what_belongs_to_it() -> None:
    line = timeline(days=("", "", "monday"))
    (same,) = line.others([recording("a", day="monday")], [(0.0, 50.0)])
    assert line.local(118.0, same, lasts=False) == -ASIDE
    assert line.local(70.0, same, lasts=False) is None


@pytest.mark.parametrize(
    ("orders", "said"),
    [((1, None, 2), "is missing here"), ((1, 2, 2), "is 2, as in r1")],
)
def test_an_order_that_is_not_clear_is_refused(orders: tuple[int | None, ...], said: str) -> None:
    with pytest.raises(InputError, match=said) as error:
        timeline(*orders)
    assert error.value.key == "order"
    assert error.value.source.endswith("recording.yaml")
    assert error.value.remedy


def test_a_place_that_is_taken_or_not_comparable_is_refused() -> None:
    with pytest.raises(InputError, match="is given here and not in the recordings that are fitted"):
        timeline().others([recording("a", order=2)], [(0.0, 50.0)])
    with pytest.raises(InputError, match="is 2, as in r1"):
        timeline(1, 2, 3).others([recording("a", order=2)], [(0.0, 50.0)])
