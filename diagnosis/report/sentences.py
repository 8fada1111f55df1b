"""Sentences that the page and the terminal share."""

from __future__ import annotations

import math
from collections.abc import Mapping

from diagnosis.judge.diagnosis import FAR, MOVED, Diagnosis, Doubt, Finding, Moved, Standing, Used, Verdict
from diagnosis.report.display import UNKNOWN, clean, duration, listed, number, percent, user_unit, words
from diagnosis.report.display import moved as shown_move
from diagnosis.report.fits import STAGES, mean_chi_square, plain_channel
from diagnosis.report.user_units import IN_SI, Units
from diagnosis.search.posterior import HUBER

#: What follows from a verdict.
ADVICE = {
    Verdict.CONSISTENT: "Nothing that was tried needs to be added to the model.",
    Verdict.RECALIBRATED: "Parameters of the model were off; nothing that was tried needs to be added.",
    Verdict.RECORDING_FAULT: "Correct the recording or the scenario first; nothing was concluded about the physics.",
    Verdict.MEASUREMENT_FAULT: "Repair or model what is at fault before the physics is changed.",
    Verdict.MISSING_PHYSICS: "Place and times are below.",
    Verdict.UNNAMED_PHYSICS: "The formula describes it within these recordings; a name for it is left to a person.",
    Verdict.CANNOT_TELL: "Trust neither the model nor a correction of it where it departs from these recordings.",
}


def where(finding: Finding) -> str:
    """Unit, place, and elements unless the place names them; what has no name is only described there."""
    elements = listed([e for e in finding.elements if e not in finding.places.split(" or ")], 6)
    told = f"{finding.unit}: {clean(finding.places)}" + (f" ({elements})" if elements else "")
    return f"described at {told}" if finding.standing is Standing.UNNAMED else told


#: Odds of 20 to 1: with them nothing else would be in question.
LIKELY = 0.95
#: Parameters that say when a law acts.
_INSTANTS = ("instant", "begin", "end")


def when(finding: Finding, most: int = 4, units: Units = IN_SI) -> str:
    """Intervals of a finding, in the recording that shows it most.

    Of a law with an instant, or with begin and end, that is when it acts; of any other, where it is seen.
    """
    told = listed(units.spans(finding.intervals), most) or UNKNOWN
    onset = next((p for p in finding.parameters if p.name == "instant"), None)
    if onset is not None and finding.intervals:
        where = f" of {clean(finding.recording)}" if finding.recording else ""
        return f"from {units.estimate(onset)}{where} on"
    if not any(p.name in _INSTANTS for p in finding.parameters):
        told = f"seen {told}" if finding.intervals else told
    return f"{told} of {clean(finding.recording)}" if finding.recording else told


def what(finding: Finding) -> str:
    """Effect and how probable it is; odds between those that meet the readings alike would rest on their numbers."""
    name = words(finding.effect)
    others = [a.probability for a in finding.alternatives if a.effect != finding.effect]
    is_even = finding.probability > LIKELY or finding.probability <= max(others, default=0.0)
    if finding.standing is Standing.CLASS and is_even and not finding.members:
        return f"one of several that meet the training readings nearly as well; described by {name}"
    if finding.standing is Standing.UNNAMED:
        name = f"no name; described by {name}"
    elif finding.standing is Standing.CLASS:
        name = f"one of several, {name} the most probable"
    return f"{name}, probability {percent(finding.probability)} among all that were fitted in its place"


def ambiguity(finding: Finding) -> str:
    """What the data cannot tell from a finding."""
    if finding.members:
        told = [f"{words(m.effect)} at {clean(m.place)}" for m in finding.members]
        others = [words(e) for e in finding.ambiguous_with if e not in {m.effect for m in finding.members}]
        more = f" Nor from: {listed(others, 6)}." if others else ""
        return f"The recorded channels show the same of: {listed(told, 6)}.{more}"
    if not finding.ambiguous_with:
        return "Every other effect that was fitted in its place has odds of less than 1 to 20."
    others = [_with_place(finding, e) for e in finding.ambiguous_with]
    return f"The recordings cannot tell it from: {listed(others, 6)}."


