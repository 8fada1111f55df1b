"""Whether a headline is true, verdict by verdict, and which claims on sabotaged recordings are false."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from diagnosis.judge.diagnosis import Diagnosis, Doubt, Moved, Standing, Verdict
from evaluation.proof.answer import Answer, Concealed, Sabotage, read_answer
from evaluation.proof.departure import noise_limit
from evaluation.proof.headline import is_headline_true
from evaluation.proof.scoring import score
from tests.diagnosis.report_examples import ADEQUACY
from tests.proof.examples import DURATION, RADIATION, REFERENCE, SHORT, SMALL, alternative, answer, diagnosis, finding

NULL = answer(kind="null", verdicts=("consistent", "recalibrated"))
OUTSIDE = answer(replace(RADIATION, effect="wet_film", is_in_catalogue=False), kind="outside")
STUCK = Sabotage("sensor_stuck", ("small, training 1",), ("coil[1,1].temperature",), 20.0, 50.0)
ROOM = Sabotage("unequal_rooms", ("small, training 2",), (), 0.0, 100.0, same_as=("ambient_step",))
BRANCH = Sabotage("single_branch", ("small, training 1",), (), 0.0, 100.0, units=("stiffness",))


def _true(given: Diagnosis, truth: Answer, **changes: Any) -> bool:
    return is_headline_true(given, truth, SMALL, replace(REFERENCE, **changes))


def _sabotaged(sabotage: Sabotage, *effects: Any) -> Answer:
    return answer(*effects, kind="sabotaged", verdicts=("recording fault", "cannot tell"), sabotage=sabotage)


def test_the_limit_of_noise_is_that_of_the_chi_square_distribution() -> None:
    # M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, table 26.8: 149.449 at 100 degrees of freedom.
    assert noise_limit(100) == pytest.approx(1.49449, abs=1e-5)


@pytest.mark.parametrize("verdict", [Verdict.CONSISTENT, Verdict.RECALIBRATED])
def test_all_is_well_only_where_nothing_shows_and_readings_do_not_reject(verdict: Verdict) -> None:
    limit = noise_limit(300) - 1.0 + 0.95  # the noise of these readings is 0.95
    well = diagnosis(verdict=verdict, after=0.999 * limit)
    assert _true(well, NULL)
    assert not _true(diagnosis(verdict=verdict, after=1.001 * limit), NULL)
    assert not _true(diagnosis(verdict=verdict, after=float("nan")), NULL)
    assert not _true(well, answer(RADIATION))  # the true term gains 100
    assert _true(well, answer(RADIATION), training_gain=19.0)
    assert not _true(well, _sabotaged(ROOM))
    # Outside the catalogue there is no true term: what the twin leaves says whether there is something to see.
    assert not _true(well, OUTSIDE, oracle=None, training_gain=None, twin=2.9)  # 0.1 of 300 samples
    assert _true(well, OUTSIDE, oracle=None, training_gain=None, twin=2.97)


def test_missing_physics_is_true_where_every_accepted_name_is() -> None:
    truth = answer(RADIATION)
    assert _true(diagnosis(finding()), truth)
    assert not _true(diagnosis(finding("latent_heat")), truth)
    assert not _true(diagnosis(finding(place="string[1]")), truth)
    assert not _true(diagnosis(finding(), finding("latent_heat")), truth)  # the second one is false
    assert _true(diagnosis(finding(), finding("latent_heat", is_accepted=False)), truth)  # a suggestion
    assert not _true(diagnosis(finding(is_accepted=False)), truth)  # nothing is left of the verdict
    assert not _true(diagnosis(finding()), NULL)


def test_one_of_two_effects_is_true_as_far_as_it_goes() -> None:
    assert _true(diagnosis(finding()), answer(RADIATION, SHORT, kind="two"))


def test_a_class_is_true_if_it_holds_the_truth_at_its_place() -> None:
    in_class = finding("latent_heat", standing=Standing.CLASS, ambiguous_with=("radiation",))
    assert _true(diagnosis(in_class), answer(RADIATION))
    assert not _true(diagnosis(replace(in_class, standing=Standing.NAMED)), answer(RADIATION))
    elsewhere = finding("latent_heat", place="all coils", standing=Standing.CLASS)
    assert not _true(diagnosis(elsewhere), answer(RADIATION))
    likely = replace(elsewhere, alternatives=(alternative("radiation", 0.3),))  # at string[2]
    assert _true(diagnosis(likely), answer(RADIATION))


def test_unnamed_physics_is_true_in_the_right_unit_and_with_a_gain_held_out() -> None:
    unnamed = finding("unnamed_heat_time", is_named=False)
    verdict = Verdict.UNNAMED_PHYSICS
    assert _true(diagnosis(unnamed, verdict=verdict, after=2.0), OUTSIDE)
    assert not _true(diagnosis(unnamed, verdict=verdict, after=3.5), OUTSIDE)  # recalibrated: 3.0
    assert not _true(diagnosis(replace(unnamed, unit="electrical"), verdict=verdict), OUTSIDE)
    assert not _true(diagnosis(unnamed, verdict=verdict), NULL)
    # What a standing of `unnamed` has as identifier does not matter.
    assert _true(diagnosis(finding(standing=Standing.UNNAMED), verdict=verdict), OUTSIDE)


def test_the_gain_is_judged_with_the_numbers_of_the_day_that_are_stated() -> None:
    """An arm whose start is 3 mrad off: as written both models are far from its readings."""
    unnamed = finding("unnamed_heat_time", is_named=False)
    told = diagnosis(unnamed, verdict=Verdict.UNNAMED_PHYSICS, after=3.5)  # recalibrated: 3.0
    day = (Moved("arm.initial_angle of recording arm, held out 1", "rad", -0.003, False, -0.6),)
    square = {"before": 5.9, "recalibrated": 4.8, "after": 1.6}
    assert _true(replace(told, adequacy=replace(ADEQUACY, day=day, chi_square=square)), OUTSIDE)
    assert not _true(replace(told, adequacy=replace(ADEQUACY, day=day, chi_square=square | {"after": 4.9})), OUTSIDE)
    assert not _true(replace(told, adequacy=replace(ADEQUACY, day=(), chi_square=square)), OUTSIDE)


def test_an_input_that_was_off_for_a_while_is_told_by_its_law() -> None:
    spoiled = replace(STUCK, kind="input_offset", channels=(), same_as=())
    right = finding("input_gain_in_interval", "measurement", "voltage of the supply (small, training 1)")
    other = replace(right, place="voltage of the supply (small, training 2)")
    bias = replace(right, effect="sensor_bias", elements=())
    for one, is_right in ((right, True), (other, False), (bias, False)):
        told = diagnosis(replace(one, elements=()), verdict=Verdict.MEASUREMENT_FAULT)
        assert _true(told, _sabotaged(spoiled)) is is_right


def test_cannot_tell_is_always_true() -> None:
    for truth in (NULL, answer(RADIATION), OUTSIDE, _sabotaged(STUCK)):
        assert _true(diagnosis(verdict=Verdict.CANNOT_TELL, after=50.0), truth)


def test_a_measurement_fault_must_be_of_a_channel_that_is_spoiled() -> None:
    verdict = Verdict.MEASUREMENT_FAULT
    here = finding("sensor_bias", "measurement", "coil[1,1].temperature")
    there = finding("sensor_bias", "measurement", "coil[2,3].temperature")
    assert _true(diagnosis(here, verdict=verdict), _sabotaged(STUCK))
    assert not _true(diagnosis(there, verdict=verdict), _sabotaged(STUCK))
    assert not _true(diagnosis(here, verdict=verdict), NULL)


def test_a_fault_of_one_recording_names_it_behind_its_channel() -> None:
    for place, is_right in (
        ("coil[1,1].temperature (small, training 1)", True),
        ("coil[1,1].temperature (small, training 2)", False),
        ("coil[1,2].temperature (small, training 1)", False),
    ):
        one = replace(finding("sensor_stuck_in_interval", "measurement", place), elements=())
        told = diagnosis(one, verdict=Verdict.MEASUREMENT_FAULT)
        assert _true(told, _sabotaged(STUCK)) is is_right


def test_a_recording_fault_must_have_been_committed() -> None:
    verdict = Verdict.RECORDING_FAULT
    assert _true(diagnosis(verdict=verdict), _sabotaged(ROOM))
    assert not _true(diagnosis(verdict=verdict), NULL)
    assert not _true(diagnosis(verdict=verdict), answer(RADIATION))
    assert not _true(diagnosis(finding(), verdict=verdict), _sabotaged(ROOM))  # physics besides, which is not there


def _exchanged(subject: str, same_as: tuple[str, ...] = ("wrong_identity",)) -> Diagnosis:
    doubt = Doubt("tuesday", subject, "swapped", "exchanged", "look", True, 0.0, 100.0, 50.0, same_as=same_as)
    return replace(diagnosis(verdict=Verdict.RECORDING_FAULT), doubts=(doubt,))


def test_exchanged_columns_are_of_a_class_with_exchanged_sensors() -> None:
    channels = ("coil[2,3].temperature", "coil[1,1].temperature")
    swap = Concealed(
        "wrong_identity", "measurement", True, False, "weak", "swap", (), channels, {"exchange": 1.0}, (), None
    )
    truth = answer(swap, kind="sensor", verdicts=("measurement fault",))
    told = _exchanged("coil[1,1].temperature, coil[2,3].temperature")
    assert _true(told, truth)
    scored = score(told, truth, SMALL, REFERENCE, DURATION)
    (effect,) = scored.effects
    assert scored.is_verdict_right
    assert (effect.is_unit_right, effect.is_place_right, effect.is_in_class) == (True, True, True)
    assert effect.is_named is False
    # elsewhere, not of the class, or another effect: false as before
    assert not _true(_exchanged("coil[1,1].temperature, coil[1,2].temperature"), truth)
    assert not _true(_exchanged("coil[1,1].temperature, coil[2,3].temperature", ()), truth)
    assert not _true(told, answer(RADIATION))
    assert not _true(told, NULL)
    wrong = score(_exchanged("coil[1,1].temperature, coil[1,2].temperature"), truth, SMALL, REFERENCE, DURATION)
    assert not wrong.is_verdict_right
    assert not wrong.effects[0].is_place_right


@pytest.mark.parametrize(
    ("found", "sabotage", "is_false"),
    [
        (finding(), STUCK, True),
        (finding(standing=Standing.CLASS, ambiguous_with=("latent_heat",)), STUCK, True),
        (finding(standing=Standing.UNNAMED), STUCK, False),
        (finding("unnamed_heat_time", is_named=False), BRANCH, False),
        (finding(is_accepted=False), STUCK, False),
        (finding("sensor_bias", "measurement", "coil[2,3].temperature"), STUCK, False),  # wrong, but no physics
        (finding("ambient_step", place="all coils"), ROOM, False),  # the same in other words
        (finding("ambient_step", place="all coils"), STUCK, True),
    ],
)
def test_physics_named_on_sabotaged_recordings_is_a_false_claim(found, sabotage, is_false) -> None:
    scored = score(diagnosis(found), _sabotaged(sabotage), SMALL, REFERENCE, DURATION)
    assert scored.is_false_claim is is_false
    assert scored.is_false_alarm is None
    assert scored.sabotage == sabotage.kind


def test_physics_that_is_there_besides_is_no_false_claim() -> None:
    truth = _sabotaged(STUCK, RADIATION)
    assert score(diagnosis(finding()), truth, SMALL, REFERENCE, DURATION).is_false_claim is False
    assert score(diagnosis(finding("latent_heat")), truth, SMALL, REFERENCE, DURATION).is_false_claim is True
    assert score(diagnosis(finding()), answer(RADIATION), SMALL, REFERENCE, DURATION).is_false_claim is None


def test_answers_of_now_and_of_before_are_read(tmp_path: Path) -> None:
    effect = {
        "effect": "open_coil",
        "unit": "electrical",
        "is_in_catalogue": True,
        "is_hidden": False,
        "strength": "weak",
        "place": "coil",
        "elements": ["coil[1,1]"],
        "channels": [],
        "parameters": {"instant": 40.0},
        "comparable_parameters": ["instant"],
    }
    told = {"case": "c", "kind": "single", "setup": "small", "engine": "own", "verdicts": ["missing physics"]}
    now = {"recording": "training_2", "title": "small, training 2", "order": 2, "begin": 40.0, "end": 100.0}
    path = tmp_path / "c.json"
    for intervals, expected in (([now], (40.0, "small, training 2", 2)), ([[40.0, 100.0]], (40.0, "", 0))):
        path.write_text(json.dumps({**told, "findings": [{**effect, "intervals": intervals}]}))
        (truth,) = read_answer(path).effects
        assert (truth.instant, truth.recording, truth.order) == expected
        assert read_answer(path).sabotage is None
