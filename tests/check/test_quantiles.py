"""Tails of laws of chance and the lag of a course against scipy.stats and scipy.signal."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import chi2, norm, poisson, t

from diagnosis.check.beside import lagged
from diagnosis.check.quantiles import (
    chi_square_beyond,
    chi_square_tail,
    normal_beyond,
    poisson_log,
    student_beyond,
    student_log_height,
)


@pytest.mark.parametrize("probability", [1e-9, 1e-4, 0.05, 0.5, 0.999])
@pytest.mark.parametrize("degrees", [1, 3.7, 400])
def test_values_that_are_exceeded(probability, degrees):
    assert chi_square_beyond(probability, degrees) == pytest.approx(chi2.isf(probability, degrees), rel=1e-12)
    assert student_beyond(probability, degrees) == pytest.approx(t.isf(probability, degrees), rel=1e-12)
    assert normal_beyond(probability) == pytest.approx(norm.isf(probability), rel=1e-12)
    assert chi_square_tail(2.0 * degrees, degrees) == pytest.approx(chi2.sf(2.0 * degrees, degrees), rel=1e-12)
    assert student_log_height(degrees) == pytest.approx(t.logpdf(0.0, degrees), rel=1e-12)


@pytest.mark.parametrize("mean", [0.3, 1, 12])
@pytest.mark.parametrize("count", [0, 1, 7])
def test_counts(count, mean):
    assert poisson_log(count, mean) == pytest.approx(poisson.logpmf(count, mean), rel=1e-12)


@pytest.mark.parametrize("lag", [0.01, 0.3, 300.0])
def test_a_course_behind_a_lag(lag):
    times, values = 0.1 * np.arange(500), np.random.default_rng(0).standard_normal(500).cumsum()
    keep = np.exp(-0.1 / lag)
    expected = lfilter([1.0 - keep], [1.0, -keep], values - values[0]) + values[0]
    np.testing.assert_allclose(lagged(times, values, lag), expected, atol=1e-12)
