"""What is told where the verdict is `cannot tell`: what is left or suggested, why it is open, and what would decide."""

from __future__ import annotations

from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.location import Remainder
from diagnosis.report.display import clean, number, span, words
from diagnosis.report.sentences import improvement, when, where

#: What would decide about findings that the recordings held out refute.
_AFTER_REFUTATION = (
    "Record a training programme once more, with the rig as it is now, and hold that out. If what is suggested "
    "foretells it worse too, the rig has changed since the training; if better, the law holds for that programme alone "
    "and stands for something else."
)
#: What would decide about structure that no effect explains.
_UNEXPLAINED = (
    "Repeat that recording: what comes back in the same channel and window belongs to the rig, what does not was a "
    "disturbance. A second sensor there tells the sensor from the rig."
)


def is_refuted(diagnosis: Diagnosis) -> bool:
    """Whether findings of the training are listed that the recordings held out speak against."""
    return diagnosis.verdict is Verdict.CANNOT_TELL and bool(diagnosis.findings)


def suggested(diagnosis: Diagnosis) -> list[str]:
    """Findings that are not accepted: effect, place and time of each."""
    names = [words(f.effect) if f.is_named else "an effect without a name" for f in diagnosis.findings]
    return [f"{name}; {where(f)}; {when(f)}" for name, f in zip(names, diagnosis.findings)]


def remainder(left: Remainder) -> str:
    """Where something is left, and how far it is beyond noise."""
    place = f"{clean(left.channel)}, {span(left.begin, left.end)}"
    return f"{place}: {number(abs(left.z))} deviations, noise stays below {number(left.limit)}"


def why(diagnosis: Diagnosis) -> str:
    """Why it cannot be told."""
    if diagnosis.findings:
        return f"it makes what was held out fit worse: {improvement(diagnosis)}"
    departing = [one for one in diagnosis.locations if not one.is_noise]
    alone = ""
    if departing:
        alone = f"; driven alone, {clean(departing[0].element)} departs most ({clean(departing[0].unit)})"
    elif diagnosis.locations:
        alone = "; no unit departs when it is driven alone"
    return f"no effect lowers -2 log posterior by more than chance may, {number(diagnosis.margin)}{alone}"


def what_decides(diagnosis: Diagnosis) -> str:
    """What to do next; nothing where an experiment was designed for all that is open."""
    if diagnosis.findings:
        return _AFTER_REFUTATION
    return "" if diagnosis.next_experiment is not None else _UNEXPLAINED


def model_note(diagnosis: Diagnosis) -> str:
    """What is in the model that was written, where that is no accepted finding."""
    if is_refuted(diagnosis):
        return "with what is suggested, which is not accepted"
    return "" if diagnosis.findings else "recalibrated, nothing added"
