"""Answers say no more than readings show: against residuals that are drawn here, and recordings that are made here."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from diagnosis.candidates.registry import catalogue
from diagnosis.judge.agreement import agreement
from diagnosis.judge.diagnosis import Doubt, Estimate, Standing, Verdict
from diagnosis.judge.doubts import doubted
from diagnosis.judge.events import between_samples
from diagnosis.judge.findings import _is_beside_unnamed, _is_of_either, findings
from diagnosis.judge.headline import headline, how_right, notes
from diagnosis.judge.verdict import _rejections, is_stopgap, verdict, why_open
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.report.sentences import doubt_text, improvement, structure, sureness
from diagnosis.report.undecided import what_decides
from diagnosis.search.problem import Own, Parameter, Point, Term, TermParameter
from diagnosis.search.shares import own_label, titled
from tests.diagnosis.report_examples import ADEQUACY, CONTACT, DOUBT, LAG, diagnosis
from tests.search.line_model import BEND, TIME, WAVE
from tests.verdict.lines import Lines
from tests.verdict.test_gain_and_agreement import COUNT, readings
from tests.verdict.test_parameter_error import fitted, held_out, judged

START = Doubt(
    "monday",
    "coil[1].temperature",
    "start",
    "begins at 35 degC, where 21 degC is simulated",
    "state it",
    False,
    0.0,
    9.0,
    90.0,
    is_far=True,
)
#: A search in which nothing was moved far and no structure was seen, of a model that offers places for laws.
QUIET: Any = SimpleNamespace(
    base=SimpleNamespace(point=SimpleNamespace(base=np.zeros(1)), widths=np.ones(1)),
    base_structure=SimpleNamespace(z=0.0, limit=4.0, channels=""),
    first=None,
)
SEARCHED: Any = SimpleNamespace(has_physics=True, untried=())


def test_a_noise_that_is_larger_than_stated_is_told_from_an_error_that_lasts() -> None:
    """Twice the noise, white; a wave of the same size; and both."""
    drawn = np.random.default_rng(4).standard_normal(COUNT)
    wave = np.sin(np.linspace(0.0, 25.0, COUNT))
    for residuals, is_irregular in (
        (2.0 * drawn, True),
        (drawn + 2.5 * wave, False),
        (2.0 * drawn + 2.0 * wave, False),
    ):
        found = agreement(residuals, readings())
        assert found.is_rejected
        assert found.is_irregular == is_irregular
    assert not agreement(drawn, readings()).is_irregular  # nothing rejects


@pytest.mark.parametrize("is_lasting", [False, True])
def test_channels_that_reject_a_model_only_together_say_whether_it_lasts_too(is_lasting: bool) -> None:
    """Six channels with 1.07 times their noise: none beyond its own limit, all of them beyond that of all."""
    count = 400
    rng = np.random.default_rng(8)
    drawn = rng.standard_normal((6, count))
    drawn /= np.sqrt(np.mean(drawn**2, axis=1, keepdims=True))
    wave = np.sqrt(2.0) * np.sin(np.linspace(0.0, 30.0, count))
    rows = drawn + np.sqrt(1.07**2 - 1.0) * wave if is_lasting else 1.07 * drawn
    found = agreement(rows.ravel(), readings(6, count=count))
    assert found.is_rejected
    assert not any(c.is_rejected for c in found.channels)
    assert found.is_irregular == (not is_lasting)


def test_readings_that_stand_out_alone_are_no_error_that_lasts() -> None:
    """One in 25 by 7 deviations, either way: too little to be set aside as wild, enough to reject the model."""
    rng = np.random.default_rng(4)
    drawn, wave = rng.standard_normal(COUNT), np.sin(np.linspace(0.0, 25.0, COUNT))
    wild = np.zeros(COUNT)
    wild[5::25] = rng.choice([-7.0, 7.0], len(wild[5::25]))
    for residuals, is_irregular in ((drawn + wild, True), (drawn + wild + 2.5 * wave, False)):
        found = agreement(residuals, readings())
        assert found.is_rejected
        assert found.is_irregular == is_irregular


def test_shares_are_those_of_the_errors_that_are_printed() -> None:
    """A sensor's zero that is off by 4 deviations counts in full: the sum of squares beyond that of noise."""
    off = np.random.default_rng(5).standard_normal(COUNT) + 4.0
    assert agreement(off, readings()).excess == pytest.approx(off @ off - COUNT, rel=1e-12)


