"""Contacts of a fabric stay where they are: their scatter counts as few readings, however many were taken."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge import agreement as judged
from diagnosis.judge.agreement import LEVEL
from diagnosis.judge.gain import gain, worse_channels
from diagnosis.judge.independent import MEMORY, independent
from diagnosis.judge.unfitted import Predicted, Readings
from diagnosis.models.fabric import scatter
from tests.verdict.test_gain_and_agreement import readings


def test_scatter_is_remembered_as_long_as_the_search_takes_it_to_be() -> None:
    assert MEMORY == scatter.MEMORY


def test_white_noise_alone_counts_each_reading() -> None:
    assert independent([[(400, 0.0, 0.0)]]) == pytest.approx(400.0)
    assert independent([[(400, 0.0, 0.0), (100, 0.0, 0.0)], [(50, 0.0, 0.0)]]) == pytest.approx(550.0)


def test_scatter_counts_as_two_or_three_readings_of_a_recording() -> None:
    """1 / mean(exp(-4 |s - t|)) = 2.65; two recordings are independent, two channels of one are not."""
    one = independent([[(400, 1.0, 0.0)]])
    assert one == pytest.approx(1.0 / (0.5 - 0.125 * (1.0 - math.exp(-4.0))), rel=1e-6)
    assert independent([[(400, 1.0, 0.0)], [(400, 1.0, 0.0)]]) == pytest.approx(2.0 * one)
    assert independent([[(400, 1.0, 0.0), (400, 1.0, 0.0)]]) == pytest.approx(one)
    assert independent([[(1, 1.0, 0.0)]]) == pytest.approx(1.0)


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
    free = independent([[(count, share, 0.0)]])
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
    free = [independent([[(count, 0.0, c)]]) for c in known]
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
    assert independent([[(400, 0.0, 0.5)]]) == pytest.approx(400.0 * 0.75 / 1.25)  # Bartlett 1935
    assert judged._correlation(0.0, 400, 0.0) == judged.MOST_ALIKE  # a drift is no noise
    assert independent([[(3, 0.0, 0.999)]]) == pytest.approx(1.0)  # no fewer than one


def scattering(scatter: float, count: int = 60, channels: int = 12) -> Readings:
    """Readings of markers of which so much of the deviation is what contacts scatter by."""
    given = readings(channels, count=count)
    return replace(given, channels=tuple(replace(c, scatter=scatter) for c in given.channels))


def test_readings_of_what_contacts_scatter_by_count_as_few() -> None:
    assert np.all(scattering(0.0).weight == 1.0)
    one = independent([[(60, 1.0, 0.0)]]) / 60
    assert scattering(1.0).weight == pytest.approx(np.full(12 * 60, one))
    assert one < scattering(0.5**0.5).weight[0] < 1.0


def test_a_law_that_moves_equal_fabrics_within_their_scatter_makes_no_channel_worse() -> None:
    """Of 300 fabrics of 12 markers, with a law that moves each marker by a third of its scatter for the whole time.

    What contacts do to a marker stays for half of a recording, so its sixty readings are two or three. Counted as
    sixty, some marker was significantly worse in nearly all fabrics.
    """
    rng = np.random.default_rng(13)
    times = np.arange(60) / 60
    root = np.linalg.cholesky(np.exp(-np.abs(times[:, None] - times) / MEMORY) + 1e-12 * np.eye(60))
    own, white = scattering(1.0), scattering(0.0)
    worse, sixty, found = 0, 0, 0
    for _ in range(300):
        before = (rng.standard_normal((12, 60)) @ root.T).ravel()
        moved = np.repeat(rng.choice([-0.33, 0.33], 12), 60)
        worse += bool(worse_channels(before, before + moved, own)[0])
        sixty += bool(worse_channels(before, before + moved, white)[0])
        # ... and one that takes away three times the scatter is a gain.
        shown = gain(Predicted(before + 10 * moved, before + 10 * moved), Predicted(before, before), own)
        found += shown.is_gain and not shown.worse
    assert worse <= 3
    assert sixty > 150
    assert found >= 297


@pytest.mark.parametrize("runs", [1, 3])
def test_two_predictions_of_equal_fabrics_gain_nothing_over_each_other(runs: int) -> None:
    """Of 1000 recordings, each beside two predictions of the same fabric: at most one in twenty prefers one of them.

    Each prediction is the mean of so many runs, which scatter as the recording does. A size at which a law was
    simulated was told apart from another by that, though both moved the fabric alike.
    """
    rng = np.random.default_rng(17)
    times = np.arange(60) / 60
    root = np.linalg.cholesky(np.exp(-np.abs(times[:, None] - times) / MEMORY) + 1e-12 * np.eye(60))
    own = scattering(1.0)
    own = replace(own, channels=tuple(replace(c, scatter_runs=runs) for c in own.channels))
    totals, drawn, preferred, before = [], [], 0, 0
    size = 1.0 / math.sqrt(1.0 + 1.0 / runs)  # what is left of the recording has the deviation 1
    for _ in range(1000):
        sizes = (size, size / math.sqrt(runs), size / math.sqrt(runs))
        recorded, one, other = (s * (rng.standard_normal((12, 60)) @ root.T).ravel() for s in sizes)
        first, second = Predicted(recorded - one, recorded - one), Predicted(recorded - other, recorded - other)
        found = gain(first, second, own)
        totals.append(found.total)
        drawn.append(found.drawn)
        preferred += found.is_gain
        before += found.total > replace(found, drawn=0.0).needed
    assert np.std(totals) == pytest.approx(np.mean(drawn), rel=0.15)
    assert preferred <= 50
    assert before > 2 * preferred or runs > 1
    assert gain(first, second, scattering(0.0)).drawn == 0.0
    together = replace(own, channels=tuple(replace(c, scatter_together=4.0) for c in own.channels))
    assert gain(first, second, together).drawn == pytest.approx(2.0 * found.drawn)
