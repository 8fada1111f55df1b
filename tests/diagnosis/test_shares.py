"""What a rig shares and what a day has, as numbers."""

import numpy as np
import pytest

from diagnosis.search.problem import Own, Parameter
from diagnosis.search.shares import (
    departures,
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
    owners = (None, Own("ambient_offset", 0), Own("ambient_offset", 0, "monday"))
    names = ["ambient_offset", *(own_label(o) for o in owners if o)]
    assert names[1:] == ["ambient_offset of recording 1", "ambient_offset of recording day monday"]
    parameters = [Parameter(n, "K", 0.0, 1.0, False, own=o) for n, o in zip(names, owners)]
    assert [p.is_carried for p in parameters] == [True, False, True]


def test_a_departure_is_that_of_both_parts_together():
    """1.7 deviations of each half of the variance are 2.4 of the whole: a room 1.2 K off that is doubted by 0.5 K."""
    half = 0.5 / np.sqrt(2.0)
    room, start = Own("ambient_offset", 0), Own("coil[1].start", 0)
    parameters = [
        Parameter("capacity", "J/K", 1.0, 0.1),
        Parameter("ambient_offset", "K", 0.0, half, False),
        Parameter(own_label(room), "K", 0.0, half, False, own=room),
        Parameter(own_label(start), "K", 0.0, 3.0, False, own=start),
    ]
    found = departures(parameters, np.array([1.0, 0.6 / half, 0.6 / half, -2.0]))
    assert found == {
        "capacity": (pytest.approx(0.1), pytest.approx(1.0)),
        "ambient_offset of recording 1": (pytest.approx(1.2), pytest.approx(2.4)),
        "coil[1].start of recording 1": (pytest.approx(-6.0), pytest.approx(-2.0)),
    }
