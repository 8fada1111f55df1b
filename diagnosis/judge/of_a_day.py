"""Terms that belong to one day or one recording: which readings can judge them, and when a fault stands out at all.

A fault of one recording, or a draught of one day, says nothing about another. That no other recording shows it is then
no reason to refuse it; every other reading of its own recording judges it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import AnyArray
from diagnosis.faults.law import LASTING, OF_THE_RIG, is_one_of
from diagnosis.judge.unfitted import Readings, raw_residuals, readings_of
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.problem import Point, Term

#: Root mean squares of what the model leaves of a channel elsewhere by which a fault must stand out there. Of errors
#: that are normally distributed one in 370 is larger.
STANDS_OUT = 3.0
#: Why a fault of a whole recording is none of a while.
_WHOLE = (
    "it lasts for the whole recording, so that no reading outside tells a fault of a while from a lasting one: "
    "a zero that is off (gauge for absolute, say) is estimated where `bias_bound` of its channel is stated"
)
_WHOLE_OF_RIG = (
    "it lasts for the whole recording, so that no reading outside tells a change for a while from a number that is "
    "another in this recording: give it under `overrides` there"
)


def is_shown_there_alone(
    term: Term, values: Sequence[float], model: DiagnosisModel, judge: DiagnosisModel | None
) -> bool:
    """Whether no recording that was held out can show a term, so that readings of its own recording have to judge it.

    That is so of a fault of one recording; of what belongs to a day that no held-out recording has; and of what sets in
    after all of these were made. A drift that is the same in all recordings is in those held out too, and they judge.

    Args:
        term: A term that was fitted.
        values: Of its parameters.
        model: Model of the training recordings.
        judge: Of those held out; None where stretches of the training judge.
    """
    if term.recording is not None:
        return True
    effect, place = model.where(term)
    is_event = any(p.is_instant for p in term.parameters)
    if not is_event and not effect.is_of_a_day:
        return False
    if judge is None:
        return effect.is_of_a_day and (is_event or place.day is not None)
    return not judge.is_moved_by(term, values)


def _elsewhere(readings: Readings, number: int) -> AnyArray:
    """Readings of the same channel in other recordings."""
    name = readings.channels[number].name
    same = [n for n, one in enumerate(readings.channels) if one.name == name and n != number]
    return np.asarray(np.isin(readings.channel, same))


def hidden_fault(model: DiagnosisModel, point: Point, term: Term) -> str:
    """Why a fault with begin and end does not stand out from what the model leaves elsewhere; empty if it does.

    A box within a recording fills any gap of a wrong model. So a fault has to change a channel by at least `STANDS_OUT`
    times the root mean square of what is left of that channel outside its interval. Of an input, which several channels
    show, the one in which it stands out most counts. A drift, a lag or a clock may last for the whole recording; it is
    compared with what is left of the channel in other recordings then.

    Args:
        model: Model of the training recordings.
        point: A fit with the fault.
        term: The fault; its parameters are its strength, begin and end.
    """
    if term.recording is None:
        return ""
    _, begin, end = point.terms[term][:3]
    inner = model.plain
    left = raw_residuals(inner, point)
    change = raw_residuals(inner, point.without(term)) - left
    readings = readings_of(model.runs, [""] * len(model.runs))
    time = np.asarray(model.layout.time)[readings.chosen]
    left, change = left[readings.chosen], np.abs(change[readings.chosen])
    most, worst, is_whole = 0.0, "", True
    for number, recording in enumerate(readings.of_channel):
        own = readings.channel == number
        if recording != term.recording or not change[own].any():
            continue
        outside = own & ((time < begin) | (time > end)) & ~readings.is_wild
        if is_one_of(term.identifier, LASTING) and not outside.any():
            outside = _elsewhere(readings, number) & ~readings.is_wild
        if not outside.any():
            continue
        is_whole = False
        size, rest = float(change[own].max()), float(np.sqrt(np.mean(left[outside] ** 2)))
        if size >= STANDS_OUT * rest:
            return ""
        if size / rest > most:
            most, worst = size / rest, readings.channels[number].name
    if is_whole and change.any():
        return _WHOLE_OF_RIG if is_one_of(term.identifier, OF_THE_RIG) else _WHOLE
    where = f" of {worst}" if worst else ""
    return (
        f"it does not stand out: it changes the readings{where} by {most:.1f} times what the model leaves of them "
        f"outside its interval, {STANDS_OUT:.0f} times would be needed"
    )
