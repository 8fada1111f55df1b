"""Scores one diagnosis against what was concealed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from diagnosis.judge.diagnosis import Diagnosis, Estimate, Finding, Verdict
from evaluation.proof.answer import Answer, Concealed
from evaluation.proof.headline import (
    LEAST_GAIN,
    accepted,
    ambiguity_class,
    has_name,
    held_out_chi_square,
    is_false_claim,
    is_headline_true,
    is_told_by_doubt,
    names_recording,
    stated_class,
)
from evaluation.proof.place import Rig, found_place, true_place
from evaluation.proof.reference import Reference

#: An instant is right within this share of the recording: effects show only while something is driven.
TIME_SHARE = 0.05
#: An interval of an instant that is longer than this share of the recording says nothing.
VAGUE_SHARE = 0.2
#: Held-out chi-square may be this much above that of the model that knows the effect.
AS_GOOD_AS = 1.1
#: Share of the possible held-out gain that counts as reached.
ENOUGH_GAIN = 0.8
#: Kinds of cases of which a share of the held-out gain is asked for.
_SHARED = ("outside", "composed", "leave_one_out")


@dataclass(frozen=True)
class EffectScore:
    """How one concealed effect was found. None: the question does not arise.

    Args:
        effect: Identifier of the truth.
        unit: Its unit.
        strength: Of the truth.
        is_known: Whether the diagnosis could have named it.
        found: Identifier of the finding that was matched with it; empty: none.
        found_unit: Unit of that.
        found_place: Place of that.
        gain: Of that.
        is_unit_right: Whether the finding has its unit.
        is_place_right: Whether the finding has its elements.
        is_time_right: Whether the finding sets in when it does.
        is_named: Whether the finding calls it by its name, alone or at the head of a class.
        is_in_class: Whether its name is in the finding's ambiguity class.
        is_misnamed: Whether the finding has the name of another effect, or of a class without it.
        covered: For each true parameter that can be compared, whether the 95 % interval holds it.
    """

    effect: str
    unit: str
    strength: str
    is_known: bool
    found: str = ""
    found_unit: str = ""
    found_place: str = ""
    gain: float = 0.0
    is_unit_right: bool = False
    is_place_right: bool = False
    is_time_right: bool | None = None
    is_named: bool | None = None
    is_in_class: bool | None = None
    is_misnamed: bool | None = None
    covered: tuple[bool, ...] = ()


@dataclass(frozen=True)
class HeldOut:
    """Held-out chi-square per sample. None: not known, or the question does not arise.

    Args:
        after: Of the diagnosis's model.
        ratio: To that of the model that knows the effect.
        is_as_good: Whether the ratio is at most 1.1.
        share: Of the possible gain over recalibration that was reached.
        is_share_enough: Whether that is at least 80 %.
    """

    after: float | None = None
    ratio: float | None = None
    is_as_good: bool | None = None
    share: float | None = None
    is_share_enough: bool | None = None


@dataclass(frozen=True)
class Score:
    """Score of one case.

    Args:
        verdict: Of the diagnosis; empty: none was made.
        is_verdict_right: Whether it is one of the right ones.
        is_false_alarm: Whether something was found where nothing is; None where something is.
        effects: One per concealed effect.
        spare: Accepted findings that no concealed effect was matched with.
        held_out: See there.
        suggestions: Findings that are not accepted.
        is_false_claim: Whether physics is named that is not there; of sabotaged cases alone.
        is_headline_true: Whether the verdict, with what it stands on, is true; None: there is no diagnosis.
        sabotage: Its kind; empty: none.
    """

    verdict: str
    is_verdict_right: bool
    is_false_alarm: bool | None
    effects: tuple[EffectScore, ...]
    spare: int
    held_out: HeldOut
    suggestions: int = 0
    is_false_claim: bool | None = None
    is_headline_true: bool | None = None
    sabotage: str = ""


def score(diagnosis: Diagnosis | None, answer: Answer, rig: Rig, reference: Reference, duration: float) -> Score:
    """Score a case; without a diagnosis every question that arises is answered wrongly.

    Args:
        diagnosis: What was said, or None.
        answer: The truth.
        rig: What the case is made of.
        reference: What the data allow.
        duration: Of a recording [s].
    """
    findings = accepted(diagnosis)
    matched = _matched(answer.effects, findings, rig)
    titles = tuple(r.title for r in diagnosis.recordings) if diagnosis else ()
    verdict = diagnosis.verdict.value if diagnosis else ""
    return Score(
        verdict=verdict,
        is_verdict_right=verdict in answer.verdicts or _is_doubt_right(diagnosis, answer, rig),
        is_false_alarm=_is_false_alarm(diagnosis, answer, findings),
        effects=tuple(
            _doubted(t) if f is None and is_told_by_doubt(diagnosis, t, rig) else _effect(t, f, rig, duration, titles)
            for t, f in zip(answer.effects, matched)
        ),
        spare=len(findings) - sum(f is not None for f in matched),
        held_out=_held_out(diagnosis, answer, reference),
        suggestions=len(diagnosis.findings) - len(findings) if diagnosis else 0,
        is_false_claim=_is_false(diagnosis, answer, rig, findings),
        is_headline_true=is_headline_true(diagnosis, answer, rig, reference) if diagnosis else None,
        sabotage=answer.sabotage.kind if answer.sabotage else "",
    )


def _is_doubt_right(diagnosis: Diagnosis | None, answer: Answer, rig: Rig) -> bool:
    """Whether the recording is blamed for what no data can tell from the one fault that is concealed."""
    is_blamed = diagnosis is not None and diagnosis.verdict is Verdict.RECORDING_FAULT
    return is_blamed and len(answer.effects) == 1 and is_told_by_doubt(diagnosis, answer.effects[0], rig)


def _doubted(truth: Concealed) -> EffectScore:
    """What a doubt tells of an effect: one of a class at the right place, which no name heads."""
    return EffectScore(
        truth.effect,
        truth.unit,
        truth.strength,
        truth.is_known,
        found=truth.effect,
        found_unit=truth.unit,
        is_unit_right=True,
        is_place_right=True,
        is_time_right=None if truth.instant is None else False,
        is_named=False if truth.is_known else None,
        is_in_class=True if truth.is_known else None,
        is_misnamed=None if truth.is_known else False,
    )


def _is_false_alarm(diagnosis: Diagnosis | None, answer: Answer, findings: Sequence[Finding]) -> bool | None:
    """Of cases in which nothing is concealed: whether something is found, or the recording blamed."""
    if answer.effects or answer.sabotage is not None:
        return None
    return diagnosis is None or bool(findings) or diagnosis.verdict is Verdict.RECORDING_FAULT


def _is_false(diagnosis: Diagnosis | None, answer: Answer, rig: Rig, findings: Sequence[Finding]) -> bool | None:
    """Of sabotaged cases: whether physics is named that is not there. What failed or took too long counts as wrong."""
    if answer.sabotage is None:
        return None
    return diagnosis is None or any(is_false_claim(f, answer, rig) for f in findings)


def _matched(truths: Sequence[Concealed], findings: Sequence[Finding], rig: Rig) -> list[Finding | None]:
    """The finding that stands for each truth: of one truth the first, of several the assignment that agrees best."""
    if len(truths) == 1:
        return [findings[0] if findings else None]
    if not truths or not findings:
        return [None] * len(truths)
    likeness = np.array([[_likeness(t, f, rig) for f in findings] for t in truths])
    rows, columns = linear_sum_assignment(-likeness)
    chosen = dict(zip(rows.tolist(), columns.tolist()))
    return [findings[chosen[i]] if i in chosen else None for i in range(len(truths))]


def _likeness(truth: Concealed, finding: Finding, rig: Rig) -> float:
    is_place = found_place(finding.place, rig) == true_place(truth, rig)
    return 4.0 * (truth.effect == finding.effect) + 2.0 * (truth.unit == finding.unit) + 1.0 * is_place


def _effect(truth: Concealed, finding: Finding | None, rig: Rig, duration: float, titles: Sequence[str]) -> EffectScore:
    known = truth.is_known
    if finding is None:
        return EffectScore(
            truth.effect,
            truth.unit,
            truth.strength,
            known,
            is_time_right=None if truth.instant is None else False,
            is_named=False if known else None,
            is_in_class=False if known else None,
            is_misnamed=None if known else False,
        )
    is_named = finding.effect == truth.effect and has_name(finding)
    is_place = found_place(finding.place, rig) == true_place(truth, rig)
    return EffectScore(
        truth.effect,
        truth.unit,
        truth.strength,
        known,
        found=finding.effect,
        found_unit=finding.unit,
        found_place=finding.place,
        gain=finding.gain,
        is_unit_right=finding.unit == truth.unit,
        is_place_right=is_place,
        is_time_right=None if truth.instant is None else _is_time_right(truth, finding, duration, titles),
        is_named=is_named if known else None,
        is_in_class=truth.effect in ambiguity_class(finding) if known else None,
        is_misnamed=None if known else has_name(finding) and truth.effect not in stated_class(finding),
        covered=_covered(truth, finding) if is_named and is_place else (),
    )


def _is_time_right(truth: Concealed, finding: Finding, duration: float, titles: Sequence[str]) -> bool:
    """Whether the stated instant, or else the begin of the time in which it shows, is the true one.

    A finding that says in which recording it sets in must say the right one.
    """
    instant = truth.instant
    assert instant is not None, "asked of what sets in"
    recordings = names_recording(finding, titles)
    if truth.recording and recordings and recordings != {truth.recording}:
        return False
    stated = next((p for p in finding.parameters if p.name == "instant"), None)
    if stated is not None:
        is_near = abs(stated.value - instant) <= TIME_SHARE * duration
        is_vague = stated.upper - stated.lower > VAGUE_SHARE * duration
        return is_near or (_holds(stated, instant) and not is_vague)
    begins = [begin for begin, _ in finding.intervals]
    return bool(begins) and abs(min(begins) - instant) <= TIME_SHARE * duration


def _covered(truth: Concealed, finding: Finding) -> tuple[bool, ...]:
    stated = {p.name: p for p in finding.parameters}
    return tuple(_holds(stated[n], truth.parameters[n]) for n in truth.comparable if n in stated)


def _holds(estimate: Estimate, value: float) -> bool:
    return estimate.lower <= value <= estimate.upper


def _held_out(diagnosis: Diagnosis | None, answer: Answer, reference: Reference) -> HeldOut:
    after = held_out_chi_square(diagnosis, dict(reference.samples)) if diagnosis else None
    is_asked = reference.oracle is not None
    ratio = after / reference.oracle if after is not None and reference.oracle else None
    is_as_good = (ratio is not None and ratio <= AS_GOOD_AS) if is_asked else None
    share, is_enough = _share(after, answer, _with_own(reference, diagnosis, answer))
    return HeldOut(after, ratio, is_as_good, share, is_enough)


def _with_own(reference: Reference, diagnosis: Diagnosis | None, answer: Answer) -> Reference:
    """Composed laws on what is no coil network have no reference: the diagnosis's own recalibration, and noise."""
    if answer.kind != "composed" or reference.recalibrated is not None or diagnosis is None:
        return reference
    samples = {f"{f.recording}/{f.channel}": f.samples for f in diagnosis.fit if f.is_held_out}
    own = held_out_chi_square(diagnosis, {}, "recalibrated")
    return replace(reference, recalibrated=own, floor=1.0, samples=samples)


def _share(after: float | None, answer: Answer, reference: Reference) -> tuple[float | None, bool | None]:
    """Share of the possible gain; only for effects without a name, and where there is something to gain."""
    if answer.kind not in _SHARED or reference.recalibrated is None:
        return None, None
    # Noise alone, which no model of the effect can reach, serves where nothing better is known: proofs without twins.
    best = next((v for v in (reference.oracle, reference.twin, reference.floor) if v is not None), None)
    if best is None or (reference.recalibrated - best) * sum(reference.samples.values()) < LEAST_GAIN:
        return None, None
    if after is None:
        return 0.0, False
    share = (reference.recalibrated - after) / (reference.recalibrated - best)
    return share, share >= ENOUGH_GAIN
