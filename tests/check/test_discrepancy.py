"""Likelihoods of sets of columns: one that runs away explains nothing, and says so without a warning."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.check.discrepancy import likelihoods, thin


@pytest.mark.filterwarnings("error")
def test_a_course_that_runs_away_is_never_the_best_and_leaves_the_others_as_they_are() -> None:
    rng = np.random.default_rng(2)
    times = np.linspace(0.0, 10.0, 400)
    wave = np.sin(2.0 * times)
    at = thin(times, 3.0 * wave + 0.1 * rng.standard_normal(400))
    fits = np.stack([np.stack([wave, np.ones(400)]), np.stack([np.cos(9.0 * times), np.ones(400)])])
    away = np.stack([np.geomspace(1.0, 1e200, 400), np.ones(400)])[None]
    alone = likelihoods(at, fits, 1, 0.1)
    every = likelihoods(at, np.concatenate([fits, away]), 1, 0.1)
    np.testing.assert_array_equal(every.deviance[:2], alone.deviance)
    assert int(np.argmin(every.deviance)) == 0
    assert every.deviance[2] == np.inf
