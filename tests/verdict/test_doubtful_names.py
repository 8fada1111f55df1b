"""Names that odds alone would give: laws of another form, laws that cancel, laws that drag a parameter along."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.diagnosis import Standing
from diagnosis.judge.findings import findings
from diagnosis.judge.form import DIRECTIONS, EXPLAINED, companions, share_at_place
from diagnosis.judge.opposing import opposed
from diagnosis.judge.strain import strained
from diagnosis.search.fit import fit
from diagnosis.search.problem import Parameter, Point
from tests.search.line_model import BEND, STEP, TIME, WAVE
from tests.verdict.lines import Lines
from tests.verdict.test_parameter_error import LINE, fitted, held_out, judged


def with_bend(truth: np.ndarray, seed: int = 1) -> tuple[Lines, object]:
    model = Lines(truth, seed)
    return model, fit(model, Point(np.zeros(2), {BEND: (0.1,)}))


def test_what_a_law_leaves_is_explained_by_another_at_its_place():
    """Of a bend and a wave, the wave is all that a bend leaves."""
    model, found = with_bend(LINE + 4.0 * TIME**2 + np.sin(25.0 * TIME))
    assert share_at_place(model, found, [WAVE]) > 0.9


def test_what_comes_from_elsewhere_is_not_explained_at_the_place():
    """A jump in the middle has little of a wave of period 0.25."""
    model, found = with_bend(LINE + 4.0 * TIME**2 + 1.0 * (TIME > 0.5))
    assert share_at_place(model, found, [WAVE]) < 0.2


def test_noise_alone_is_explained_by_nothing():
    model, found = with_bend(LINE + 4.0 * TIME**2)
    assert share_at_place(model, found, [WAVE]) < EXPLAINED or DIRECTIONS > 3
    assert share_at_place(model, found, []) == 0.0


def test_companions_are_other_laws_of_the_same_place_and_unit():
    model, _ = with_bend(LINE)
    assert companions(model, BEND) == [WAVE]  # a jump has an instant, a lid is a sensor's


def test_laws_that_cancel_are_told_and_others_are_not():
    """t^2 and sin(25 t) do not cancel; a jump at the begin and the offset that undoes it do."""
    model = Lines(LINE, 1)
    apart = Point(np.zeros(2), {BEND: (4.0,), WAVE: (1.0,)})
    assert opposed(model, apart, [BEND, WAVE]) == {}
    against = Point(np.zeros(2), {BEND: (4.0,), STEP: (-3.0, 0.6)})
    assert opposed(model, against, [BEND, STEP]) == {BEND: STEP, STEP: BEND}
    assert opposed(model, Point(np.zeros(2), {BEND: (4.0,)}), [BEND]) == {}


def test_a_parameter_that_a_law_drags_along_is_told_by_its_distance():
    """Two parameters: odds of 20 to 1 that either is within 2.24 deviations (Bonferroni)."""
    parameters = [Parameter("a", "1", 1.0, 0.1), Parameter("b", "1", 1.0, 0.1)]
    _, found = with_bend(LINE)
    before = replace(found, point=Point(np.array([0.0, 0.0])))
    for z, is_far in ((2.2, False), (2.3, True), (-2.3, True)):
        after = replace(found, point=Point(np.array([0.0, z])))
        assert bool(strained(parameters, before, after)) == is_far
        there = replace(found, point=Point(np.array([0.0, 1.1 * z])))
        assert strained(parameters, there, after) == []  # recalibration alone moves it as far


def accepted_bend() -> tuple[Lines, object, Accepted]:
    training, judge = Lines(LINE + 4.0 * TIME**2, 1), Lines(LINE + 4.0 * TIME**2, 2)
    return training, fitted(training, BEND), judged(training, held_out(judge, training), BEND)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"forms": {BEND: 0.8}}, "would explain 80 % of what it leaves in training"),
        ({"opposed": {BEND: WAVE}}, "act against each other"),
    ],
)
def test_each_takes_the_name_and_says_why(changes, said):
    training, outcome, accepted = accepted_bend()
    (plain,) = findings(training, outcome, accepted, ["first"])
    assert plain.standing is Standing.NAMED
    (found,) = findings(training, outcome, replace(accepted, **changes), ["first"])
    assert found.standing is Standing.UNNAMED
    assert any(said in d for d in found.doubts)


def test_a_dragged_parameter_takes_the_name_and_is_called_by_its_name():
    training, outcome, accepted = accepted_bend()
    explanation = accepted.explanation
    base = np.array([0.0, -9.0])
    moved = replace(explanation.fit, point=Point(base, explanation.fit.point.terms))
    (found,) = findings(training, outcome, replace(accepted, explanation=replace(explanation, fit=moved)), ["first"])
    assert found.standing is Standing.UNNAMED
    assert any("slope is 9.0 prior deviations below the stated value" in d for d in found.doubts)
