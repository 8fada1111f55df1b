"""The largest of many, beside SciPy's law and its own draws."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import gumbel_r

from diagnosis.search.extreme import Gumbel


def test_it_is_the_law_of_scipy_with_the_moments_of_the_draws() -> None:
    draws = np.random.default_rng(3).normal(size=(400, 60)).max(axis=1)
    law = Gumbel.of(draws)
    assert law.place + np.euler_gamma * law.scale == pytest.approx(draws.mean())
    known = gumbel_r(law.place, law.scale)
    assert known.std() == pytest.approx(draws.std())
    for value in (1.5, 2.5, 4.0):
        assert law.exceeded(value) == pytest.approx(known.sf(value), rel=1e-12)
    assert law.quantile(0.01) == pytest.approx(known.isf(0.01), rel=1e-12)
    assert law.exceeded(law.quantile(0.05)) == pytest.approx(0.05)


def test_far_below_every_draw_it_is_certain_and_far_above_not_zero() -> None:
    law = Gumbel(2.0, 0.3)
    assert law.exceeded(-1e6) == 1.0
    assert 0.0 < law.exceeded(30.0) < 1e-35
