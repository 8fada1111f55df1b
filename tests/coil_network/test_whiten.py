"""Whitening for an unknown zero of each channel: against the covariance itself."""

import numpy as np
import pytest

from diagnosis.models.coil_network.kernel.whiten import Whitening

LENGTHS = np.array([7, 1, 12])
ZERO = 0.4  # deviation of a channel's zero in deviations of its noise


@pytest.fixture
def drawn():
    rng = np.random.default_rng(3)
    outputs = rng.standard_normal((5, 40))
    pick = rng.permutation(40)[:20]
    weight = rng.uniform(0.5, 3.0, 20)
    weight[[2, 3, 9]] = 0.0
    return outputs, pick, weight


def whitening(pick, weight):
    used = np.array([np.count_nonzero(w) for w in np.split(weight, np.cumsum(LENGTHS)[:-1])])
    return Whitening(pick, weight, (1.0 - 1.0 / np.sqrt(1.0 + used * ZERO**2)) / used, LENGTHS)


def test_whitened_sums_of_squares_are_those_of_the_covariance(drawn):
    outputs, pick, weight = drawn
    rows = outputs[:, pick] * weight
    found = whitening(pick, weight).values(rows.copy())
    for plain, white in zip(rows, found):
        wanted = 0.0
        for part, inside in zip(np.split(plain, np.cumsum(LENGTHS)[:-1]), np.split(weight, np.cumsum(LENGTHS)[:-1])):
            r = part[inside > 0.0]
            wanted += r @ np.linalg.solve(np.eye(len(r)) + ZERO**2 * np.ones((len(r), len(r))), r)
        assert white @ white == pytest.approx(wanted, rel=1e-12)  # rounding alone


def test_slopes_are_those_of_the_residuals_and_add_up(drawn):
    outputs, pick, weight = drawn
    outputs[1:3, np.sort(pick)[:8]] = 0.0
    factors, into = np.array([1.0, -2.0, 0.5, 3.0, 1.0]), np.array([0, 2, 0, 1, 1])
    each = -whitening(pick, weight).values(outputs[:, pick] * weight) * factors[:, None]
    wanted = np.array([each[into == row].sum(axis=0) for row in range(4)])
    found = whitening(pick, weight).slopes(outputs, 4, into, factors)
    assert found == pytest.approx(wanted, abs=3e-6)  # single precision of numbers of about ten
    assert np.all(found[:, weight == 0.0] == 0.0)
    with pytest.raises(ValueError, match="rows"):
        whitening(pick, weight).slopes(outputs, 2, into, factors)
