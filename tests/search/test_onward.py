"""What a search goes on from, and an instant at which a fit was stuck."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.search.explanation import Explanation
from diagnosis.search.fit import fit
from diagnosis.search.grow import LATE, _with_instants_set
from diagnosis.search.problem import Point
from diagnosis.search.search import NAMED, _gone_on_from, recalibrate
from tests.search.line_model import BEND, STEP, TIME, WAVE, LineModel

BASE = recalibrate(LineModel(0.3 + 0.5 * TIME))


def explanation(cost, *terms):
    """One with terms, of a given -2 log posterior."""
    values = {t: (0.1,) * len(t.parameters) for t in terms}
    return Explanation(replace(BASE, point=Point(BASE.point.base, values), cost=cost))


def test_names_that_come_near_are_gone_on_from_beside_a_law_without_one():
    best, second, bent = explanation(100.0, WAVE), explanation(101.0, WAVE, STEP), explanation(150.0, BEND)
    kept, named = _gone_on_from([best, second, bent], 2, before=1000.0)
    assert [e.fit.cost for e in kept] == [100.0, 101.0, 150.0]
    assert named is bent
    far = explanation(1000.0 - NAMED * 880.0, BEND)
    assert _gone_on_from([best, second, far], 2, before=1000.0) == ([best, second], None)


def test_where_the_best_has_names_no_other_is_added():
    kept, named = _gone_on_from([explanation(100.0, BEND), explanation(110.0, WAVE)], 1, before=1000.0)
    assert len(kept) == 1
    assert named is None


def test_a_fit_that_is_stuck_beside_its_instant_is_set_free():
    model = LineModel(0.3 + 0.5 * TIME + 8.0 * (TIME > 0.8))
    stuck = fit(model, Point(np.zeros(2), {STEP: (6.0, 0.4)}), iterations=2)
    assert abs(stuck.point.terms[STEP][1] - 0.8) > 0.05
    found = _with_instants_set(model, stuck)
    size, instant = found.point.terms[STEP]
    assert instant == pytest.approx(0.8, abs=0.01)
    assert size == pytest.approx(8.0, abs=0.3)  # the prior of the slope pulls a little
    assert min(abs(late - 0.4) for late in LATE) <= 0.1  # what it leaps over


def test_a_fit_without_instants_is_left_alone():
    model = LineModel(0.3 + 0.5 * TIME**2)
    found = fit(model, Point(np.zeros(2), {BEND: (0.1,)}))
    assert _with_instants_set(model, found) is found
