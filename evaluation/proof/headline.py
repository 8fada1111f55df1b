"""Whether what a diagnosis says first is true, and which of its claims are not.

Only accepted findings are claims; a suggestion claims nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnosis.faults.law import OF_INPUTS
from diagnosis.judge.diagnosis import Diagnosis, Finding, Standing, Verdict
from evaluation.proof.answer import Answer, Concealed, Sabotage
from evaluation.proof.departure import is_within_noise
from evaluation.proof.place import Rig, found_place, true_place
from evaluation.proof.reference import Reference

#: Fall of -2 log posterior by the true terms from which an effect counts as visible in the training recordings.
VISIBLE = 20.0
#: -2 log likelihood that there must be to gain held out: less than the search's own floor is nothing.
LEAST_GAIN = 12.0
#: Alternatives at least as probable as this belong to the ambiguity class that a diagnosis states.
LEAST_PROBABLE = 0.01
#: Sabotage to the kinds of doubt (`Doubt.kind`) that tell it; a sabotage that is not here may be told by any.
_DOUBTS: Mapping[str, frozenset[str]] = {
    "wrong_programme": frozenset({"programme", "no answer", "other run", "input", "dead time", "start", "turned"}),
    "other_run_input": frozenset({"programme", "other run", "input", "dead time"}),
    "input_offset": frozenset({"input", "programme", "scale"}),
    "unequal_rooms": frozenset({"start", "input", "programme"}),
    "wrong_start": frozenset({"start", "programme", "turned"}),
    "other_supply": frozenset({"swapped", "exchanged", "programme", "other run", "input"}),
    "delay_line": frozenset({"dead time", "clock", "programme", "input"}),
    "swapped_columns": frozenset({"swapped", "unit", "scale", "sign", "sensor"}),
    "swapped_coils": frozenset({"swapped", "programme"}),
    "wrong_unit": frozenset({"unit", "scale", "clock"}),
    "shifted_clock": frozenset({"clock", "dead time", "programme", "start", "turned"}),
    "drifting_clock": frozenset({"clock", "dead time", "programme"}),
    "sensor_off": frozenset({"sensor", "noise"}),
    "sensor_stuck": frozenset({"sensor", "noise"}),
}
#: Sabotage to findings that say the same of the recordings that were spoiled.
_FINDINGS: Mapping[str, frozenset[str]] = {"input_offset": frozenset(law.identifier for law in OF_INPUTS)}


def accepted(diagnosis: Diagnosis | None) -> tuple[Finding, ...]:
    """Findings that are claims."""
    return tuple(f for f in diagnosis.findings if f.is_accepted) if diagnosis else ()


def has_name(finding: Finding) -> bool:
    """Whether a finding calls what it found by a name, or by the names of a class."""
    return finding.is_named and finding.standing is not Standing.UNNAMED


def ambiguity_class(finding: Finding) -> set[str]:
    """Effects that a finding says it may be."""
    likely = {a.effect for a in finding.alternatives if a.probability >= LEAST_PROBABLE}
    return {finding.effect, *finding.ambiguous_with} | likely


def stated_class(finding: Finding) -> set[str]:
    """Effects that the standing of a finding lets it be: one name, or those of its class."""
    if finding.standing is Standing.CLASS:
        return {finding.effect, *finding.ambiguous_with}
    return {finding.effect}


def held_out_chi_square(diagnosis: Diagnosis, samples: Mapping[str, int], stage: str = "after") -> float | None:
    """Mean over all held-out samples; None where a channel has no finite figure."""
    counts, values = _held_out(diagnosis, samples, stage)
    if not counts.sum() or not np.isfinite(values).all():
        return None
    return float(counts @ values / counts.sum())


def _held_out(
    diagnosis: Diagnosis, samples: Mapping[str, int], stage: str
) -> tuple[np.ndarray[tuple[int], np.dtype[np.float64]], np.ndarray[tuple[int], np.dtype[np.float64]]]:
    fits = [f for f in diagnosis.fit if f.is_held_out]
    counts = np.array([f.samples or samples.get(f.channel, 0) for f in fits], dtype=np.float64)
    values = np.array([f.chi_square.get(stage, np.nan) for f in fits], dtype=np.float64)
    return counts, values


def is_headline_true(diagnosis: Diagnosis, answer: Answer, rig: Rig, reference: Reference) -> bool:
    """Whether the verdict, with what it stands on, is true.

    - `consistent`, `recalibrated`: nothing is concealed but parameters, or nothing that training shows, and the
      model is not farther from the held-out truth than the noise hides (`departure`).
    - `missing physics`, `unnamed physics`: every accepted finding is true, and there is one: a named one has effect and
      place right, or in the class that it states; an unnamed one has the unit right and gains on held-out readings.
    - `measurement fault`: the same, of sensors. `recording fault`: it is the one that was committed, or of a class with
      what is concealed, at its place.
    - `cannot tell`: always.
    """
    verdict, claims = diagnosis.verdict, accepted(diagnosis)
    if verdict is Verdict.CANNOT_TELL:
        return True
    if verdict in (Verdict.CONSISTENT, Verdict.RECALIBRATED):
        is_nothing_told = not claims and not _is_visible(answer, reference)
        return is_nothing_told and is_within_noise(diagnosis, answer, reference)
    is_sound = all(is_true(f, diagnosis, answer, rig, reference) for f in claims)
    if verdict is Verdict.RECORDING_FAULT:
        is_told = any(is_told_by_doubt(diagnosis, truth, rig) for truth in answer.effects)
        return is_sound and (is_told or _is_fault_right(diagnosis, answer.sabotage))
    return bool(claims) and is_sound


def is_true(finding: Finding, diagnosis: Diagnosis, answer: Answer, rig: Rig, reference: Reference) -> bool:
    """Whether an accepted finding says what is concealed."""
    sabotage = answer.sabotage
    if sabotage is not None and _tells(finding, sabotage, rig):
        return True
    if has_name(finding):
        return any(_is_in_stated_class(finding, truth, rig) for truth in answer.effects)
    units = {t.unit for t in answer.effects} | set(sabotage.units if sabotage else ())
    return finding.unit in units and _gain(diagnosis, reference) > 0.0


def is_false_claim(finding: Finding, answer: Answer, rig: Rig) -> bool:
    """Whether a finding of a sabotaged case names physics that is not there."""
    sabotage = answer.sabotage
    if not has_name(finding) or finding.unit == "measurement":
        return False
    if sabotage is not None and _tells(finding, sabotage, rig):
        return False
    return not any(t.effect in stated_class(finding) for t in answer.effects)


def _is_in_stated_class(finding: Finding, truth: Concealed, rig: Rig) -> bool:
    there = true_place(truth, rig)
    if truth.effect in stated_class(finding) and found_place(finding.place, rig) == there:
        return True
    if finding.standing is not Standing.CLASS:
        return False
    likely = (a for a in finding.alternatives if a.probability >= LEAST_PROBABLE)
    return any(a.effect == truth.effect and found_place(a.place, rig) == there for a in likely)


def _tells(finding: Finding, sabotage: Sabotage, rig: Rig) -> bool:
    """Whether a finding says what the sabotage did: the same in other words, or a fault of a spoiled channel."""
    channel, _, title = finding.place.partition(" (")  # a fault of one recording names it behind its channel
    if title and title.rstrip(")") not in sabotage.titles:
        return False
    if finding.effect in sabotage.same_as or finding.effect in _FINDINGS.get(sabotage.kind, ()):
        return True
    channels = {channel, *finding.elements, *found_place(channel, rig)}
    return finding.unit == "measurement" and bool(channels & set(sabotage.channels))


def _is_fault_right(diagnosis: Diagnosis, sabotage: Sabotage | None) -> bool:
    """Whether a recording fault is the one that was committed; without doubts that tell it, whether there is one."""
    if sabotage is None:
        return False
    doubts = [d for d in getattr(diagnosis, "doubts", ()) if d.is_serious]
    wanted = _DOUBTS.get(sabotage.kind)
    told = [d for d in doubts if d.recording in sabotage.titles and (wanted is None or d.kind in wanted)]
    return bool(told) or not doubts


def is_told_by_doubt(diagnosis: Diagnosis | None, truth: Concealed, rig: Rig) -> bool:
    """Whether a serious doubt is of a class with what is concealed, at its place: no data can tell them apart."""
    doubts = [d for d in diagnosis.doubts if d.is_serious] if diagnosis is not None else []
    there = true_place(truth, rig)
    return any(truth.effect in d.same_as and frozenset(d.subject.split(", ")) == there for d in doubts)


def _is_visible(answer: Answer, reference: Reference) -> bool:
    """Whether something is concealed that the recordings show."""
    if answer.sabotage is not None:
        return True
    if not answer.effects:
        return False
    if reference.training_gain is not None:
        return reference.training_gain >= VISIBLE
    if reference.twin is not None and reference.recalibrated is not None:
        return (reference.recalibrated - reference.twin) * sum(reference.samples.values()) >= LEAST_GAIN
    return True


def _gain(diagnosis: Diagnosis, reference: Reference) -> float:
    """Fall of the held-out chi-square per sample by the findings; negative where it is not known.

    With the numbers of the day as the diagnosis states them, if it does: an arm that begins 3 mrad off is far from its
    course after ten swings, with and without what was found.
    """
    if diagnosis.adequacy is not None and diagnosis.adequacy.day:
        return diagnosis.adequacy.chi_square["recalibrated"] - diagnosis.adequacy.chi_square["after"]
    stages = [held_out_chi_square(diagnosis, reference.samples, s) for s in ("recalibrated", "after")]
    before, after = stages
    return -1.0 if before is None or after is None else before - after


def names_recording(finding: Finding, titles: Sequence[str]) -> set[str]:
    """Recordings, of these titles, in which a finding says that it sets in; empty: it says none."""
    own = getattr(finding, "recording", "")
    if own:
        return {own}
    texts = (finding.statement, finding.place, *finding.elements)
    return {t for t in titles if any(t in text for text in texts)}
