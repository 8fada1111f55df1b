"""Only what gains on readings that it was not fitted to is accepted; each refusal is met once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge import acceptance
from diagnosis.judge.acceptance import Accepted, accept
from diagnosis.judge.diagnosis import Standing
from diagnosis.judge.findings import _widened, findings
from diagnosis.judge.unfitted import HeldOutReadings, left_out_stretches
from diagnosis.recording.recording import Recording
from diagnosis.search.explanation import Settings
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from diagnosis.search.search import Explanation, Outcome, search, shrink
from diagnosis.search.structure import Structure, structure
from tests.search.line_model import BEND, STEP, TERMS, TIME, WAVE
from tests.verdict.lines import Lines, renamed

QUICK = Settings(nulls=2)


def recording(path, title="held out"):
    return Recording(path, title, {}, (), {}, 1.0, 0.0)


def judged(training: Lines, judge: Lines | None, path, outcome: Outcome | None = None) -> tuple[Outcome, Accepted]:
    found = outcome or search(training, list(TERMS), QUICK)
    fitted = left_out_stretches(training, ["training"])
    unfitted = fitted if judge is None else HeldOutReadings(judge, training, [recording(path)])
    return found, accept(training, found, unfitted, fitted, lambda term: False)


def forced(model: Lines, *terms) -> Outcome:
    """An outcome with given terms, whatever a search would find."""
    base = fit(model, Point(np.zeros(2)))
    point = base.point
    for term in terms:
        point = point.plus(term, tuple(0.5 if p.is_instant else p.starts[0] for p in term.parameters))
    best = Explanation(fit(model, point))
    quiet = Structure(0.0, "", 0.0, 0.0)
    return Outcome(base, quiet, best, structure(best.fit.residuals, model.layout), (best,), 20.0, 0.01, 1)


def test_an_effect_that_is_there_is_accepted_and_its_gain_is_that_of_its_square(tmp_path):
    truth = 0.3 + 0.5 * TIME + 0.1 * np.sin(25.0 * TIME)
    outcome, found = judged(Lines(truth, 1), Lines(truth, 2), tmp_path)
    assert [t.identifier for t in found.explanation.terms] == ["wave"]
    # sum (0.1 sin)^2 / 0.1^2 over 400 readings: 200, less what the line takes up
    assert found.gains[WAVE].total == pytest.approx(195.0, abs=60.0)
    assert not found.agreement.is_rejected
    assert findings(Lines(truth, 1), outcome, found, ["training"])[0].is_accepted


def test_an_effect_of_the_training_alone_is_refused_because_it_predicts_worse(tmp_path):
    line = 0.3 + 0.5 * TIME
    model = Lines(line + 0.1 * np.sin(25.0 * TIME), 1)
    _, found = judged(model, Lines(line, 2), tmp_path, forced(model, WAVE))
    assert found.explanation.terms == ()
    assert found.reasons[WAVE][0].startswith("it predicts the readings that judge (held-out recordings) worse")
    assert found.headline.terms == (WAVE,)


def test_an_effect_that_predicts_neither_better_nor_worse_beyond_chance_is_refused(tmp_path):
    """Both the line fitted to a bend and the bend itself miss a held-out line by about as much."""
    model = Lines(0.3 + 0.5 * TIME + 0.4 * TIME**2, 1)
    _, found = judged(model, Lines(0.3 + 0.5 * TIME, 2), tmp_path, forced(model, BEND))
    assert found.explanation.terms == ()
    assert "does not predict the readings" in found.reasons[BEND][0]


def test_an_effect_that_held_out_readings_do_not_show_is_refused_for_that(tmp_path):
    """A wave that hardly moves the line, on a day whose model has none of it."""

    class Blind(Lines):
        def signal(self, point):
            return super().signal(Point(np.array([0.3, 0.5])))

    line = 0.3 + 0.5 * TIME
    model = Lines(line + 0.04 * np.sin(25.0 * TIME), 1)
    _, found = judged(model, Blind(line, 2), tmp_path, forced(model, WAVE))
    assert found.explanation.terms == ()
    assert "do not show it" in found.reasons[WAVE][0]


def test_an_effect_too_small_for_the_readings_that_judge_is_refused_with_what_would_be_needed(tmp_path):
    truth = 0.3 + 0.5 * TIME + 0.05 * np.sin(25.0 * TIME)
    weak = Lines(truth, 3)
    noisy = Lines(truth, 4, noise=0.5)
    noisy.measured = truth + 0.5 * np.random.default_rng(5).standard_normal(len(TIME))
    _, found = judged(weak, noisy, tmp_path, forced(weak, WAVE))
    assert found.explanation.terms == ()
    assert "would be needed" in found.reasons[WAVE][0]


def test_a_gain_that_only_relieves_priors_is_told_so(tmp_path):
    """A straight line is met as well without a bend."""
    truth = 0.3 + 0.5 * TIME
    model = Lines(truth, 1)
    _, found = judged(model, Lines(truth, 2), tmp_path, forced(model, BEND))
    assert "only the priors support it" in found.reasons[BEND][0]


def test_of_two_effects_the_spurious_one_goes_and_the_true_one_stays(tmp_path):
    truth = 0.3 + 0.5 * TIME + 0.1 * np.sin(25.0 * TIME)
    # An extra bend of the training day alone.
    model, judge = Lines(truth + 0.08 * TIME**2, 1), Lines(truth, 2)
    _, found = judged(model, judge, tmp_path, forced(model, WAVE, BEND))
    assert set(found.reasons) == {BEND}
    assert found.explanation.terms == (WAVE,)


def test_a_room_within_its_prior_is_estimated_and_one_far_beyond_it_is_not(tmp_path):
    """The held-out day's offset has a prior of deviation 1: 0.8 is taken up, 12 stays and rejects the model."""
    truth = 0.5 * TIME
    for offset, is_rejected in ((0.8, False), (12.0, True)):
        training = renamed(Lines(truth, 1), "offset of recording 1")
        judge = renamed(Lines(truth + offset, 2), "offset of recording 1")
        _, found = judged(training, judge, tmp_path)
        assert found.agreement.is_rejected is is_rejected
        assert abs(found.after.day["offset of recording 1"][0]) <= 3.0
        if not is_rejected:
            assert found.after.day["offset of recording 1"][0] == pytest.approx(0.8, abs=0.05)
        assert np.mean(found.after.plain**2) > 10.0