def _with_place(finding: Finding, effect: str) -> str:
    """Another effect that meets the readings as well, with its place where that is not the finding's."""
    places = [a.place for a in finding.alternatives if a.effect == effect and a.place]
    if not places or finding.place in places or finding.place.split(" (")[0] in places:
        return words(effect)
    return f"{words(effect)} at {clean(places[0])}"


def searched(diagnosis: Diagnosis) -> str:
    """What was tried, by domain, and what could not be tried."""
    tried = [
        f"{d.name}: {_counted(d.laws, 'law')} ({d.generic} without a name) at {_counted(d.places, 'place')}"
        for d in diagnosis.searched.domains
    ]
    parts = ["; ".join(tried) if tried else "no law was tried"]
    if diagnosis.searched.untried:
        parts.append("not tried: " + listed(list(diagnosis.searched.untried), 4))
    return "; ".join(parts)


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def decisive(finding: Finding) -> list[str]:
    """What would decide between a finding and those that the data cannot tell from it."""
    return [
        f"{words(e)}: {clean(finding.confused_with[e])}" for e in finding.ambiguous_with if e in finding.confused_with
    ]


def improvement(diagnosis: Diagnosis) -> str:
    """Chi-square per sample of the recordings that judge: of all channels, and of those in which findings show."""
    lasting = [
        f for f in diagnosis.findings if not f.effect.endswith("_in_interval")
    ]  # others are in no other recording
    shown = {plain_channel(channel) for finding in lasting for channel in finding.channels}
    for is_held_out, name in ((True, "held out"), (False, "in training; none was held out")):
        mean = mean_chi_square(diagnosis.fit, is_held_out)
        if mean:
            part = [f for f in diagnosis.fit if f.channel in shown and f.is_held_out == is_held_out]
            is_part = 2 * len(part) < sum(f.is_held_out == is_held_out for f in diagnosis.fit)
            own = mean_chi_square(part, is_held_out) if is_part else None
            where = f"; where findings show most: {_course(own)}" if own else ""
            right = diagnosis.adequacy
            is_fitted = len({mean.get(stage) for stage in STAGES}) > 1
            is_of_day = right is not None and bool(right.day or right.needs_day)
            if is_held_out and is_fitted and right is not None and is_of_day:  # what judged is not what the rows hold
                name += ", numbers of the day as written down"
                where += f"; with those numbers estimated, as judged: {_course(right.chi_square)}"
            return f"chi-square per sample ({name}), all channels: {_course(mean)}{where}"
    return "no recording was judged"


def _course(mean: Mapping[str, float]) -> str:
    if len({mean.get(stage) for stage in STAGES}) == 1:  # nothing was fitted
        return f"{number(mean[STAGES[0]])} by the scenario as given (nothing was fitted)"
    return ", ".join(f"{number(mean[stage])} {_STAGE[stage]}" for stage in STAGES if stage in mean)


_STAGE = {"before": "before", "recalibrated": "recalibrated only", "after": "after"}


def sureness(diagnosis: Diagnosis) -> str:
    """What an effect had to gain, in training and on readings that it was not fitted to."""
    if diagnosis.verdict is Verdict.RECORDING_FAULT:
        return "Nothing was fitted and nothing was searched."
    margin = f"In training an effect had to lower -2 log posterior by more than {number(diagnosis.margin)}"
    if not diagnosis.findings:
        return f"{margin}, which chance may give; no effect that did is accepted or suggested."
    gains = listed([number(f.gain) for f in diagnosis.findings], 4)
    basis = diagnosis.adequacy.basis if diagnosis.adequacy else "readings that it was not fitted to"
    by: dict[str, list[str]] = {}  # readings that judge to gains on them
    for f in diagnosis.findings:
        by.setdefault(f.judged_by or basis, []).append(fall(f.held_out_gain))
    judged = "; ".join(f"{listed(falls, 4)} ({name})" for name, falls in by.items())
    chance = f"; noise alone gives the first gain in {percent(diagnosis.false_alarm_rate)} of searches"
    if diagnosis.false_alarm_rate >= 1.0:  # a fault that was found beside a search without a first effect: not asked
        chance = ""
    return f"{margin}: {gains}{chance}. -2 log likelihood of readings that judge {judged}."


