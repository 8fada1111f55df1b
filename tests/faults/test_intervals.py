"""The scan against all intervals tried one by one, and what chance makes of it."""

import itertools

import numpy as np
import pytest

from diagnosis.faults.intervals import Pieces, best_constant, best_interval
from diagnosis.faults.law import Span

COUNT = 40


def pieces_of(values, nuisance, noise):
    """Pieces of one sample each, with some directions projected out by least squares."""
    left = np.eye(COUNT) - nuisance @ np.linalg.pinv(nuisance)
    slopes = -np.eye(COUNT)
    return Pieces(
        slopes @ left @ slopes.T,
        np.eye(COUNT),
        slopes @ left @ values,
        slopes @ left @ noise,
        np.ones(COUNT, dtype=int),
    )


def test_the_best_interval_is_the_best_of_all_least_squares_fits():
    random = np.random.default_rng(0)
    nuisance = np.stack([np.ones(COUNT), np.linspace(-1.0, 1.0, COUNT)], axis=1)
    values, noise = random.standard_normal(COUNT), random.standard_normal((COUNT, 3))
    values[12:22] += 4.0
    found = best_interval(pieces_of(values, nuisance, noise), 3, (-100.0, 100.0))
    for column, gain in zip((values, *noise.T), (found.gain, *found.chance)):
        best, where = 0.0, (0, 0)
        for a, b in itertools.combinations(range(COUNT + 1), 2):
            if 3 <= b - a < COUNT:
                box = np.zeros(COUNT)
                box[a:b] = 1.0
                both = np.column_stack([nuisance, box])
                costs = [float(np.linalg.lstsq(m, column, rcond=None)[1][0]) for m in (nuisance, both)]
                if costs[0] - costs[1] > best:
                    best, where = costs[0] - costs[1], (a, b)
        assert gain == pytest.approx(best, rel=1e-6)
        if column is values:
            assert (found.first, found.last) == where
    assert found.amount == pytest.approx(4.0, abs=1.0)


def test_no_more_than_one_scan_of_noise_in_twenty_passes_its_price_and_the_level():
    random = np.random.default_rng(1)
    noise = random.standard_normal((COUNT, 2000))
    found = best_interval(pieces_of(noise[:, 0], np.ones((COUNT, 1)), noise), 3, (-100.0, 100.0))
    level = 3.841  # exceeded by a chi-square of one degree of freedom with probability 0.05
    assert np.mean(found.chance > Span(0.0, 1.0, COUNT).price + level) < 0.05


def test_readings_that_stand_still_are_found_where_they_do():
    random = np.random.default_rng(2)
    truth = np.linspace(0.0, 50.0, COUNT)
    readings = truth + random.standard_normal(COUNT)
    readings[15:25] = readings[15]
    first, last, gain = best_constant(readings - truth, readings, 3, np.ones(COUNT, dtype=bool), COUNT)
    assert (first, last) == (15, 25)
    assert gain > 200.0
