"""What holds of every answer, over recordings that are drawn.

Laws are there, changed, or described by nothing. The whole way from the search to the verdict, on a model that is
simulated in microseconds; `test_every_kind.py` asks the same of coils, heaters, an arm and FMUs.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.special import chdtri

from cosim.unit.protocol import Array
from diagnosis.judge.acceptance import Accepted, accept
from diagnosis.judge.adequacy import adequacy, moved_day
from diagnosis.judge.diagnosis import Adequacy, Domain, Finding, Searched, Standing, Verdict
from diagnosis.judge.findings import findings
from diagnosis.judge.headline import headline, notes
from diagnosis.judge.recalibration import recalibration
from diagnosis.judge.unfitted import HeldOutReadings, left_out_stretches
from diagnosis.judge.verdict import verdict, why_open
from diagnosis.model_error import search_with_model_error
from diagnosis.recording.recording import Recording
from diagnosis.search.explanation import Settings
from diagnosis.search.search import Outcome
from tests.search.line_model import TIME
from tests.verdict.lines import Lines

TRIED = Searched((Domain("thermal", 2, 1, 1), Domain("electrical", 1, 0, 1), Domain("measurement", 1, 0, 1)))
QUICK = Settings(nulls=1, most_terms=2)


@dataclass(frozen=True)
class Answer:
    word: Verdict
    statement: str
    below: tuple[str, ...]
    found: tuple[Finding, ...]
    right: Adequacy
    accepted: Accepted
    outcome: Outcome
    judge: Lines


def answer(training: Lines, judge: Lines | None, tried: Searched = TRIED) -> Answer:
    outcome, model = search_with_model_error(training, QUICK)
    fitted = left_out_stretches(model, ["training"])
    held_out = [Recording(Path("tuesday"), "tuesday", {}, (), {}, 1.0, 0.0)]
    unfitted = fitted if judge is None else HeldOutReadings(judge, model, held_out)
    accepted = accept(model, outcome, unfitted, fitted, lambda term: False)
    found = findings(model, outcome, accepted, ["training"])
    day = () if judge is None else moved_day(accepted.after, judge.parameters)
    right = adequacy(accepted, unfitted.readings, day)
    word = verdict(outcome, found, right, tried, recalibration(model, outcome.base))
    reasons = why_open(outcome, found, right, tried)
    told, below = headline(word, found, right, reasons), notes(word, found, right, reasons)
    return Answer(word, told, below, found, right, accepted, outcome, judge or training)


@st.composite
def truths(draw: st.DrawFn) -> tuple[Array, Array]:
    """Training and held-out signal: a line, a bend, a wave, a jump, and something that no law describes."""
    line = draw(st.floats(-1.0, 1.0)) + draw(st.floats(-1.0, 1.0)) * TIME
    size = st.sampled_from((0.0, 0.0, 0.03, 0.3, 2.0))
    bend, wave, jump, strange = (draw(size) for _ in range(4))
    common = line + bend * TIME**2 + wave * np.sin(25.0 * TIME) + jump * (draw(st.floats(0.2, 0.8)) < TIME)
    common = common + strange * np.abs(np.sin(7.0 * TIME)) ** 0.3
    of_training, of_judge = (draw(size) for _ in range(2))
    return common + of_training * np.cos(11.0 * TIME), common + of_judge * np.sqrt(TIME)


LIKE = settings(max_examples=25, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])


@LIKE
@given(truths(), st.integers(0, 999), st.booleans())
def test_every_answer_keeps_what_it_says(signals: tuple[Array, Array], seed: int, has_judge: bool) -> None:
    training = Lines(signals[0], seed)
    judge = Lines(signals[1], seed + 1000) if has_judge else None
    told = answer(training, judge)
    _agrees_only_within_the_noise(told)
    _nothing_accepted_makes_readings_worse(told)
    _the_headline_is_the_most_probable(told)
    _a_name_is_identified(told)
    if told.right.is_rejected:
        whole = " ".join([told.statement, *told.below])
        assert "reject" in whole or "is missing or wrong" in whole or "worse" in whole
    if told.word is Verdict.CANNOT_TELL:
        assert told.statement.startswith("It cannot be told")
    if told.word is Verdict.MEASUREMENT_FAULT:
        assert any(f.is_accepted and f.standing is not Standing.UNNAMED for f in told.found)


def _agrees_only_within_the_noise(told: Answer) -> None:
    residuals = told.accepted.after.residuals
    limit = chdtri(len(residuals), 0.001)
    if told.word in (Verdict.CONSISTENT, Verdict.RECALIBRATED):
        # The zero of a channel is known to 0.15 of its noise: it takes a little of the sum away.
        assert residuals @ residuals - residuals.sum() ** 2 * 0.15**2 / (1 + 0.15**2 * len(residuals)) <= limit
        assert "agrees" in told.statement
    else:
        assert "agrees" not in told.statement


def _nothing_accepted_makes_readings_worse(told: Answer) -> None:
    """Against the recalibrated model, by more than twice the noise of the difference and a twentieth of its size."""
    before, after = told.accepted.recalibrated.residuals, told.accepted.after.residuals
    if any(f.is_accepted for f in told.found):
        rise = float(np.sum(np.minimum(after**2, 1e6)) - np.sum(np.minimum(before**2, 1e6)))
        assert rise <= 0.0 or np.sqrt(np.mean(after**2)) < 1.1 * np.sqrt(np.mean(before**2))


def _the_headline_is_the_most_probable(told: Answer) -> None:
    for finding in told.found:
        if finding.alternatives:
            assert finding.probability >= max(a.probability for a in finding.alternatives) - 1e-9


def _a_name_is_identified(told: Answer) -> None:
    for finding in told.found:
        if finding.standing is Standing.NAMED and finding.effect != "lid":  # which is there or not
            strength = finding.parameters[0]
            assert not strength.lower <= 0.0 <= strength.upper
            assert abs(strength.value) < 10.0 * (1.0 - 1e-9)  # its bounds
            assert not finding.ambiguous_with


def test_where_no_law_of_physics_was_tried_nothing_can_be_told() -> None:
    line = 0.3 + 0.5 * TIME
    tried = Searched((Domain("measurement", 5, 0, 2),), ("`plant` (fmu) offers no place for a law",))
    told = answer(Lines(line, 1), Lines(line, 2), tried)
    assert told.word is Verdict.CANNOT_TELL
    assert "no law of physics was tried: `plant` (fmu) offers no place for a law" in told.statement


def test_a_null_agrees_and_says_by_which_noise() -> None:
    told = answer(Lines(0.0 * TIME, 1), Lines(0.0 * TIME, 2))
    assert told.word is Verdict.CONSISTENT
    within = "The model as it is agrees with the held-out recordings within"
    assert told.statement == f"{within} the stated noise of the sensors."
    estimated = answer(Lines(0.0 * TIME, 1, is_given=False), Lines(0.0 * TIME, 2, is_given=False))
    assert estimated.statement == f"{within} the scatter of neighbouring readings (no noise was stated)."


def test_what_stays_is_told_in_the_unit_of_the_channel_and_in_multiples_of_its_noise() -> None:
    strange = 0.3 + 0.5 * TIME + 0.5 * np.abs(np.sin(40.0 * TIME))
    told = answer(Lines(strange, 1), Lines(strange, 2))
    worst = told.right.worst
    assert worst is not None
    assert worst.rmse / worst.noise > 1.5
    assert f"{worst.rmse / worst.noise:.1f} times the noise" in told.statement
