"""What is said where nothing is accepted: what is left or suggested, why it is open, and what would decide."""

from __future__ import annotations

import math

from diagnosis.judge.diagnosis import Diagnosis, Finding, Standing, Verdict
from diagnosis.judge.doubts import is_of_an_interval, waits
from diagnosis.judge.location import Remainder
from diagnosis.report.display import clean, number, words
from diagnosis.report.sentences import when, where
from diagnosis.report.user_units import IN_SI, Units

#: What would decide about findings that other readings do not confirm.
_UNCONFIRMED = (
    "Record a programme of the training once more and hold that out. If what is suggested predicts the repeat worse "
    "too, it does not hold beyond the recordings that it was fitted to; why not (chance, the day, the rig) stays open. "
    "If better, it holds for that programme and not for what was held out here: its form is then in doubt."
)
#: The same where findings wait for something that the check of the recordings saw.
_FIRST = "Clear first what the check of the recordings saw, see the reason beside each suggestion; then diagnose again."
#: What would decide where the readings scatter more than their noise is taken to be.
_NOISIER = "Correct `noise` of these channels in recording.yaml, or leave it out: then it is estimated. Diagnose again."
#: The same where no noise was stated.
_NOISIER_UNSTATED = (
    "State `noise` of these channels in recording.yaml, from the data sheet or from readings at rest: it was estimated "
    "from neighbouring readings. Diagnose again."
)
#: The same where stretches of the training judged.
_UNJUDGED = (
    "Record another programme and hold that out: what is suggested is in the rig if it predicts that better, and "
    "stands for something else if not."
)
#: The same of a fabric whose readings are predicted better with what is suggested, by no more than it scatters.
_WITHIN = (
    "Record a motion in which it would move the fabric by more than equal fabrics differ by, with more heat or load or "
    "of more markers: what is suggested predicts these readings better, but by no more than such fabrics differ by."
)
#: The same where an error of the macro-step moves readings as far as what is suggested.
_SHORTER = (
    "Halve time.macro_step until simulations change by less than the noise, and diagnose again: what is suggested "
    "moves readings no farther than that error may."
)
#: What would decide where a law gains as much as changes of inputs that came before their rows.
_MORE_ROWS = (
    "Record the inputs with shorter rows, or a row at each of their changes, and diagnose again: what is suggested "
    "explains no more than changes that came up to a row earlier than they stand in the table."
)
#: What would decide about a fault with begin and end, which no other recording can show.
_OF_ONE_RECORDING = (
    "Repeat the recording of the fault with a second sensor beside the one that is suspected: a fault of a sensor does "
    "not come back in both, and what does belongs to the rig."
)
#: What would decide about structure that no effect explains.
_UNEXPLAINED = (
    "Repeat the recording in which most is left: what comes back in the same channel and window belongs to the rig, "
    "what does not was a disturbance. A second sensor there tells the sensor from the rig."
)

#: The same where it comes back already.
_COMES_BACK = (
    "What is left is in {count} of {every} training recordings, so it belongs to the rig or to what all of them share. "
    "A second sensor of that quantity tells the sensor from the rig; a programme of other sizes and speeds tells what "
    "it depends on."
)

#: The same where neighbouring readings differ by less than their stated noise: it may last for several readings.
_LASTING = (
    "What is left may be noise that lasts for several readings. Record the rig while nothing acts on it: what readings "
    "scatter by there, and for how long they stay alike, is of the sensors. State that noise, or read at longer "
    "intervals; diagnose again."
)


def suggested(finding: Finding, units: Units = IN_SI) -> str:
    """A finding that is not accepted: effect, place and time, and why it is not accepted."""
    name = "an effect without a name" if finding.standing is Standing.UNNAMED else words(finding.effect)
    return f"{name}; {where(finding)}; {when(finding, units=units)}: {'; '.join(finding.doubts)}"


