"""What is measured on photographs of others: still and swaying ones, distances on one bar, readings of other things."""

import numpy as np

from chainmail.camera.tracks import SEEN, Tracks
from evaluation.camera.pictures import COLUMNS, LINES, PIXEL, kinds_of, scatter_of_distances, strays


def swaying(still: int, moving: int) -> Tracks:
    """All 28 targets at rest, then moved along by 5 px from picture to picture."""
    stated = np.array([[column, -line] for line in LINES for column in COLUMNS], dtype=float)
    along = np.concatenate([np.zeros(still), 5.0 * np.arange(1, moving + 1)])
    places = (stated[None] + np.stack([along, np.zeros_like(along)], axis=1)[:, None]) * PIXEL
    count = len(along)
    return Tracks(
        times=np.arange(count) / 20.0,
        places=places,
        covariance=np.tile(np.eye(2), (count, 28, 1, 1)),
        share=np.ones((count, 28)),
        state=np.full((count, 28), SEEN),
        margin=np.zeros(count),
    )


def test_what_stands_still_is_the_longest_stretch_without_movement():
    still, moving = kinds_of(swaying(20, 30))
    assert list(np.flatnonzero(still)) == list(range(20))
    assert list(np.flatnonzero(moving)) == list(range(20, 50))


def test_distances_are_taken_between_targets_of_one_bar():
    tracks = swaying(20, 30)
    every = np.ones(50, dtype=bool)
    assert len(scatter_of_distances(tracks, every, farthest=1)) == 4 * 6
    assert len(scatter_of_distances(tracks, every, farthest=6)) == 4 * 21
    # One target to and fro along its bar by 1 px: by 1.01 px (49 degrees of freedom), from each of its neighbours.
    tracks.places[:, 1, 0] += PIXEL * np.where(np.arange(50) % 2, 1.0, -1.0)
    scatter = scatter_of_distances(tracks, every, farthest=1)
    np.testing.assert_allclose(np.sort(scatter)[-2:], 1.01, atol=0.001)
    np.testing.assert_allclose(np.sort(scatter)[:-2], 0.0, atol=1e-9)


def test_a_reading_of_something_else_is_counted():
    tracks = swaying(20, 30)
    assert strays(tracks) == 0
    tracks.places[7, 23] += [120.0 * PIXEL, 0.0]
    assert strays(tracks) == 1
