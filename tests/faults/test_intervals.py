"""The scan against all intervals tried one by one, and what chance makes of it."""

import itertools
import tracemalloc

import numpy as np
import pytest

from diagnosis.faults import scan
from diagnosis.faults.intervals import Pieces, best_constant, best_interval
from diagnosis.faults.law import OFFSET, Span, fault_term
from diagnosis.faults.readings import Readings
from diagnosis.search.fit import Columns, Fit
from diagnosis.search.problem import Point
from diagnosis.search.score import Projection

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


def offset_in(count, first, last, size):
    """A channel of noise that reads too little within some samples: its scores."""
    random = np.random.default_rng(3)
    residuals = random.standard_normal(count)
    residuals[first:last] -= size
    columns = Columns.of(np.ones((count, 1)), np.zeros(1), residuals)
    fit = Fit(Point(np.zeros(1)), 0.0, residuals, columns, np.zeros((count, 0)), True, np.ones(1))
    projection = Projection(fit)
    projection.noise(100, 0)
    used = np.ones(count, dtype=bool)
    readings = Readings(
        0, 0, "T", "K", slice(0, count), np.arange(count + 1.0), residuals, 1.0, used, 0.0, np.arange(count) + 0.5
    )
    term = fault_term(OFFSET, "T", readings.offset(), readings.span, 0)
    scoring = scan.sensor_scores(fit, projection, lambda rows, own: rows, [(readings, [term])])
    assert len(scoring.ranked) == 1
    return scoring.ranked[0]


def test_begin_and_end_in_a_long_channel_are_found_step_by_step_nearly_as_if_every_sample_had_been_tried(monkeypatch):
    monkeypatch.setattr(scan, "MOST_CUTS", 3000)
    whole = offset_in(3000, 501, 1203, 2.0)
    monkeypatch.setattr(scan, "MOST_CUTS", 40)
    stepwise = offset_in(3000, 501, 1203, 2.0)
    assert stepwise.values[1:] == pytest.approx(whole.values[1:], abs=5.0)
    assert whole.gain - 1.0 < stepwise.gain <= whole.gain * (1.0 + 1e-9)
    assert whole.values[1:] == pytest.approx((501.0, 1203.0), abs=3.0)  # of noise at the edges


def test_the_scan_of_a_long_channel_fits_into_a_little_memory():
    """A table of every begin near the best with every end takes 3 GB here, and took 17 GB at 20,000 samples."""
    tracemalloc.start()
    found = offset_in(8000, 2013, 5107, 1.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert found.values[1:] == pytest.approx((2013.0, 5107.0), abs=10.0)
    assert peak < 2e8  # bytes: 400 directions of 8000 samples are 26 MB


def test_readings_that_move_do_not_stand_still_however_badly_the_model_errs():
    random = np.random.default_rng(4)
    readings = np.linspace(0.0, 50.0, COUNT) + random.standard_normal(COUNT)
    residuals = np.where(np.arange(COUNT) < COUNT // 2, 80.0, 0.0) + random.standard_normal(COUNT)
    every = np.ones(COUNT, dtype=bool)
    found = best_constant(residuals, readings, 8, every, COUNT)
    assert found is None
    weakened = best_constant(residuals, 0.01 * readings, 8, every, COUNT, own=readings)
    assert weakened is None


def test_a_sensor_that_works_and_reads_what_rests_does_not_stand_still():
    """A motor that has stopped: its current is 0 and the noise, and the model errs there."""
    random = np.random.default_rng(5)
    readings = np.where(np.arange(COUNT) < COUNT // 2, np.linspace(0.0, 50.0, COUNT), 0.0)
    readings = readings + random.standard_normal(COUNT)
    residuals = random.standard_normal(COUNT) + np.where(np.arange(COUNT) < COUNT // 2, 0.0, 6.0)
    every = np.ones(COUNT, dtype=bool)
    assert best_constant(residuals, readings, 8, every, COUNT) is None
    readings[COUNT // 2 :] = 0.4  # the same value again and again
    found = best_constant(residuals, readings, 8, every, COUNT)
    assert found is not None
    assert found[0] >= COUNT // 2


def test_a_sensor_that_stands_still_is_found_to_a_sample_between_pieces():
    """From sample 251 to 374 of 900: the pieces of 14 samples would leave 13 of them to a gain of the same readings."""
    random = np.random.default_rng(6)
    truth = 300.0 * np.sin(np.arange(900) / 40.0)
    readings = np.round(truth + random.standard_normal(900))
    readings[251:374] = readings[251]
    every = np.ones(900, dtype=bool)
    found = best_constant(readings - truth, readings, 8, every, 64)
    assert found is not None
    assert found[:2] == (251, 374)
    readings[251:374] += 0.05 * random.standard_normal(123)  # no two are equal
    found = best_constant(readings - truth, readings, 8, every, 64)
    assert found is not None
    assert found[0] == pytest.approx(251, abs=1)
    assert found[1] == pytest.approx(374, abs=1)