def test_a_model_that_is_late_at_switches_is_no_noise() -> None:
    """Between readings on both sides of a switch its error jumps by more than noise ever does; elsewhere it lasts."""
    late = np.zeros(400)
    for begin in range(20, 400, 60):
        late[begin : begin + 25] = 60.0
    found = agreement(late + np.random.default_rng(4).standard_normal(400), readings())
    assert found.is_rejected
    assert not found.is_irregular
    assert found.channels[0].scatter == pytest.approx(1.0, rel=0.15)


def test_a_larger_noise_is_no_missing_effect_in_the_headline() -> None:
    noisy = replace(ADEQUACY, is_irregular=True, day=())
    assert "something else is missing" not in how_right(noisy, False)
    assert "noise is larger than is stated" in how_right(noisy, False)


@pytest.mark.parametrize(
    ("is_rejected", "which"), [(True, "the readings reject"), (False, "the training readings reject")]
)
def test_a_larger_noise_is_told_of_the_readings_that_show_it(is_rejected: bool, which: str) -> None:
    noisy = replace(ADEQUACY, is_irregular=True, is_rejected=is_rejected, is_training_rejected=True)
    (told,) = _rejections(noisy, "")
    assert told.startswith(f"{which} the model by the stated noise")


def test_a_larger_noise_is_corrected_and_no_recording_is_repeated_for_it() -> None:
    told = replace(diagnosis(Verdict.CANNOT_TELL), findings=(), adequacy=replace(ADEQUACY, is_irregular=True))
    assert what_decides(told).startswith("Correct `noise`")


def test_nothing_is_explained_to_100_per_cent_while_a_channel_rejects() -> None:
    assert "more than 99 %" in how_right(replace(ADEQUACY, explained=1.0), True)
    assert "100 %" not in how_right(replace(ADEQUACY, explained=1.0), True)


def test_faults_without_a_name_in_a_model_that_is_wrong_accuse_no_sensor() -> None:
    stopgap = replace(LAG, standing=Standing.UNNAMED)
    assert is_stopgap([stopgap])
    assert not is_stopgap([stopgap, LAG])
    told = headline(Verdict.CANNOT_TELL, [stopgap], ADEQUACY, ["the readings reject the model"])
    below = " ".join(notes(Verdict.CANNOT_TELL, [stopgap], ADEQUACY, ["the readings reject the model"]))
    assert "is at fault" not in told + below
    assert "The rig, a sensor or an input may do that" in below


def test_physics_waits_until_a_far_start_is_stated() -> None:
    (told,) = doubted([CONTACT], [START])
    assert not told.is_accepted
    assert told.doubts[0].startswith("first the start has to be stated: monday, coil[1].temperature: begins at 35 degC")
    (stands,) = doubted([CONTACT], [replace(START, is_far=False)])
    assert stands.is_accepted
    bias = replace(LAG, effect="sensor_bias", channels=("coil[1].temperature",), recording="tuesday")
    assert all(f.is_accepted for f in doubted([bias, CONTACT], [START]))  # a sensor that reads too much explains it


def test_a_far_start_is_the_reason_that_is_told() -> None:
    searched: Any = SimpleNamespace(has_physics=True, untried=())
    outcome: Any = None
    assert why_open(outcome, [], ADEQUACY, searched, [START]) == (
        "monday does not begin as it says; coil[1].temperature: begins at 35 degC, where 21 degC is simulated",
    )


