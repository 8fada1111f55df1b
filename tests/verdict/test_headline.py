"""The first sentences of an answer say what was found and how right the model is, and no more."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rich.console import Console

from diagnosis.judge.adequacy import with_day
from diagnosis.judge.diagnosis import ChannelFit, Standing, Verdict
from diagnosis.judge.headline import headline, how_right, notes
from diagnosis.report.network import Network
from diagnosis.report.page import page
from diagnosis.report.sentences import where
from diagnosis.report.summary import print_summary
from tests.diagnosis.report_examples import ADEQUACY, CONTACT, DOUBT, LAG, diagnosis

DAY_TOLD = (
    "That takes for granted: room temperature of recording 1: +0.310 K. "
    "The rows of fits of each channel are without it."
)
WILD_TOLD = (
    "Of the held-out recordings 2 readings stand out, each alone or two in a row, and are not counted against the "
    "model; errors of channels count all."
)


def test_what_is_explained_and_what_stays_stand_in_the_unit_of_the_channel() -> None:
    told = headline(Verdict.MISSING_PHYSICS, [CONTACT], ADEQUACY)
    assert told == (
        "The model leaves out: contact resistance in a string, string[3]. The amended model explains 96 % of the "
        "squared mismatch in the held-out recordings (recalibration alone 81 %); 1.2 K of coil[2,5].temperature stays, "
        "8.0 times the noise that is stated: something else is missing or wrong."
    )
    assert notes(Verdict.MISSING_PHYSICS, [CONTACT], ADEQUACY) == (DAY_TOLD, WILD_TOLD)


def test_a_fault_beside_physics_is_no_physics() -> None:
    told = headline(Verdict.MISSING_PHYSICS, [LAG, CONTACT], ADEQUACY)
    assert told.startswith(
        "The model leaves out: contact resistance in a string, string[3]. The amended model explains"
    )
    besides = notes(Verdict.MISSING_PHYSICS, [LAG, CONTACT], ADEQUACY)[0]
    assert besides == "Besides, a sensor or an input is at fault: sensor lag, coil[1,2].temperature."


def test_a_law_of_a_sensor_without_a_name_blames_no_sensor() -> None:
    """A lag that is bent to what else is missing may as well be heat that is stored in the rig."""
    unnamed = replace(LAG, standing=Standing.UNNAMED, is_named=False)
    told = headline(Verdict.MISSING_PHYSICS, [unnamed, CONTACT], ADEQUACY)
    told = " ".join([told, *notes(Verdict.MISSING_PHYSICS, [unnamed, CONTACT], ADEQUACY)])
    assert "at fault" not in told
    assert "the rig, a sensor or an input may do: sensor lag, coil[1,2].temperature." in told
    assert where(unnamed).startswith("described at measurement: ")
    assert not where(LAG).startswith("described")


def test_what_recalibration_does_is_not_credited_to_laws() -> None:
    worse = replace(ADEQUACY, by_recalibration=-0.2)
    assert "(recalibration alone" not in how_right(worse, True)
    assert "(recalibration alone" not in how_right(ADEQUACY, False)


def test_noise_alone_is_said_to_be_no_more_than_noise() -> None:
    quiet = replace(ADEQUACY, is_rejected=False, explained=0.999, day=())
    assert how_right(quiet, True) == (
        "The amended model explains more than 99 % of the squared mismatch in the held-out recordings (recalibration "
        "alone 81 %); what is left is not more than the stated noise of the sensors."
    )
    assert how_right(quiet, False).startswith("The recalibrated model explains")


def test_a_model_that_got_worse_says_so() -> None:
    worse = replace(ADEQUACY, explained=-0.5, chi_square={"before": 4.0, "recalibrated": 5.0, "after": 5.5}, day=())
    assert how_right(worse, True).startswith("The amended model predicts the held-out recordings worse; 1.2 K")


def test_of_many_suggestions_the_first_are_named_and_the_others_counted() -> None:
    many = [replace(LAG, is_accepted=False, statement=f"effect {n}") for n in range(5)]
    told = notes(Verdict.CANNOT_TELL, many, ADEQUACY, ["the readings reject the model"])[0]
    assert "not accepted: effect 0; effect 1; effect 2; and 2 more." in told


def test_exchanged_channels_are_no_other_experiment() -> None:
    swapped = replace(DOUBT, kind="swapped", statement="`a` reads like `b`. Columns or sensors are exchanged")
    told = headline(Verdict.RECORDING_FAULT, [], None, doubts=[swapped, replace(swapped, recording="tuesday")])
    assert told == (
        "Channels are exchanged: in steps, `a` reads like `b`. Columns or sensors are exchanged (1 more recording "
        "raises a doubt of this kind)."
    )
    both = headline(Verdict.RECORDING_FAULT, [], None, doubts=[swapped, DOUBT])
    assert both.startswith(
        "The recording and the scenario are not of the same experiment: in steps, `a` reads like `b`."
    )


def test_another_experiment_is_told_by_what_was_seen() -> None:
    told = headline(Verdict.RECORDING_FAULT, [], None, doubts=[DOUBT, replace(DOUBT, is_serious=False, statement="no")])
    assert told == (
        "The recording and the scenario are not of the same experiment: in steps, The supply switches at 30 s, the "
        "readings at 50 s."
    )


def test_doubts_of_one_kind_are_told_once_and_their_recordings_counted() -> None:
    """Two clocks that run slow by nearly the same were told one after the other, without their recordings."""
    other = replace(DOUBT, recording="tuesday", statement="The supply switches at 31 s, the readings at 50 s.")
    unit = replace(DOUBT, kind="unit", statement="These are mA.")
    told = headline(Verdict.RECORDING_FAULT, [], None, doubts=[DOUBT, other, replace(other, recording="friday"), unit])
    assert told.endswith(
        "the readings at 50 s (2 more recordings raise a doubt of this kind); in steps, supply.voltage: These are mA."
    )


def test_what_the_error_of_fitted_parameters_explains_is_said_to_be_that() -> None:
    within = replace(ADEQUACY, is_rejected=False, needs_parameter_error=True, day=())
    error = "the stated noise of the sensors and the error of the fitted parameters"
    assert how_right(within, True).endswith(f"what is left is not more than {error}.")
    assert f"within {error} once" in headline(Verdict.RECALIBRATED, [], within)
    worse = replace(within, explained=-0.5, chi_square={"before": 4.0, "recalibrated": 5.0, "after": 5.5})
    assert how_right(worse, False).endswith(f"worse; what is left is not more than {error}.")


def test_of_a_model_as_it_is_no_number_was_fitted() -> None:
    told = headline(Verdict.CONSISTENT, [], replace(ADEQUACY, is_rejected=False, needs_parameter_error=True, day=()))
    assert "error of the fitted" not in told


def test_noise_that_is_not_stated_may_last_longer_than_neighbours_show() -> None:
    """A sensor that drifts to and fro has more noise than its neighbouring readings tell: nothing need be missing."""
    unstated = replace(ADEQUACY, is_noise_stated=False)
    told = headline(Verdict.CANNOT_TELL, [], unstated, ["the readings reject the model"])
    assert told.startswith("It cannot be told whether something is missing")
    assert "or noise lasts longer than neighbouring readings" in told
    assert "lasts longer" not in headline(Verdict.CANNOT_TELL, [], ADEQUACY, ["the readings reject the model"])


def test_a_fault_that_the_check_saw_is_told_once() -> None:
    """A sensor that was seen to stand still is not called something else beside that."""
    seen = replace(DOUBT, kind="sensor", subject="coil[1,2].temperature", statement="the sensor stood still", begin=3.0)
    bent = replace(
        LAG,
        standing=Standing.UNNAMED,
        is_named=False,
        effect="sensor_stuck_in_interval",
        channels=("coil[1,2].temperature",),
        recording="steps",
    )
    told = headline(Verdict.MEASUREMENT_FAULT, [bent], ADEQUACY, doubts=[seen])
    assert told.startswith("A sensor or an input is at fault: coil[1,2].temperature of steps: the sensor stood still.")
    assert not any("What else improves" in n for n in notes(Verdict.MEASUREMENT_FAULT, [bent], ADEQUACY, doubts=[seen]))
    elsewhere = replace(bent, channels=("coil[1,1].temperature",))
    assert "What else improves" in notes(Verdict.MEASUREMENT_FAULT, [elsewhere], ADEQUACY, doubts=[seen])[0]


def test_a_headline_has_two_sentences_at_most_and_the_rest_stands_below() -> None:
    """Four reasons, two findings and a suggestion made a headline of nine lines."""
    unnamed = replace(LAG, standing=Standing.UNNAMED, is_named=False)
    guess = replace(CONTACT, is_accepted=False)
    reasons = ["the readings reject the model", "the recalibrated parameters predict worse", "a third"]
    told = headline(Verdict.CANNOT_TELL, [unnamed, guess], ADEQUACY, reasons)
    assert told.startswith("It cannot be told what is missing or wrong: the readings reject the model. The model with")
    assert told.count(". ") == 1
    assert notes(Verdict.CANNOT_TELL, [unnamed, guess], ADEQUACY, reasons) == (
        "A further reason: the recalibrated parameters predict worse.",
        "A further reason: a third.",
        "Accepted, as it improves the prediction of the held-out recordings but not identified, so it does not decide: "
        "sensor lag, coil[1,2].temperature. The rig, a sensor or an input may do that.",
        "Suggested by the training recordings alone, not accepted: contact resistance in a string, string[3].",
        DAY_TOLD,
        WILD_TOLD,
    )


def test_cannot_tell_says_of_accepted_findings_that_they_are_not_identified() -> None:
    unnamed = replace(LAG, standing=Standing.UNNAMED, is_named=False)
    why = notes(Verdict.CANNOT_TELL, [unnamed], ADEQUACY, ["the readings reject the model"])
    told = replace(diagnosis(Verdict.CANNOT_TELL), findings=(unnamed,), notes=why)
    text = page(told, [], Network(()))
    assert "<dt>Accepted, not identified</dt><dd>sensor lag, coil[1,2].temperature" in text
    assert "Finding 1, not identified" in text
    assert "<li>Accepted, as it improves" in text
    console = Console(width=100, record=True)
    print_summary(told, console)
    shown = " ".join(console.export_text().split())
    assert "note Accepted, as it improves the prediction" in shown
    assert "what improves the prediction, not identified: " in shown


def test_a_model_that_agrees_once_the_start_of_a_day_is_estimated_says_so() -> None:
    """Rows of fits have chi-square 3.2 with what is written down; 0.9 was judged, and 0.5 in both after a fit."""
    chi = {"before": 0.9, "recalibrated": 0.5, "after": 0.5}
    met = replace(ADEQUACY, is_rejected=False, is_nominal_rejected=False, chi_square=chi, day=(), wild=0)
    rows = [
        ChannelFit("third", True, "lump.temperature", "K", {}, {"before": 3.2, "after": 0.5}, {}, samples=100),
        ChannelFit("first", False, "lump.temperature", "K", {}, {"before": 9.0, "after": 0.5}, {}, samples=100),
    ]
    found = with_day(met, rows)
    assert found.by_day == pytest.approx(2.3)
    told = headline(Verdict.CONSISTENT, [], found)
    assert told.endswith("once what each of them has of its own (its start, say) is estimated.")
    wild = with_day(met, [replace(rows[0], chi_square={"before": 1.9, "after": 1.5})])  # wild readings, in both
    assert headline(Verdict.CONSISTENT, [], wild) == (
        "The model as it is agrees with the held-out recordings within the stated noise of the sensors."
    )
    assert with_day(met, [rows[1]]).by_day == 0.0


def test_laws_without_a_name_are_not_counted_as_effects() -> None:
    """Three of them may bend to one law that the library has not: what is left out need not be three things."""
    other = replace(CONTACT, standing=Standing.UNNAMED, is_named=False, statement="an effect without a name, string[1]")
    ends = "laws without a name describe together what is missing, which need not be as many effects"
    assert ends not in headline(Verdict.MISSING_PHYSICS, [CONTACT], ADEQUACY)
    assert ends not in headline(Verdict.UNNAMED_PHYSICS, [other], ADEQUACY)
    assert ends in headline(Verdict.UNNAMED_PHYSICS, [other, other], ADEQUACY)
    assert ends in headline(Verdict.MISSING_PHYSICS, [CONTACT, other], ADEQUACY)
    assert ends not in headline(Verdict.MISSING_PHYSICS, [CONTACT, CONTACT], ADEQUACY)