def fall(gain: float) -> str:
    """A gain as what it does to -2 log likelihood."""
    return f"rises by {number(-gain)}" if gain < 0.0 else f"falls by {number(gain)}"


def structure(diagnosis: Diagnosis) -> str:
    """What is left in the residuals."""
    if diagnosis.verdict is Verdict.RECORDING_FAULT:
        return "Residuals were not looked at."
    return (
        f"Largest standardised sum of residuals, each counted as {HUBER:g} deviations at most: "
        f"{number(abs(diagnosis.structure_before))} after recalibration, {number(abs(diagnosis.structure_after))} at "
        "the end."
    )


def effort(diagnosis: Diagnosis) -> str:
    """Time, simulations and seed."""
    return f"{duration(diagnosis.seconds)}, {diagnosis.simulations} simulations, seed {diagnosis.seed}"


def readings_text(recording: Used) -> str:
    """How many readings were compared: `40000 of 6000000` where some were left out because there were so many."""
    return (
        f"{recording.readings} of {recording.readings + recording.thinned}"
        if recording.thinned
        else str(recording.readings)
    )


def thinning(diagnosis: Diagnosis) -> str:
    """That readings were left out because there were so many; empty where none were."""
    thinned = [r for r in diagnosis.recordings if r.thinned]
    if not thinned:
        return ""
    told = listed([f"{readings_text(r)} in {clean(r.title)}" for r in thinned], 3)
    return f"Of very many readings a part was used, at even distances and as they are: {told}."


#: Zero of a clock [s] from which it counts from a date, which no person reads in seconds.
EPOCH = 1e8


def clocks(diagnosis: Diagnosis, units: Units = IN_SI) -> str:
    """From when times are counted, where that is not the zero of a table's own clock; empty where it is."""
    shifted = [r for r in diagnosis.recordings if 0.0 < abs(r.zero) < EPOCH]
    if not shifted:
        return ""
    told = listed([f"{units.text(r.zero, 's')} of {clean(r.title)}" for r in shifted], 4)
    return f"Times are counted from the scenario's zero; in the clock of its table that is {told}."


def moved_text(moved: Moved, units: Units = IN_SI) -> str:
    """How far a number was moved, its value where that is known, and whether that is no measurement."""
    preferred = user_unit(moved.unit, units.written)
    told = shown_move(moved.name, moved.amount, moved.is_factor, moved.unit, preferred)
    if math.isfinite(moved.value):
        told += f", that is {units.text(moved.value, moved.value_unit, is_difference=False)}"
    far = f"{number(abs(moved.deviations), 2)} prior deviations"
    if moved.is_at_bound:
        far += ", at its bound"
    why = "" if moved.is_measured else ": no measurement of it"
    return f"{told} ({far}{why})"


def moved_most(diagnosis: Diagnosis, units: Units = IN_SI, most: int = 3) -> str:
    """Parameters that ended at their bound or far from their prior; empty where none did."""
    far = [m for m in diagnosis.recalibration if not m.is_measured]
    if not far:
        return ""
    which = "1 parameter" if len(far) == 1 else f"{len(far)} parameters"
    told = "; ".join(moved_text(m, units) for m in far[:most])
    more = f"; and {len(far) - most} more" if len(far) > most else ""
    return (
        f"{which} of the model ended at a bound or at least {FAR:g} prior deviations from the scenario's value, where "
        f"a fitted value is no measurement: {told}{more}"
    )


def moved_heading(diagnosis: Diagnosis) -> str:
    """What the list of moved parameters holds, and how many."""
    count = len(diagnosis.recalibration)
    which = "1 parameter is" if count == 1 else f"{count} parameters are"
    return (
        f"In the model that was judged {which} more than {MOVED:g} prior deviations from the scenario's value, or at a "
        "bound:"
    )


def doubt_text(doubt: Doubt) -> str:
    """What the check of a recording saw, and what to do about it."""
    remedy = clean(doubt.remedy)
    where = f"{clean(doubt.recording)}, {clean(doubt.subject)}" if doubt.subject else clean(doubt.recording)
    return f"{where}: {clean(doubt.statement).rstrip('.')}. {remedy[:1].upper()}{remedy[1:]}"
