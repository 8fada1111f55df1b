"""What a rig shares and what a day has, as numbers."""

import numpy as np
import pytest

from diagnosis.search.shares import (
    departures,
    is_carried,
    is_own,
    own_deviation,
    own_label,
    shared_deviation,
)


def test_both_parts_add_to_what_is_stated_and_the_surest_recording_limits_what_is_shared():
    shared = shared_deviation([1.0, 0.5])
    assert shared == pytest.approx(0.5 / np.sqrt(2.0))
    for stated in (1.0, 0.5):
        assert np.hypot(shared, own_deviation(stated, shared)) == pytest.approx(stated)
    assert shared_deviation([5.0], most=0.3) == pytest.approx(0.3 / np.sqrt(2.0))


def test_names_tell_what_means_the_same_in_another_model():
    own, day = own_label("ambient_offset", 0), own_label("ambient_offset", 0, "monday")
    assert (own, day) == ("ambient_offset of recording 1", "ambient_offset of recording day monday")
    assert [is_own(n) for n in ("ambient_offset", own, day)] == [False, True, True]
    assert [is_carried(n) for n in ("ambient_offset", own, day)] == [True, False, True]


def test_a_departure_is_that_of_both_parts_together():
    """1.7 deviations of each half of the variance are 2.4 of the whole: a room 1.2 K off that is doubted by 0.5 K."""
    names = ["capacity", "ambient_offset", "ambient_offset of recording 1", "coil[1].start of recording 1"]
    half = 0.5 / np.sqrt(2.0)
    found = departures(names, np.array([0.1, half, half, 3.0]), np.array([1.0, 0.6 / half, 0.6 / half, -2.0]))
    assert found == {
        "capacity": (pytest.approx(0.1), pytest.approx(1.0)),
        "ambient_offset of recording 1": (pytest.approx(1.2), pytest.approx(2.4)),
        "coil[1].start of recording 1": (pytest.approx(-6.0), pytest.approx(-2.0)),
    }
