"""Sentences that the page and the terminal share."""

from __future__ import annotations

from collections.abc import Mapping

from diagnosis.judge.diagnosis import Diagnosis, Finding, Verdict
from diagnosis.report.display import UNKNOWN, clean, duration, listed, number, percent, span, words
from diagnosis.report.fits import STAGES, mean_chi_square, plain_channel

#: What follows from a verdict.
ADVICE = {
    Verdict.CONSISTENT: "Nothing needs to be added to the model.",
    Verdict.RECALIBRATED: "Only parameters of the model were off; no physics is missing that these recordings show.",
    Verdict.RECORDING_FAULT: "Correct the recording or the scenario first; nothing was concluded about the physics.",
    Verdict.MEASUREMENT_FAULT: "Mend or model the sensor before the physics is changed.",
    Verdict.MISSING_PHYSICS: "It acts at the place and the times below.",
    Verdict.UNNAMED_PHYSICS: "The formula tells what it depends on; a name for it is left to a person.",
    Verdict.CANNOT_TELL: "Trust neither the model nor a correction of it where it departs from these recordings.",
}


def where(finding: Finding) -> str:
    """Unit, place, and elements unless the place names them."""
    elements = listed([e for e in finding.elements if e != finding.place], 6)
    return f"{finding.unit}: {clean(finding.place)}" + (f" ({elements})" if elements else "")


def when(finding: Finding, most: int = 4) -> str:
    """Intervals of a finding."""
    return listed([span(a, b) for a, b in finding.intervals], most) or UNKNOWN


def what(finding: Finding) -> str:
    """Effect and how probable it is."""
    name = words(finding.effect) if finding.is_named else "no name in the catalogue"
    return f"{name}, probability {percent(finding.probability)} among all that were fitted in its place"


def ambiguity(finding: Finding) -> str:
    """What the data cannot tell from a finding."""
    if not finding.ambiguous_with:
        return "No other effect that was fitted explains the recordings as well."
    return f"The recordings cannot tell it from: {listed([words(e) for e in finding.ambiguous_with], 6)}."


def decisive(finding: Finding) -> list[str]:
    """What would decide between a finding and those that the data cannot tell from it."""
    return [f"{words(e)}: {clean(finding.confused_with[e])}"
            for e in finding.ambiguous_with if e in finding.confused_with]  # fmt: skip


def improvement(diagnosis: Diagnosis) -> str:
    """Chi-square per sample of the recordings that judge: of all channels, and of those in which findings show."""
    shown = {plain_channel(channel) for finding in diagnosis.findings for channel in finding.channels}
    for is_held_out, name in ((True, "held out"), (False, "in training; none was held out")):
        mean = mean_chi_square(diagnosis.fit, is_held_out)
        if mean:
            part = [f for f in diagnosis.fit if f.channel in shown and f.is_held_out == is_held_out]
            is_part = 2 * len(part) < sum(f.is_held_out == is_held_out for f in diagnosis.fit)
            own = mean_chi_square(part, is_held_out) if is_part else None
            where = f"; where findings show most: {_course(own)}" if own else ""
            return f"chi-square per sample ({name}), all channels: {_course(mean)}{where}{_own_day(diagnosis)}"
    return "no recording was judged"


def _own_day(diagnosis: Diagnosis) -> str:
    """The same with what belongs to the held-out day alone taken as unknown: it says nothing of the model."""
    samples = sum(f.samples for f in diagnosis.fit if f.is_held_out)
    if not diagnosis.foretold or not samples:
        return ""
    told = {stage: value / samples for stage, value in diagnosis.foretold.items()}
    return f"; with the room and the start of that day taken as unknown: {_course(told)}"


def _course(mean: Mapping[str, float]) -> str:
    return ", ".join(f"{number(mean[stage])} {_STAGE[stage]}" for stage in STAGES if stage in mean)


_STAGE = {"before": "before", "recalibrated": "recalibrated only", "after": "after"}


def sureness(diagnosis: Diagnosis) -> str:
    """Margin and false alarms."""
    margin = f"An effect had to lower -2 log posterior by more than {number(diagnosis.margin)}"
    if not diagnosis.findings:
        return f"{margin}; none was accepted."
    gains = listed([number(f.gain) for f in diagnosis.findings], 4)
    chance = f"Chance alone gives the first in {percent(diagnosis.false_alarm_rate)} of cases"
    against = ", but held-out recordings refute it" if diagnosis.verdict is Verdict.CANNOT_TELL else ""
    return f"{margin}; found: {gains}. {chance}{against}."


def structure(diagnosis: Diagnosis) -> str:
    """What is left in the residuals."""
    return (
        f"Largest standardised sum of residuals: {number(abs(diagnosis.structure_before))} after recalibration, "
        f"{number(abs(diagnosis.structure_after))} at the end."
    )


def effort(diagnosis: Diagnosis) -> str:
    """Time, simulations and seed."""
    return f"{duration(diagnosis.seconds)}, {diagnosis.simulations} simulations, seed {diagnosis.seed}"