def test_a_recording_that_stands_out_comes_first_where_something_is_open_and_opens_nothing_itself() -> None:
    searched: Any = SimpleNamespace(has_physics=True, untried=())
    outcome: Any = SimpleNamespace(
        base_structure=SimpleNamespace(z=0.0, limit=4.0, channels=""),
        first=None,
        base=SimpleNamespace(point=Point(np.zeros(0)), widths=np.ones(0)),
    )
    told = "explains 99 % of the others' and 0 % of this one's"
    odd = Doubt("monday", "all channels", "odd one out", told, "look", False, 0.0, 9.0, 5.0)
    quiet = replace(ADEQUACY, is_rejected=False, is_training_rejected=False, is_recalibration_worse=False)
    first, second = why_open(outcome, [], replace(quiet, is_rejected=True), searched, [odd])
    assert first == "monday stands out: explains 99 % of the others' and 0 % of this one's; look"
    assert second.startswith("the readings reject the model")
    assert why_open(outcome, [], quiet, searched, [odd]) == ()


def test_numbers_of_a_day_carry_the_title_of_their_recording() -> None:
    start, room = Own("initial_temperature", 0), Own("ambient_offset", 0, "1")
    first, second = (Parameter(own_label(o), "K", 0.0, 1.0, False, own=o) for o in (start, room))
    assert titled(first, ["tuesday"]) == "initial_temperature of recording tuesday"
    assert titled(first, []) == "initial_temperature of recording 1"
    assert titled(second, ["tuesday"]) == "ambient_offset of recording day 1"


@pytest.mark.parametrize("spacing", [0.5, 4.0])
def test_begin_and_end_of_a_sensor_fault_are_no_sharper_than_its_readings(spacing: float) -> None:
    """An offset from 50 s on: the readings at 50 s and one spacing before are all that is known."""
    times = np.arange(0.0, 100.0, spacing)
    offset = TermParameter("offset", "K", -9.0, 9.0, (1.0,))
    instant = TermParameter("begin", "s", 0.0, 100.0, (1.0,), is_instant=True)
    term = Term("sensor_offset_in_interval", "T1", "measurement", (offset, instant), recording=0)
    layout = SimpleNamespace(time=times, channel=np.zeros(len(times)))
    model: Any = SimpleNamespace(where=lambda t: (None, SimpleNamespace(channels=(0,))), layout=layout)
    edge = 50.0 - 0.5 * spacing  # where the box of the fit begins
    size, begin = between_samples(
        (Estimate("offset", "K", 2.0, 1.9, 2.1), Estimate("begin", "s", edge, edge, edge)), term, model
    )
    assert (size.lower, size.upper) == (1.9, 2.1)
    assert (begin.lower, begin.upper) == pytest.approx((50.0 - spacing, 50.0), abs=1e-9)


def test_a_fault_of_one_recording_was_not_judged_by_others() -> None:
    fault = replace(
        LAG, effect="sensor_offset_in_interval", judged_by="every other reading, left out of a fit", held_out_gain=50.0
    )
    told = sureness(replace(diagnosis(Verdict.MISSING_PHYSICS), findings=(fault, CONTACT)))
    assert "falls by 50.0 (every other reading, left out of a fit)" in told
    assert "where findings show most" not in improvement(replace(diagnosis(Verdict.MISSING_PHYSICS), findings=(fault,)))


def test_where_nothing_was_fitted_nothing_is_said_of_a_fit() -> None:
    stopped = diagnosis(Verdict.RECORDING_FAULT)
    for text in (sureness(stopped), structure(stopped)):
        assert "none did" not in text
        assert "after recalibration" not in text


def test_a_doubt_names_its_channel() -> None:
    assert doubt_text(replace(DOUBT, subject="coil[2].temperature")).startswith("steps, coil[2].temperature: ")


