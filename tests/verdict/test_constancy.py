"""A law has one strength: closed form, laws that are right, and laws that bend to what is missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.constancy import CONSTANT, Constancy
from diagnosis.judge.diagnosis import Standing
from diagnosis.judge.findings import findings
from diagnosis.judge.unfitted import left_out_stretches, raw_residuals
from diagnosis.models.coil_network.runs import ZERO
from diagnosis.search.problem import Point, Term
from tests.search.line_model import BEND, LID, TIME
from tests.verdict.lines import Lines
from tests.verdict.test_parameter_error import LINE, SHORT, Seen, fitted, held_out, judged


def strength(training: Lines, judge: Lines, term: Term = BEND) -> Constancy | None:
    point = fitted(training, term).best.fit.point
    unfitted = held_out(judge, training)
    return unfitted.strengths(point, unfitted.predict(point)).get(term)


def test_the_strength_there_is_that_of_generalised_least_squares():
    """Offset and slope with the covariance of the training, the strength with none: y = J b + t^2 a."""
    training, judge = Lines(LINE + 4.0 * TIME**2, 1), Lines(LINE + 6.0 * TIME**2, 2)
    point = fitted(training, BEND).best.fit.point
    unfitted = held_out(judge, training)
    found = unfitted.strengths(point, unfitted.predict(point)).get(BEND)
    assert found is not None
    columns = np.column_stack([np.ones_like(TIME), TIME, TIME**2]) / training.noise
    sigma = np.linalg.inv(columns.T @ columns + np.diag([1.0, 1.0, 0.0]))
    held = columns[:, :2] @ sigma[:2, :2] @ columns[:, :2].T + np.eye(len(TIME)) + ZERO**2
    left, law = raw_residuals(judge, point), columns[:, 2]
    more = (law @ np.linalg.solve(held, left)) / (law @ np.linalg.solve(held, law))
    assert found.fitted == point.terms[BEND][0]
    assert found.there == pytest.approx(found.fitted + more, rel=1e-3)


def wave(seed: int) -> Array:
    """What a rig does besides: up to 0.3, with a period and a phase of its own in every recording."""
    rng = np.random.default_rng([seed, 7])
    return np.asarray(0.3 * np.sin(rng.uniform(15.0, 60.0) * TIME + rng.uniform(0.0, 2.0 * np.pi)))


def test_a_law_of_the_rig_keeps_its_strength_beside_what_is_missing():
    for seed in range(40):
        bend = LINE + 4.0 * TIME**2
        training, judge = Lines(bend + wave(seed), 2 * seed), Lines(bend + wave(seed + 1000), 2 * seed + 1)
        found = judged(training, held_out(judge, training), BEND)
        if found.agreement.is_rejected and BEND in found.explanation.terms:
            assert found.strengths[BEND].is_constant


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_a_law_of_another_strength_is_none_of_the_rig(share: float):
    for seed in range(10):
        training, judge = Lines(LINE + 4.0 * TIME**2, 2 * seed), Lines(LINE + 4.0 * share * TIME**2, 2 * seed + 1)
        found = strength(training, judge)
        assert found is not None
        assert not found.is_constant
        assert found.there == pytest.approx(4.0 * share, abs=3.3 * found.error)


def test_readings_that_hardly_show_a_law_say_nothing_against_it():
    """A tenth of the line shows a bend to 50 or so."""
    for seed in range(10):
        training, judge = Lines(LINE + 4.0 * TIME**2, 2 * seed), Seen(LINE + 4.0 * TIME**2, 2 * seed + 1, SHORT)
        found = strength(training, judge)
        assert found is not None
        assert found.error > CONSTANT * 4.0
        assert found.is_constant


def test_a_law_that_the_readings_do_not_show_at_all_is_as_it_was_fitted():
    """A draught of one day: no other recording changes with it, and its strength there is not known."""

    class Without(Lines):
        def signal(self, point: Point) -> Array:
            return super().signal(Point(point.base))

    found = strength(Lines(LINE + 4.0 * TIME**2, 1), Without(LINE + 1.0 * TIME**2, 2))
    assert found is not None
    assert found.there == found.fitted
    assert found.error == np.inf
    assert found.is_constant


def test_errors_of_a_model_that_last_widen_the_error_of_a_strength():
    """A wave of a fifth of the line looks like a bend in some recordings; the blocks say by how much."""
    far = 0
    for seed in range(60):
        bend = LINE + 0.5 * TIME**2
        training, judge = Lines(bend, 2 * seed), Lines(bend + wave(seed), 2 * seed + 1)
        found = strength(training, judge)
        assert found is not None
        far += not found.is_constant
    assert far <= 6


def test_the_name_goes_and_the_reason_says_both_strengths():
    training, judge = Lines(LINE + 4.0 * TIME**2, 1), Lines(LINE + 4.0 * TIME**2, 2)
    accepted = judged(training, held_out(judge, training), BEND)
    outcome = fitted(training, BEND)
    (named,) = findings(training, outcome, accepted, ["training"])
    assert named.standing is Standing.NAMED
    other = replace(accepted, strengths={BEND: Constancy(accepted.explanation.fit.point.terms[BEND][0], 6.0, 0.1)})
    (found,) = findings(training, outcome, other, ["training"])
    assert found.is_accepted
    assert found.standing is Standing.UNNAMED
    assert found.doubts == (
        f"a is {found.parameters[0].value:.3g} in the training recordings and would have to be 6.00 in the held-out "
        "recordings: a parameter of the rig is the same in all",
    )


def test_where_the_readings_are_met_nothing_is_asked():
    training, judge = Lines(LINE + 4.0 * TIME**2, 1), Lines(LINE + 4.0 * TIME**2, 2)
    accepted = judged(training, held_out(judge, training), BEND)
    assert not accepted.agreement.is_rejected
    assert not accepted.strengths


def test_stretches_of_the_training_and_switches_have_no_strength_of_their_own():
    training = Lines(LINE + 4.0 * TIME**2, 1)
    unfitted = left_out_stretches(training, ["training"])
    point = fitted(training, BEND).best.fit.point
    assert unfitted.strengths(point, unfitted.predict(point)).get(BEND) is None
    lid = Point(np.zeros(2), {LID: (1.0, 0.9)})
    held = held_out(training, training)
    assert held.strengths(lid, held.predict(lid)).get(LID) is None
