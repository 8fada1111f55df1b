"""Scores of hand-made diagnoses."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diagnosis.judge.diagnosis import Estimate, Standing, Used, Verdict
from evaluation.proof.headline import held_out_chi_square
from evaluation.proof.reference import Reference
from evaluation.proof.scoring import Score, score
from tests.proof.examples import (
    DURATION,
    RADIATION,
    REFERENCE,
    SHORT,
    SMALL,
    alternative,
    answer,
    diagnosis,
    finding,
)

SHORTED = finding("shorted_coil", "electrical", "coil[2,3]", parameters=(Estimate("instant", "s", 41.0, 39.0, 43.0),))


ONE = answer(RADIATION)


def _scored(*findings, truth=ONE, verdict=Verdict.MISSING_PHYSICS, after=1.0) -> Score:
    return score(diagnosis(*findings, verdict=verdict, after=after), truth, SMALL, REFERENCE, DURATION)


def test_a_finding_that_says_the_truth_is_right_in_everything() -> None:
    scored = _scored(finding())
    (effect,) = scored.effects
    assert scored.is_verdict_right
    assert (effect.is_unit_right, effect.is_place_right, effect.is_named, effect.is_in_class) == (True,) * 4
    assert effect.covered == (True,)
    assert effect.is_time_right is None  # nothing sets in
    assert effect.is_misnamed is None  # it has a name
    assert scored.is_false_alarm is None
    assert scored.spare == 0


def test_another_effect_of_the_unit_at_another_place_has_the_unit_alone_right() -> None:
    (effect,) = _scored(finding("latent_heat", place="all coils")).effects
    assert effect.is_unit_right
    assert (effect.is_place_right, effect.is_named, effect.is_in_class) == (False, False, False)
    assert effect.covered == ()


def test_of_one_effect_the_first_finding_counts_and_the_others_are_spare() -> None:
    scored = _scored(finding("latent_heat"), finding())
    assert scored.effects[0].found == "latent_heat"
    assert not scored.effects[0].is_named
    assert scored.spare == 1


@pytest.mark.parametrize(("probability", "is_in_class"), [(0.2, True), (0.001, False)])
def test_likely_alternatives_belong_to_the_ambiguity_class(probability: float, is_in_class: bool) -> None:
    found = finding("latent_heat", alternatives=(alternative("radiation", probability),))
    assert _scored(found).effects[0].is_in_class is is_in_class


def test_what_a_finding_is_said_to_be_ambiguous_with_belongs_to_the_class() -> None:
    (effect,) = _scored(finding("latent_heat", ambiguous_with=("radiation",))).effects
    assert effect.is_in_class
    assert not effect.is_named


def test_an_interval_beside_the_true_value_does_not_cover_it() -> None:
    beside = (Estimate("emissivity_area", "m^2", 3e-4, 2.5e-4, 3.5e-4),)
    assert _scored(finding(parameters=beside)).effects[0].covered == (False,)


@pytest.mark.parametrize(
    ("value", "lower", "upper", "is_right"),
    [
        (44.0, 43.5, 44.5, True),  # within 5 % of 100 s
        (46.0, 45.0, 47.0, False),
        (46.0, 38.0, 54.0, True),  # the interval holds it
        (70.0, 0.0, 100.0, False),  # an interval that says nothing
    ],
)
def test_an_instant_is_right_near_the_truth_or_within_a_telling_interval(value, lower, upper, is_right) -> None:
    found = replace(SHORTED, parameters=(Estimate("instant", "s", value, lower, upper),))
    assert _scored(found, truth=answer(SHORT)).effects[0].is_time_right is is_right


@pytest.mark.parametrize(("begin", "is_right"), [(42.0, True), (10.0, False)])
def test_without_an_instant_the_begin_of_what_is_seen_counts(begin: float, is_right: bool) -> None:
    found = replace(SHORTED, parameters=(), intervals=((60.0, 70.0), (begin, 50.0)))
    assert _scored(found, truth=answer(SHORT)).effects[0].is_time_right is is_right


@pytest.mark.parametrize(
    ("statement", "is_right"),
    [
        ("sets in at 41.0 s of recording small, training 2", True),
        ("sets in at 41.0 s of recording small, training 1", False),
        ("sets in at 41.0 s", True),  # it does not say in which
    ],
)
def test_a_finding_that_names_a_recording_must_name_the_right_one(statement: str, is_right: bool) -> None:
    used = tuple(Used(f"small, training {n}", "", False, 0.0, 100.0, ()) for n in (1, 2))
    told = replace(diagnosis(replace(SHORTED, statement=statement)), recordings=used)
    truth = answer(replace(SHORT, recording="small, training 2", order=2))
    assert score(told, truth, SMALL, REFERENCE, DURATION).effects[0].is_time_right is is_right


def test_a_suggestion_is_no_claim_and_nothing_found() -> None:
    suggested = finding(is_accepted=False)
    null = answer(kind="null", verdicts=("consistent", "recalibrated", "cannot tell"))
    quiet = _scored(suggested, truth=null, verdict=Verdict.CANNOT_TELL)
    assert (quiet.is_false_alarm, quiet.spare, quiet.suggestions) == (False, 0, 1)
    (effect,) = _scored(suggested).effects
    assert (effect.found, effect.is_named, effect.is_unit_right) == ("", False, False)


def test_a_recording_that_is_blamed_where_nothing_is_wrong_is_a_false_alarm() -> None:
    null = answer(kind="null", verdicts=("consistent", "recalibrated"))
    assert _scored(truth=null, verdict=Verdict.RECORDING_FAULT).is_false_alarm is True


@pytest.mark.parametrize(
    ("standing", "members", "is_named", "is_misnamed"),
    [
        (Standing.NAMED, (), False, True),
        (Standing.CLASS, ("radiation",), False, False),  # the truth is in the class
        (Standing.CLASS, ("latent_heat",), False, True),
        (Standing.UNNAMED, (), False, False),
    ],
)
def test_a_class_is_misnamed_only_without_the_truth(standing, members, is_named, is_misnamed) -> None:
    found = finding("second_mass", standing=standing, ambiguous_with=members)
    (known,) = _scored(found).effects
    (hidden,) = _scored(found, truth=answer(replace(RADIATION, is_hidden=True), kind="leave_one_out")).effects
    assert known.is_named is is_named
    assert hidden.is_misnamed is is_misnamed


def test_the_right_name_at_the_head_of_a_class_counts_and_below_no_name_does_not() -> None:
    assert _scored(finding(standing=Standing.CLASS, ambiguous_with=("latent_heat",))).effects[0].is_named
    assert not _scored(finding(standing=Standing.UNNAMED)).effects[0].is_named


def test_without_a_network_the_gain_of_a_composed_law_ends_at_noise() -> None:
    truth = answer(replace(RADIATION, effect="composed", is_in_catalogue=False), kind="composed")
    none = Reference("case_0001", failure="no reference")
    held = score(diagnosis(finding(is_named=False), after=1.2), truth, SMALL, none, DURATION).held_out
    assert held.share == pytest.approx(0.9, rel=1e-12)  # of 3.0 - 1.0
    assert held.is_share_enough


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_two_effects_are_matched_whatever_their_order(order: tuple[int, int]) -> None:
    findings = (finding(), SHORTED)
    scored = _scored(*(findings[i] for i in order), truth=answer(SHORT, RADIATION, kind="two"))
    assert [e.found for e in scored.effects] == ["shorted_coil", "radiation"]
    assert all(e.is_named for e in scored.effects)


def test_one_finding_for_two_effects_leaves_one_of_them_unfound() -> None:
    scored = _scored(SHORTED, truth=answer(SHORT, RADIATION, kind="two"))
    assert [e.is_named for e in scored.effects] == [True, False]
    assert not scored.effects[1].is_unit_right


@pytest.mark.parametrize("findings", [(), (finding(),)])
def test_a_null_in_which_something_is_found_is_a_false_alarm(findings: tuple) -> None:
    verdict = Verdict.MISSING_PHYSICS if findings else Verdict.CONSISTENT
    scored = _scored(*findings, truth=answer(kind="null", verdicts=("consistent", "recalibrated")), verdict=verdict)
    assert scored.is_false_alarm is bool(findings)
    assert scored.is_verdict_right is not bool(findings)
    assert scored.spare == len(findings)


def test_an_effect_without_a_name_must_not_be_given_one() -> None:
    unknown = replace(RADIATION, effect="wet_film", is_in_catalogue=False)
    truth = answer(unknown, kind="outside", verdicts=("unnamed physics",))
    (named,) = _scored(finding(), truth=truth).effects
    (unnamed,) = _scored(finding("unnamed_heat_time", is_named=False), truth=truth).effects
    assert (named.is_misnamed, unnamed.is_misnamed) == (True, False)
    assert named.is_named is None
    assert unnamed.is_unit_right


def test_a_case_without_a_diagnosis_is_wrong_in_every_question_that_arises() -> None:
    scored = score(None, answer(SHORT), SMALL, REFERENCE, DURATION)
    (effect,) = scored.effects
    asked = (effect.is_unit_right, effect.is_place_right, effect.is_time_right, effect.is_named, effect.is_in_class)
    assert asked == (False,) * 5
    assert not scored.is_verdict_right
    assert scored.held_out.is_as_good is False
    assert score(None, answer(kind="null"), SMALL, REFERENCE, DURATION).is_false_alarm is True


def test_held_out_chi_square_weighs_channels_by_their_samples() -> None:
    given = diagnosis()
    first, second = given.fit
    given = replace(given, fit=(replace(first, chi_square={"after": 4.0}), replace(second, chi_square={"after": 1.0})))
    assert held_out_chi_square(given, {}) == pytest.approx(2.0, rel=1e-12)  # (100 * 4 + 200 * 1) / 300
    unknown = tuple(replace(f, samples=0) for f in given.fit)
    counts = {"coil[1,1].temperature": 300, "coil[2,3].temperature": 100}
    assert held_out_chi_square(replace(given, fit=unknown), counts) == pytest.approx(3.25, rel=1e-12)


@pytest.mark.parametrize(("after", "is_as_good"), [(1.09, True), (1.11, False), (float("nan"), False)])
def test_held_out_chi_square_is_compared_with_the_model_that_knows(after: float, is_as_good: bool) -> None:
    assert _scored(finding(), after=after).held_out.is_as_good is is_as_good


@pytest.mark.parametrize(("after", "share", "is_enough"), [(1.2, 0.9, True), (2.0, 0.5, False), (3.2, -0.1, False)])
def test_of_an_unnamed_effect_the_share_of_the_possible_gain_counts(after, share, is_enough) -> None:
    truth = answer(replace(RADIATION, is_hidden=True), kind="leave_one_out")
    held = _scored(finding(is_named=False), truth=truth, after=after).held_out
    assert held.share == pytest.approx(share, rel=1e-12)  # of 3.0 - 1.0
    assert held.is_share_enough is is_enough


OUTSIDE = answer(replace(RADIATION, effect="wet_film", is_in_catalogue=False), kind="outside")
UNKNOWN = replace(REFERENCE, oracle=None, training_gain=None)


@pytest.mark.parametrize(
    ("twin", "after", "share", "is_enough"),
    [
        (1.5, 1.7, 1.3 / 1.5, True),  # (3.0 - 1.7) / (3.0 - 1.5)
        (1.5, 1.9, 1.1 / 1.5, False),
        (None, 1.7, 1.3 / 2.05, False),  # a proof without twins: of 3.0 - 0.95, which is noise alone
        (None, 1.3, 1.7 / 2.05, True),
    ],
)
def test_outside_the_catalogue_the_gain_that_is_possible_ends_at_the_twin(twin, after, share, is_enough) -> None:
    held = score(diagnosis(finding(), after=after), OUTSIDE, SMALL, replace(UNKNOWN, twin=twin), DURATION).held_out
    assert held.share == pytest.approx(share, rel=1e-12)
    assert held.is_share_enough is is_enough


@pytest.mark.parametrize(("twin", "is_asked"), [(2.97, False), (2.95, True)])
def test_no_share_is_asked_for_where_the_twin_leaves_nothing_to_gain(twin: float, is_asked: bool) -> None:
    # 0.03 * 300 samples = 9 < 12 < 15 = 0.05 * 300, though noise alone is at 0.95
    held = score(None, OUTSIDE, SMALL, replace(UNKNOWN, twin=twin), DURATION).held_out
    assert held.is_share_enough is (False if is_asked else None)


def test_the_model_that_knows_the_effect_goes_before_a_twin() -> None:
    truth = answer(replace(RADIATION, is_hidden=True), kind="leave_one_out")
    held = score(diagnosis(finding(), after=2.0), truth, SMALL, replace(REFERENCE, twin=2.0), DURATION).held_out
    assert held.share == pytest.approx(0.5, rel=1e-12)  # of 3.0 - 1.0


def test_where_there_is_nothing_to_gain_no_share_is_asked_for() -> None:
    truth = answer(replace(RADIATION, is_hidden=True), kind="leave_one_out")
    none = replace(REFERENCE, recalibrated=1.03)  # 0.03 * 300 samples = 9 < 12
    assert score(diagnosis(finding()), truth, SMALL, none, DURATION).held_out.is_share_enough is None
