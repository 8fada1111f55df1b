"""Which readings judge what belongs to one recording, and faults that fill the gaps of a wrong model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.acceptance import Accepted, accept
from diagnosis.judge.of_a_day import STANDS_OUT, hidden_fault, is_shown_there_alone
from diagnosis.judge.unfitted import HeldOutReadings, left_out_readings, left_out_stretches
from diagnosis.models.protocol import Labelled
from diagnosis.recording.recording import Recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, Term, TermParameter
from diagnosis.search.search import Explanation, Outcome
from diagnosis.search.structure import Structure, structure
from tests.search.line_model import TIME, WAVE
from tests.verdict.lines import NOISE, Law, Lines

EDGES = tuple(TermParameter(n, "s", 0.0, 1.0, (), is_instant=True) for n in ("begin", "end"))
#: A sensor that reads too much from 0.4 s to 0.5 s.
FAULT = Term(
    "sensor_offset_in_interval",
    "signal",
    "measurement",
    (TermParameter("offset", "1", -10.0, 10.0, (0.1,)), *EDGES),
    recording=0,
    price=20.0,
)
LINE = 0.3 + 0.5 * TIME
BOX = ((TIME >= 0.4) & (TIME <= 0.5)).astype(float)


@dataclass(frozen=True)
class OfADay(Law):
    is_of_a_day: bool = True


class Faulty(Lines):
    """The line, whose sensor may be at fault for a while; `WAVE` belongs to a day where it is said so."""

    is_wave_of_a_day = False

    def signal(self, point: Point) -> Array:
        own = point.terms.get(FAULT)
        plain = point if own is None else point.without(FAULT)
        box = 0.0 if own is None else own[0] * ((own[1] <= TIME) & (own[2] >= TIME))
        return np.asarray(super().signal(plain) + box)

    def where(self, term: Term) -> tuple[Law, Labelled]:
        law, spot = super().where(term)
        is_of_a_day = term is FAULT or self.is_wave_of_a_day
        return (OfADay(law.name, law.law, {}), spot) if is_of_a_day else (law, spot)


class Blind(Faulty):
    """A held-out recording in which no wave can be."""

    def signal(self, point: Point) -> Array:
        return super().signal(Point(point.base))


def outcome_of(model: Faulty, *terms: tuple[Term, tuple[float, ...]]) -> Outcome:
    base = fit(model, Point(np.zeros(2)))
    point = base.point
    for term, values in terms:
        point = point.plus(term, values)
    best = Explanation(fit(model, point))
    left = structure(best.fit.residuals, model.layout)
    return Outcome(base, Structure(0.0, "", 0.0, 0.0), best, left, (best,), 20.0, 0.01, 1)


def judged(model: Faulty, judge: Faulty, outcome: Outcome, path) -> Accepted:
    held_out = HeldOutReadings(judge, model, [Recording(path, "held out", {}, (), {}, 1.0, 0.0)])
    return accept(
        model,
        outcome,
        held_out,
        left_out_stretches(model, ["training"]),
        lambda t: is_shown_there_alone(t, outcome.best.fit.point.terms[t], model, judge),
        lambda: left_out_readings(model, ["training"]),
    )


def test_a_fault_that_no_held_out_recording_shows_is_accepted_by_every_other_reading(tmp_path):
    model = Faulty(LINE + 0.5 * BOX, 1)
    outcome = outcome_of(model, (FAULT, (0.5, 0.4, 0.5)))
    found = judged(model, Faulty(LINE, 2), outcome, tmp_path)
    assert found.explanation.terms == (FAULT,)
    # 40 readings by five deviations each; Huber's loss of five deviations is less than their square
    assert found.gains[FAULT].total > 200.0


def test_a_box_that_fills_a_gap_of_a_wrong_model_is_a_suggestion_with_that_reason(tmp_path):
    """The wave is three deviations high and not in the model: a box on one of its crests gains, as on any other."""
    model = Faulty(LINE + 3.0 * NOISE * np.sin(25.0 * TIME), 1)
    crest = (TIME >= 0.30) & (TIME <= 0.34)
    outcome = outcome_of(model, (FAULT, (0.3, float(TIME[crest][0]), float(TIME[crest][-1]))))
    found = judged(model, Faulty(LINE, 2), outcome, tmp_path)
    assert found.gains[FAULT].total > 50.0
    assert found.explanation.terms == ()
    (reason,) = found.reasons[FAULT]
    assert reason.startswith("it does not stand out: it changes the readings of signal by 1.")
    assert reason.endswith(f"{STANDS_OUT:.0f} times would be needed")


@pytest.mark.parametrize(("offset", "stands_out"), [(2.5, False), (3.5, True)])
def test_a_fault_stands_out_from_three_times_what_is_left_outside_its_interval(offset, stands_out):
    """What is left is noise of one deviation, of 360 readings: 1 +- 0.04."""
    model = Faulty(LINE + offset * NOISE * BOX, 1)
    point = fit(model, Point(np.zeros(2), {FAULT: (offset * NOISE, 0.4, 0.5)})).point
    exact = replace(point, terms={FAULT: (offset * NOISE, 0.4, 0.5)})
    assert (hidden_fault(model, exact, FAULT) == "") is stands_out


def test_a_fault_that_lasts_for_the_whole_recording_says_so_and_names_the_remedy():
    """Gauge for absolute: a box over everything is no fault of a while, and nothing is outside to compare with."""
    model = Faulty(LINE + 5.0 * NOISE, 1)
    point = Point(np.zeros(2), {FAULT: (5.0 * NOISE, -0.1, 1.1)})
    reason = hidden_fault(model, point, FAULT)
    assert reason.startswith("it lasts for the whole recording")
    assert "`bias_bound`" in reason


def test_laws_are_not_asked_to_stand_out():
    model = Faulty(LINE, 1)
    assert hidden_fault(model, Point(np.zeros(2), {WAVE: (1e-6,)}), WAVE) == ""


def test_what_a_held_out_recording_can_show_is_judged_by_it():
    model = Faulty(LINE, 1)
    values: Sequence[float] = (0.1,)
    assert not is_shown_there_alone(WAVE, values, model, Blind(LINE, 2))  # no effect of a day
    model.is_wave_of_a_day = True
    assert is_shown_there_alone(WAVE, values, model, Blind(LINE, 2))
    assert not is_shown_there_alone(WAVE, values, model, Faulty(LINE, 2))  # the same on both days
    assert not is_shown_there_alone(WAVE, values, model, None)  # in all recordings: any stretch shows it
    assert is_shown_there_alone(FAULT, (0.5, 0.4, 0.5), model, Faulty(LINE, 2))
