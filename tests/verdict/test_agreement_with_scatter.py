"""Contacts of a fabric stay where they are: their scatter counts as few readings, however many were taken."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnosis.judge import agreement as judged
from diagnosis.judge.agreement import LEVEL, MEMORY, _independent
from diagnosis.models.fabric import scatter


def test_scatter_is_remembered_as_long_as_the_search_takes_it_to_be() -> None:
    assert MEMORY == scatter.MEMORY


def test_white_noise_alone_counts_each_reading() -> None:
    assert _independent([[(400, 0.0, 0.0)]]) == pytest.approx(400.0)
    assert _independent([[(400, 0.0, 0.0), (100, 0.0, 0.0)], [(50, 0.0, 0.0)]]) == pytest.approx(550.0)


def test_scatter_counts_as_two_or_three_readings_of_a_recording() -> None:
    """1 / mean(exp(-4 |s - t|)) = 2.65; two recordings are independent, two channels of one are not."""
    one = _independent([[(400, 1.0, 0.0)]])
    assert one == pytest.approx(1.0 / (0.5 - 0.125 * (1.0 - math.exp(-4.0))), rel=1e-6)
    assert _independent([[(400, 1.0, 0.0)], [(400, 1.0, 0.0)]]) == pytest.approx(2.0 * one)
    assert _independent([[(400, 1.0, 0.0), (400, 1.0, 0.0)]]) == pytest.approx(one)
    assert _independent([[(1, 1.0, 0.0)]]) == pytest.approx(1.0)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_equal_fabrics_are_rejected_as_seldom_as_is_stated(share: float) -> None:
    """Of 4000 draws of a process with that memory, at most one in two hundred exceeds the limit of one in a thousand.

    Satterthwaite's chi-square has the mean and the variance of the sum of squares, and not its whole tail.
    """
    count, draws = 60, 4000
    rng = np.random.default_rng(7)
    times = np.arange(count) / count
    covariance = share * np.exp(-np.abs(times[:, None] - times) / MEMORY) + (1.0 - share) * np.eye(count)
    values = rng.standard_normal((draws, count)) @ np.linalg.cholesky(covariance + 1e-12 * np.eye(count)).T
    free = _independent([[(count, share, 0.0)]])
    limit = float(judged.chdtri(free, LEVEL)) / free
    assert np.mean(np.mean(values**2, axis=1) > limit) <= 0.005
    assert np.mean(np.mean((1.0 + 4.0 / math.sqrt(free)) * values**2, axis=1) > 0.5 * limit) > 0.005  # it can reject


@pytest.mark.parametrize("correlation", [0.5, 0.8, 0.9])
def test_noise_that_is_alike_from_reading_to_reading_rejects_no_model(correlation: float) -> None:
    """Of 2000 draws of autoregressive noise of the stated size: the correlation is that, and few exceed the limit."""
    count, draws = 400, 2000
    rng = np.random.default_rng(11)
    values = np.empty((draws, count))
    values[:, 0] = rng.standard_normal(draws)
    for i in range(1, count):
        fresh = rng.standard_normal(draws)
        values[:, i] = correlation * values[:, i - 1] + math.sqrt(1.0 - correlation**2) * fresh
    known = [judged._correlation(judged._scatter(row), count, 0.0) for row in values]
    assert np.median(known) == pytest.approx(correlation, abs=0.02)
    free = [_independent([[(count, 0.0, c)]]) for c in known]
    limits = np.array([float(judged.chdtri(f, LEVEL)) / f for f in free])
    rejected = np.mean(np.mean(values**2, axis=1) > limits)
    assert rejected <= 0.01
    white = float(judged.chdtri(count, LEVEL)) / count
    assert np.mean(np.mean(values**2, axis=1) > white) > rejected  # which is what it was compared with


def test_white_noise_of_the_stated_size_has_no_correlation_and_half_of_it_is_an_overstated_one() -> None:
    rng = np.random.default_rng(3)
    white = rng.standard_normal((500, 400))
    found = [judged._correlation(judged._scatter(row), 400, 0.0) for row in white]
    assert np.mean([f > 0.0 for f in found]) <= 0.05
    assert _independent([[(400, 0.0, 0.5)]]) == pytest.approx(400.0 * 0.75 / 1.25)  # Bartlett 1935
    assert judged._correlation(0.0, 400, 0.0) == judged.MOST_ALIKE  # a drift is no noise
    assert _independent([[(3, 0.0, 0.999)]]) == pytest.approx(1.0)  # no fewer than one
