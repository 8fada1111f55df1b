"""Markers that stay near known places, among spots of their colour that are none."""

import numpy as np
import pytest

from chainmail.camera.follow import follow_points
from chainmail.camera.spots import Places
from chainmail.camera.tracks import GAP

#: Two markers 200 mm apart; both sway by `SWAY` [m] in two seconds, 30 pictures per second.
POINTS = np.array([[0.0, 0.0], [0.2, 0.0]])
TIMES = np.arange(60) / 30.0


def pictures(sway: float, foreign: float | None = None, hidden: slice = slice(0, 0)) -> list[Places]:
    """Spots of each picture: both markers, and another thing at a fixed place; the first marker can be hidden."""
    found = []
    for number, time in enumerate(TIMES):
        shift = np.array([sway * np.sin(np.pi * time), 0.0])
        places = POINTS + shift
        if number in range(*hidden.indices(len(TIMES))):
            places = places[1:]
        if foreign is not None:
            places = np.concatenate([places, [[foreign, 0.0]]])
        count = len(places)
        found.append(Places(places, np.tile(1e-10 * np.eye(2), (count, 1, 1)), np.ones(count), np.ones(count, bool)))
    return found


def true_places(sway: float) -> np.ndarray:
    return POINTS + np.stack([sway * np.sin(np.pi * TIMES), np.zeros(len(TIMES))], axis=1)[:, None]


def test_markers_within_their_reach_are_read_and_nothing_is_said():
    tracks, said = follow_points(TIMES, pictures(0.04), POINTS, reach=0.06)
    assert said == ()
    np.testing.assert_allclose(tracks.places, true_places(0.04), atol=1e-9)


@pytest.mark.parametrize("foreign", [-0.03, 0.02])
def test_a_marker_that_leaves_its_reach_is_not_the_next_best_spot(foreign):
    """At 0.08 m the first marker is beyond 0.06 m, and what does not move is the only spot within its reach."""
    tracks, said = follow_points(TIMES, pictures(0.08, foreign), POINTS, reach=0.06)
    off = np.abs(tracks.places - true_places(0.08))[..., 0]
    assert np.nanmax(off) < 1e-6
    assert np.all(tracks.state[np.abs(true_places(0.08)[:, 0, 0]) > 0.06, 0] == GAP)
    assert len(said) == 1
    assert "may go farther; where a spot beyond its reach may be it, it is a gap" in said[0]
    assert "state a larger `reach`" in said[0]


def test_a_marker_that_comes_near_the_end_of_its_reach_and_stays_within_is_read():
    """It is said all the same: the tool cannot know that it stays within."""
    tracks, said = follow_points(TIMES, pictures(0.057), POINTS, reach=0.06)
    np.testing.assert_allclose(tracks.places, true_places(0.057), atol=1e-9)
    assert len(said) == 1
