"""Laws that run away and models that stop: the search goes on without a warning (warnings are errors here)."""

import numpy as np
import pytest

from diagnosis.judge.held_out import root_mean_square
from diagnosis.models.coil_network.free import Free, FreeSet
from diagnosis.search.explanation import Settings
from diagnosis.search.fit import fit
from diagnosis.search.posterior import cost
from diagnosis.search.problem import Parameter, Point, Term, TermParameter
from diagnosis.search.score import Scoring, score
from diagnosis.search.search import recalibrate, search
from diagnosis.search.switches import costs_at
from diagnosis.search.validation import Validation
from tests.search.line_model import BEND, COUNT, TERMS, TIME, LineModel

SIZES = (0.1, -0.1, 5.0)
BURST = Term("burst", "all", "thermal", (TermParameter("a", "1", -10.0, 10.0, SIZES),))
STOP = Term("stop", "all", "thermal", (TermParameter("a", "1", -10.0, 10.0, SIZES),))
EDGE = Term("edge", "all", "thermal", (TermParameter("a", "1", -10.0, 10.0, SIZES),))


class Explosive(LineModel):
    """A line with laws that grow to 1e200 deviations (burst), stop the simulation (stop), or both by turns (edge)."""

    def residuals(self, points):
        """See `diagnosis.search.problem.Model`."""
        found = super().residuals(points)
        for row, point in zip(found, points):
            a = {t.identifier: v[0] for t, v in point.terms.items()}
            row += 1e200 * a.get("burst", 0.0) * TIME
            if a.get("stop"):
                row[:] = np.inf
            if abs(a.get("edge", 0.0)) > 0.05:
                row[COUNT // 2 :] = np.nan
        return found

    def slopes(self, point, tasks):
        """See `diagnosis.search.problem.strength_slopes`."""
        start = self.residuals([point])[0]
        there = self.residuals([point.plus(term, values) for term, values in tasks])
        return (there - start) / np.array([values[0] for _, values in tasks])[:, None]


MODEL = Explosive(0.3 + 0.5 * TIME + 2.0 * TIME**2, seed=2)
EVERY = (*TERMS, BURST, STOP, EDGE)


def test_the_search_goes_past_laws_that_run_away_to_the_one_that_holds():
    outcome = search(MODEL, EVERY, Settings())
    assert outcome.best.terms == (BEND,)
    assert np.isfinite(outcome.best.cost)


def test_a_law_that_runs_away_scores_nothing_and_the_others_as_without_it():
    base = recalibrate(MODEL)
    with_them, without = score(MODEL, base, EVERY), score(MODEL, base, TERMS)
    assert [s.term for s in with_them.ranked] == [s.term for s in without.ranked]
    assert with_them.margin(0.05) == without.margin(0.05)


def test_residuals_without_end_cost_by_their_size():
    assert cost(np.array([1e200, 3.0, 0.0]), np.zeros(1)) == 8e200
    assert cost(np.array([3.0, 5.0]), np.ones(2)) == 9.0 + 24.0 + 2.0
    base = recalibrate(MODEL)
    far, stopped = costs_at(MODEL, base, [base.point.plus(BURST, (5.0,)), base.point.plus(STOP, (1.0,))])
    assert far > 1e3
    assert stopped == np.inf


def test_a_fit_that_starts_where_nothing_can_be_simulated_says_that_it_is_bad():
    found = fit(MODEL, Point(np.zeros(2), {STOP: (1.0,)}), iterations=3)
    assert np.isfinite(found.cost)
    assert found.cost > 1e6


def test_explanations_that_run_away_in_a_stretch_predict_badly_and_finitely():
    validation = Validation(MODEL, lambda seen: MODEL)
    base = recalibrate(MODEL)
    best = search(MODEL, TERMS, Settings()).best
    run_away = type(best)(fit(MODEL, base.point.plus(BURST, (5.0,)), iterations=1))
    chosen = validation.select(type(best)(base), [best, run_away])
    assert chosen[0].terms == (BEND,)
    assert all(np.isfinite(f.losses).all() for f in validation.all)


def test_a_gain_far_below_those_by_chance_is_a_false_alarm_for_sure():
    scoring = Scoring([], 10, 1e4 + np.linspace(0.0, 1e-3, 50))
    assert scoring.false_alarm_rate(0.0) == 1.0
    assert 0.0 <= scoring.false_alarm_rate(2e4) < 1e-6


def test_a_number_grows_by_no_more_than_the_largest_factor():
    free = Free("capacity", np.ones(2), Parameter("capacity", "1", 1.0, 300.0))
    base = {"capacity": np.ones(2)}
    FreeSet([free], 0).vary(base, np.array([6.0]))
    assert np.asarray(base["capacity"]) == pytest.approx(np.full(2, np.exp(100.0)))
    assert free.parameter.value(6.0) == pytest.approx(np.exp(100.0))


@pytest.mark.parametrize("values", [np.array([1e200, -1e200]), np.array([np.inf, 1.0])])
def test_the_root_mean_square_of_what_runs_away_is_as_large_as_it_is(values):
    assert root_mean_square(values) == np.abs(values).max()
