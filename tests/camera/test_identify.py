"""Identity from the chain of links: right, or not resolved, never wrong."""

import numpy as np
import pytest

from chainmail.camera.identify import Expected, Weave, identify
from tests.camera.fabrics import markers

WEAVE = Weave(6, (0.0295, 0.035), (0.018, 0.031), (np.radians(20), np.radians(75)), 0.0)


def shuffled(places, hidden=(), seed=0):
    """Spots in any order with noise, and the number of the spot of each marker (-1 where it is hidden)."""
    random = np.random.default_rng(seed)
    left = [m for m in range(len(places)) if m not in hidden]
    order = random.permutation(len(left))
    spots = places[np.array(left)[order]] + 5e-5 * random.standard_normal((len(left), 2))
    truth = np.full(len(places), -1)
    truth[np.array(left)[order]] = np.arange(len(left))
    return spots, truth


@pytest.mark.parametrize("curvature", [-2.0, 0.0, 4.0, 9.0, 13.0])
@pytest.mark.parametrize("length", [0.030, 0.0345])
def test_every_marker_is_found(curvature, length):
    spots, truth = shuffled(markers(curvature, length))
    chain = identify(spots, WEAVE)
    assert chain is not None
    assert chain.is_resolved
    assert chain.spots.tolist() == truth.tolist()


@pytest.mark.parametrize("hidden", [(0,), (3,), (11,), (1, 2), (4, 7), (5, 10)])
def test_hidden_markers_give_no_wrong_identity(hidden):
    places = markers(7.0)
    for seed in range(6):
        spots, truth = shuffled(places, hidden, seed)
        chain = identify(spots, WEAVE)
        if chain is None or not chain.is_resolved:
            chain = identify(spots, WEAVE, Expected(places, np.full(12, 5e-3)))
        assert chain is not None
        assert chain.is_resolved
        assert all(found in (true, -1) for found, true in zip(chain.spots, truth))
        assert sum(found == -1 for found in chain.spots) <= len(hidden)


def test_a_hidden_first_or_last_row_is_not_told_apart_without_help():
    """Five rows of six: which end is missing only other pictures say."""
    spots, truth = shuffled(markers(0.0), (0, 1))
    chain = identify(spots, WEAVE)
    assert chain is None or not chain.is_resolved
    helped = identify(spots, WEAVE, Expected(markers(0.0), np.full(12, 3e-3)))
    assert helped is not None
    assert helped.spots.tolist() == truth.tolist()


def test_a_spot_beside_the_fabric_is_left_out():
    spots, truth = shuffled(markers(5.0))
    chain = identify(np.concatenate([spots, [[0.05, 0.09], [-0.06, 0.0]]]), WEAVE)
    assert chain is not None
    assert chain.spots.tolist() == truth.tolist()


def test_scattered_spots_are_no_fabric():
    spots = np.random.default_rng(5).uniform(0.0, 0.15, (12, 2))
    chain = identify(spots, WEAVE)
    assert chain is None or (chain.spots >= 0).sum() < 12