def test_without_held_out_readings_stretches_of_the_training_judge(tmp_path):
    truth = 0.3 + 0.5 * TIME + 0.1 * np.sin(25.0 * TIME)
    _, found = judged(Lines(truth, 1), None, tmp_path)
    assert [t.identifier for t in found.explanation.terms] == ["wave"]
    assert "left out" in found.basis


def test_the_most_probable_explanation_stands_first_though_another_was_handed_over(tmp_path):
    truth = 0.3 + 0.5 * TIME + 0.1 * np.sin(25.0 * TIME)
    model = Lines(truth, 1)
    right, wrong = forced(model, WAVE).best, forced(model, BEND)
    outcome = Outcome(wrong.base, wrong.base_structure, wrong.best, wrong.left, (wrong.best, right), 20.0, 0.01, 2)
    _, found = judged(model, Lines(truth, 2), tmp_path, outcome)
    assert found.headline.terms == (WAVE,)
    (finding,) = findings(model, outcome, found, ["training"])
    assert finding.effect == "wave"
    assert finding.probability == max(a.probability for a in finding.alternatives)
    assert finding.standing is Standing.UNNAMED  # it has no name in the catalogue


def test_a_recalibration_that_predicts_worse_is_known_as_such(tmp_path):
    _, found = judged(Lines(3.0 + 0.5 * TIME, 1), Lines(0.0 * TIME, 2), tmp_path)
    assert found.recalibration.is_loss


def test_an_effect_with_which_the_simulation_stops_is_refused_for_that(tmp_path):
    """A run that stops gives no values; how much worse such readings are predicted is no number."""

    class Stops(Lines):
        def predict(self, point, run):
            return [np.full(len(TIME), np.inf)] if WAVE in point.terms else super().predict(point, run)

    line = 0.3 + 0.5 * TIME
    model = Lines(line + 0.1 * np.sin(25.0 * TIME), 1)
    _, found = judged(model, Stops(line, 2), tmp_path, forced(model, WAVE))
    assert found.explanation.terms == ()
    assert found.reasons[WAVE][0] == (
        "with it the simulation stops or runs away before the end of the readings that judge (held-out recordings)"
    )


