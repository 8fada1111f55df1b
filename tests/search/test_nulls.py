"""Nulls: what chance gives, by straight lines and by refits."""

import numpy as np
import pytest

from diagnosis.search.explanation import Settings
from diagnosis.search.nulls import NullModel, calibrated, refitted
from diagnosis.search.problem import Point
from diagnosis.search.score import score
from diagnosis.search.search import recalibrate, search
from tests.search.line_model import BEND, COUNT, STEP, TERMS, TIME, LineModel

LINE = 0.3 + 0.5 * TIME


def test_a_null_is_the_recalibrated_model_with_fresh_noise():
    model = LineModel(LINE + 2.0 * TIME**2)
    base = recalibrate(model)
    noise = np.random.default_rng(4).standard_normal(COUNT)
    null = NullModel(model, base, noise)
    np.testing.assert_allclose(null.residuals([base.point])[0], noise, atol=1e-12)
    moved = Point(base.point.base + np.array([0.1, 0.0]))
    # an offset of 0.1 is one deviation of the noise
    np.testing.assert_allclose(null.residuals([moved])[0], noise - 1.0, atol=1e-9)


def test_what_is_not_used_stays_unused_in_a_null():
    model = LineModel(LINE)
    plain = model.residuals
    model.residuals = lambda points: np.where(TIME > 0.5, 0.0, plain(points))  # type: ignore[method-assign]
    base = recalibrate(model)
    null = NullModel(model, base, np.ones(COUNT))
    assert np.all(null.residuals([base.point])[0][TIME > 0.5] == 0.0)


def test_a_linear_term_gains_on_nulls_what_its_straight_line_promises():
    model = LineModel(LINE)
    base = recalibrate(model)
    scoring = score(model, base, [BEND], draws=24, seed=1)
    gains = refitted(model, base, scoring, Settings(nulls=24, seed=1))
    # The scoring draws the prior's noise too, the null does not: two parameters, hundreds of readings, a few per cent.
    np.testing.assert_allclose(gains, scoring.chance, rtol=0.1, atol=0.3)


def test_an_instant_gains_more_once_it_is_free_and_the_margin_follows():
    model = LineModel(LINE)
    base = recalibrate(model)
    scoring = score(model, base, [STEP], draws=40, seed=1)
    after, count = calibrated(model, base, scoring, Settings(nulls=20, seed=1))
    assert count == 20
    assert np.mean(after.chance) >= np.mean(scoring.chance)
    assert after.margin(0.05) >= scoring.margin(0.05)
    assert after.false_alarm_rate(15.0) >= scoring.false_alarm_rate(15.0)


def test_the_outcome_says_how_many_nulls_were_searched():
    assert search(LineModel(LINE + 2.0 * TIME**2, seed=3), TERMS, Settings(nulls=5)).nulls == 5
    assert search(LineModel(LINE, seed=3), TERMS, Settings(nulls=5)).nulls == 0  # nothing asked for acceptance


@pytest.mark.parametrize("level", [0.05, 0.2])
def test_a_margin_is_passed_by_as_many_nulls_as_it_says(level):
    model = LineModel(LINE)
    base = recalibrate(model)
    scoring = score(model, base, TERMS, draws=400, seed=2)
    assert np.mean(scoring.chance > scoring.margin(level)) == pytest.approx(level, abs=1.0 / 400)
