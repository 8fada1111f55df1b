"""Predicted odds of an experiment, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnosis.experiment.separation import Bordered, distance, root, separation


def bordered(slopes: np.ndarray) -> Bordered:
    base, own = slopes[:, :1], slopes[:, 1:]
    return Bordered(base, base.T @ base, own)


def test_without_uncertain_parameters_the_distance_is_that_in_deviations() -> None:
    difference = np.array([3.0, 4.0])
    assert distance(difference, bordered(np.zeros((2, 2))), np.eye(2)) == pytest.approx(25.0)


def test_what_a_recalibration_would_do_as_well_does_not_count() -> None:
    difference = np.array([1.0, 2.0, 2.0])
    slopes = np.column_stack([difference / 3.0, [0.0, 1.0, -1.0]])
    # S^-1 along the direction of the difference shrinks it by 1 + P: 9 / (1 + 99) with a deviation of sqrt(99).
    spread = np.diag([math.sqrt(99.0), 5.0])
    assert distance(difference, bordered(slopes), spread) == pytest.approx(0.09, rel=1e-12)


def test_the_distance_is_that_of_the_whole_covariance_matrix() -> None:
    random = np.random.default_rng(0)
    slopes, some = random.standard_normal((40, 5)), random.standard_normal((5, 5))
    covariance, difference = some @ some.T, random.standard_normal(40)
    whole = difference @ np.linalg.solve(np.eye(40) + slopes @ covariance @ slopes.T, difference)
    assert distance(difference, bordered(slopes), root(covariance)) == pytest.approx(whole, rel=1e-9)


def test_even_odds_are_decided_as_often_as_a_normal_law_says() -> None:
    # ln of the Bayes factor is normal with mean 8 and deviation 4: beyond ln 20 in 89.5 % of cases.
    found = separation(16.0, 16.0, 0.0)
    assert found.log_bayes_factor == 8.0
    draws = 8.0 + 4.0 * np.random.default_rng(0).standard_normal(100_000)
    assert found.decides == pytest.approx(np.mean(draws > math.log(20.0)), abs=0.004)  # four deviations of the count


def test_the_less_favourable_truth_gives_the_expected_odds() -> None:
    assert separation(30.0, 4.0, 0.0).log_bayes_factor == 2.0
    assert separation(0.0, 0.0, 0.0).decides == 0.0