def test_where_the_last_terms_go_together_the_recalibrated_model_is_left(tmp_path):
    """What remains without the refused term is not needed either: no other fit than the recalibrated one stays."""
    line = 0.3 + 0.5 * TIME
    model = Lines(line + 0.1 * np.sin(25.0 * TIME), 1)
    outcome, found = judged(model, Lines(line, 2), tmp_path, forced(model, WAVE, BEND))
    assert found.explanation.terms == ()
    assert found.explanation.fit is outcome.base
    assert found.after is found.recalibrated


def test_what_two_explanations_share_does_not_decide_between_them(tmp_path):
    """Two waves of 90 deviations, one a hair late: 10 worse in training, 10 worse held out, beside a gain of 180,000.

    The factor by which errors that are alike for a while make readings count less is that of what the two differ by.
    Divided each by a factor of its own, the common gain moved their order by hundreds.
    """
    late = replace(WAVE, identifier="late wave")

    class Waves(Lines):
        def terms(self):
            return [*TERMS, late]

        def signal(self, point):
            found = super().signal(Point(point.base, {t: v for t, v in point.terms.items() if t != late}))
            return found + point.terms.get(late, (0.0,))[0] * np.sin(25.0 * TIME + 0.0025)

    truth = 0.3 + 0.5 * TIME + 9.0 * np.sin(25.0 * TIME) + 0.03 * np.sin(12.0 * TIME)
    for seed in range(12):
        model, judge = Waves(truth, 2 * seed), Waves(truth, 2 * seed + 1)
        right, wrong = forced(model, WAVE), forced(model, late)
        assert abs(wrong.best.demerit - right.best.demerit) < 30.0
        for first in (right, wrong):
            outcome = replace(first, rivals=tuple(sorted((right.best, wrong.best), key=lambda e: e.demerit)))
            _, found = judged(model, judge, tmp_path, outcome)
            assert found.headline.terms == (WAVE,)
            assert min(total for _, total in found.rivals) == found.rivals[0][1]


def test_numbers_that_depend_on_a_law_that_is_not_identified_have_an_interval_that_holds_both(tmp_path):
    """A jump takes a part of what a bend explains: how large the bend is depends on whether the jump is there."""
    truth = 0.3 + 0.5 * TIME + 2.0 * TIME**2 + 0.8 * (TIME > 0.3)
    model = Lines(truth, 1)
    outcome, found = judged(model, Lines(truth, 2), tmp_path, forced(model, BEND, STEP))
    assert set(found.explanation.terms) == set(found.without) == {BEND, STEP}
    every = {f.effect: f for f in findings(model, outcome, found, ["training"])}
    bend = every["bend"]
    gain = replace(every["jump"], unit="measurement", standing=Standing.UNNAMED, is_named=False)
    told = _widened(model, outcome, found, BEND, bend, [(BEND, bend), (STEP, gain)])
    without = found.without[STEP].point.terms[BEND][0]
    assert not bend.parameters[0].lower <= without <= bend.parameters[0].upper
    assert told.parameters[0].lower <= without <= told.parameters[0].upper
    assert told.doubts[-1].startswith("its numbers depend on")
    assert _widened(model, outcome, found, BEND, bend, [(BEND, bend), (STEP, every["jump"])]) == bend  # of the rig


def test_fits_without_each_term_are_those_of_the_search(tmp_path, monkeypatch):
    truth = 0.3 + 0.5 * TIME + 0.1 * np.sin(25.0 * TIME) + 0.3 * TIME**2
    model = Lines(truth, 1)
    outcome = forced(model, WAVE, BEND)
    searched = replace(outcome, best=shrink(model, outcome.best, 1.0))
    assert set(searched.best.without) == {WAVE, BEND}
    _, anew = judged(model, Lines(truth, 2), tmp_path, outcome)
    monkeypatch.setattr(acceptance, "fit", lambda *given, **named: pytest.fail("it was fitted already"))
    _, found = judged(model, Lines(truth, 2), tmp_path, searched)
    assert set(found.explanation.terms) == {WAVE, BEND}
    for term in (WAVE, BEND):
        assert found.gains[term].total == pytest.approx(anew.gains[term].total, rel=1e-6)