def test_an_error_that_lasts_for_two_readings_is_no_noise() -> None:
    """Ninety readings of a body that is met 70 times worse than its noise: neighbours err alike, if not for long."""
    drawn = 70.0 * np.random.default_rng(2).standard_normal(91)
    alike = np.convolve(drawn, np.ones(3) / np.sqrt(3.0), "same")
    assert not agreement(alike, readings(count=91, is_given=False)).is_irregular
    assert agreement(drawn, readings(count=91, is_given=False)).is_irregular


def test_a_class_of_a_sensor_and_of_the_rig_accuses_neither() -> None:
    """`drift of a sensor or unnamed heat` was told as a sensor at fault, `ambient drift or sensor drift` as physics."""
    sensor = replace(LAG, standing=Standing.CLASS, ambiguous_with=("unnamed_heat_linear_time",), is_of_either=True)
    rig = replace(CONTACT, standing=Standing.CLASS, ambiguous_with=("sensor_bias",), is_of_either=True)
    for one in (sensor, rig):
        told = headline(Verdict.CANNOT_TELL, [one], ADEQUACY, ["the readings reject the model"])
        below = " ".join(notes(Verdict.CANNOT_TELL, [one], ADEQUACY))
        assert "is at fault" not in told + below
        assert "leaves out" not in told + below
        assert "The rig, a sensor or an input may do that" in below
        assert is_stopgap([one])
    both = headline(Verdict.MISSING_PHYSICS, [replace(CONTACT, statement="a loose contact"), sensor], ADEQUACY)
    assert both.startswith("The model leaves out: a loose contact.")
    assert "is at fault" not in both


@pytest.mark.parametrize(
    ("effect", "likely", "is_either"),
    [
        ("sensor_lag", ("second_mass",), True),
        ("second_mass", ("sheath",), False),
        ("second_mass", ("sheath", "sensor_lag"), True),
        ("sensor_lag", ("sensor_bias",), False),
        ("sensor_lag", (), False),
    ],
)
def test_whether_a_class_may_be_of_the_rig_and_of_a_sensor(
    effect: str, likely: tuple[str, ...], is_either: bool
) -> None:
    known = [
        Term(c.identifier, "all coils", c.unit, (), is_named=c.is_named)
        for c in catalogue()
        if c.identifier in ("sensor_lag", "second_mass", "sheath", "sensor_bias")
    ]
    law = SimpleNamespace(is_of_either=False)
    model = SimpleNamespace(terms=lambda: known, where=lambda term: (law, None))
    term = next(t for t in known if t.identifier == effect)
    assert _is_of_either(cast(DiagnosisModel, model), term, likely) is is_either
    law.is_of_either = True
    assert _is_of_either(cast(DiagnosisModel, model), term, likely)


@pytest.mark.parametrize(("explained", "word"), [(0.69, Verdict.CANNOT_TELL), (0.8, Verdict.UNNAMED_PHYSICS)])
def test_a_law_without_a_name_that_leaves_most_of_the_mismatch_says_nothing_of_the_rig(
    explained: float, word: Verdict
) -> None:
    """Recalibration explains 56 %: with 69 % more is left than was explained of the rest, with 80 % less."""
    outcome, searched = QUIET, SEARCHED
    unnamed = replace(CONTACT, standing=Standing.UNNAMED, is_named=False, statement="an effect without a name, coils")
    right = replace(ADEQUACY, explained=explained, by_recalibration=0.56)
    assert verdict(outcome, [unnamed], right, searched) is word
    assert verdict(outcome, [CONTACT], right, searched) is Verdict.MISSING_PHYSICS
    assert verdict(outcome, [unnamed], replace(right, is_rejected=False), searched) is Verdict.UNNAMED_PHYSICS
    reasons = why_open(outcome, [unnamed], right, searched)
    is_open = word is Verdict.CANNOT_TELL
    assert (reasons[0] == "what improves the prediction has no name and leaves most of the squared mismatch") is is_open
    told = headline(word, [unnamed], right, reasons)
    assert ("The model leaves out" in told) is not is_open
    assert told.startswith("It cannot be told what is missing or wrong: what improves the prediction has") is is_open
    below = " ".join(notes(word, [unnamed], right, reasons))
    assert ("does not decide: an effect without a name, coils. The rig, a sensor or an" in below) is is_open
    assert f"The amended model explains {100.0 * explained:.0f} % of the squared mismatch" in told