def remainder(left: Remainder, units: Units = IN_SI) -> str:
    """Where something is left, how much in the user's unit, and how far it is beyond noise."""
    place = f"{clean(left.channel)}, {units.span(left.begin, left.end)}"
    told = mean_left(left, units)
    size = f"{told} on average, " if told else ""
    return (
        f"{place}: {size}standardised sum of residuals at least {number(abs(left.z))}; {_NOISE[left.noise]} alone "
        f"stays below {number(left.limit)} in 99 of 100 recordings"
    )


#: What the residuals were divided by.
_NOISE = {
    "stated": "white noise as stated",
    "estimated": "white noise as estimated from neighbouring readings",
    "both": "white noise as stated or, where it is not, as estimated from neighbouring readings",
    "": "white noise",
}


def mean_left(left: Remainder, units: Units) -> str:
    """Mean of measured minus simulated where something is left; empty where it is not known."""
    if not (left.unit and math.isfinite(left.mean)):
        return ""
    factor, unit = units.of(left.channel).difference(left.unit)
    return f"{factor * left.mean:+.3g} {unit}".strip()


def departing(diagnosis: Diagnosis) -> str:
    """Which unit departs most when it is driven alone; empty if that was not looked at."""
    if any(one.is_whole for one in diagnosis.locations):
        return ""
    beyond = [one for one in diagnosis.locations if not one.is_noise]
    if beyond:
        return f"driven alone, {clean(beyond[0].element)} departs most ({clean(beyond[0].unit)})"
    return "no unit departs when it is driven alone" if diagnosis.locations else ""


def what_decides(diagnosis: Diagnosis) -> str:
    """What to do next; nothing where an experiment was designed for what is open, or nothing is open."""
    if diagnosis.verdict is not Verdict.CANNOT_TELL:
        return ""
    if diagnosis.suggestions:
        if all(f.is_coarse for f in diagnosis.suggestions):
            return _SHORTER
        if all(f.is_within_rows for f in diagnosis.suggestions):
            return _MORE_ROWS
        if all(is_of_an_interval(f) for f in diagnosis.suggestions):
            return _OF_ONE_RECORDING
        if all(waits(f) for f in diagnosis.suggestions):
            return _FIRST
        if _is_within_scatter(diagnosis):
            return _WITHIN
        return _UNCONFIRMED if any(f.is_held_out for f in diagnosis.fit) else _UNJUDGED
    right = diagnosis.adequacy
    if right is not None and right.is_irregular:
        return _NOISIER if right.worst is None or right.worst.is_noise_stated else _NOISIER_UNSTATED
    if diagnosis.next_experiment is not None or not diagnosis.left:
        return ""
    return _LASTING if right is not None and right.noise_may_last else _of_the_rest(diagnosis)


def _is_within_scatter(diagnosis: Diagnosis) -> bool:
    """Whether simulations scatter and all that is suggested predicts the readings that judge better."""
    has_scatter = diagnosis.adequacy is not None and diagnosis.adequacy.has_scatter
    return has_scatter and all(f.held_out_gain > 0.0 for f in diagnosis.suggestions)


def _of_the_rest(diagnosis: Diagnosis) -> str:
    """What would decide about structure that no effect explains, which may be in one training recording or in more."""
    limit = diagnosis.left[0].limit
    training = [f for f in diagnosis.fit if not f.is_held_out]
    every = {f.recording for f in training}
    with_rest = {f.recording for f in training if abs(f.whiteness.get("after", 0.0)) > limit}
    if len(with_rest) < 2:
        return _UNEXPLAINED
    return _COMES_BACK.format(count=len(with_rest), every=len(every))


def model_note(diagnosis: Diagnosis) -> str:
    """What is in the model that was written, where that is no accepted finding."""
    if not all(is_of_an_interval(f) for f in diagnosis.accepted):  # faults of one recording are no part of a model
        return ""
    right = diagnosis.adequacy
    is_fitted = right is None or right.is_recalibrated
    note = "recalibrated, nothing added" if is_fitted else "as it was given: nothing fitted, nothing added"
    return f"{note}: a fault of one recording is no part of a model" if diagnosis.accepted else note