def test_whether_something_is_missing_is_open_only_where_the_readings_do_not_reject_the_model() -> None:
    met, noisy = replace(ADEQUACY, is_rejected=False), replace(ADEQUACY, is_irregular=True)
    for right in (met, noisy):
        told = headline(Verdict.CANNOT_TELL, [], right, ["a reason"])
        assert told.startswith("It cannot be told whether something is missing: a reason.")
    assert headline(Verdict.CANNOT_TELL, [], ADEQUACY, ["a reason"]).startswith("It cannot be told what is missing or")


def test_a_law_with_a_name_beside_one_without_at_the_same_place_loses_its_name() -> None:
    """A wave that no law with a name describes, and a bend that may be a part of the same law."""
    truth = 0.3 + 0.5 * TIME + 0.3 * np.sin(25.0 * TIME) + 4.0 * TIME**2
    training, judge = Lines(truth, 1), Lines(truth, 2)
    outcome = fitted(training, WAVE, BEND)
    accepted = judged(training, held_out(judge, training), WAVE, BEND)
    found = {f.effect: f for f in findings(training, outcome, accepted, ["training"])}
    assert all(f.is_accepted and f.standing is Standing.UNNAMED for f in found.values())
    assert any("at the same place" in d for d in found["bend"].doubts)
    assert not found["wave"].doubts
    alone = fitted(training, BEND), judged(Lines(truth, 1), held_out(judge, training), BEND)
    assert not any("at the same place" in d for f in findings(training, *alone, ["training"]) for d in f.doubts)


def test_a_law_with_a_name_elsewhere_keeps_it() -> None:
    unnamed = replace(CONTACT, standing=Standing.UNNAMED, elements=("string[2]",))
    assert not _is_beside_unnamed(CONTACT, [CONTACT, unnamed])
    assert not _is_beside_unnamed(CONTACT, [CONTACT, replace(unnamed, elements=CONTACT.elements, unit="thermal")])
    assert _is_beside_unnamed(CONTACT, [CONTACT, replace(unnamed, elements=CONTACT.elements)])


def test_a_sensor_is_not_accused_of_what_a_law_without_a_name_does_in_its_readings() -> None:
    """Creep that no law with a name describes was told as a term without a name and a sensor that drifts."""
    creep = replace(CONTACT, standing=Standing.UNNAMED, channels=LAG.channels, statement="an effect without a name")
    assert _is_beside_unnamed(LAG, [LAG, creep])
    assert not _is_beside_unnamed(LAG, [LAG, replace(creep, channels=("string[1].current",))])
    assert not _is_beside_unnamed(LAG, [LAG, replace(LAG, standing=Standing.UNNAMED)])  # two faults of one sensor
    outcome, searched = QUIET, SEARCHED
    sensor = replace(LAG, standing=Standing.UNNAMED, is_named=False)
    right = replace(ADEQUACY, is_rejected=False)
    assert verdict(outcome, [creep], right, searched) is Verdict.UNNAMED_PHYSICS
    assert verdict(outcome, [creep, sensor], right, searched) is Verdict.CANNOT_TELL
    assert verdict(outcome, [CONTACT, sensor], right, searched) is Verdict.MISSING_PHYSICS
    told = headline(Verdict.CANNOT_TELL, [creep, sensor], right, why_open(outcome, [creep, sensor], right, searched))
    assert "by a law of a sensor or an input, but not identified" in told
    below = " ".join(notes(Verdict.CANNOT_TELL, [creep, sensor], right))
    assert "does not decide: an effect without a name; sensor lag" in below
