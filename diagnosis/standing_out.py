"""A recording that stands out beside numbers that were fitted to the others, seen before any search.

Numbers that are off hide that one recording is missed (`diagnosis.check.odd_one_out` compares with the scenario as it
is). Once they are fitted to the other recordings, and these are met, it shows, and so does whether a fault of one
sensor would explain it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

from diagnosis.check.beside import Compared
from diagnosis.check.changed_rig import changed_rig
from diagnosis.check.exchanged_inputs import exchanged_inputs
from diagnosis.check.late_input import late_input
from diagnosis.check.odd_one_out import ALL_CHANNELS, MET, SAME, TIMES, as_explained, comparable, left, left_beside
from diagnosis.check.other_course import other_course
from diagnosis.check.other_number import other_number
from diagnosis.check.sensor_of_one import explained_by_sensor
from diagnosis.check.size_of_input import size_of_input
from diagnosis.check.timing import percent
from diagnosis.check.unit_of_input import unit_of_input
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import ODD
from diagnosis.refitted import Refitted

_FITTED = "with numbers fitted to the others"
_RIG = (
    "look at this recording's input, start and day first; a law that is missing, or a number that the others do not "
    "determine, shows in it alone where it alone reaches that, and a law where the numbers of the others took it up"
)
_SENSOR = (
    "look at this sensor, its amplifier and its column first; a number, an input or a law that this recording alone "
    "has may look alike in one channel"
)


def apart_once_refitted(refitted: Refitted, known: Collection[str] = ()) -> list[Doubt]:
    """Doubts about recordings that stand out, one each; serious where one of its inputs alone explains it.

    Of a recording of the training the others are those that its numbers are fitted to, and those held out; of one
    held out each other recording is predicted with numbers that were not fitted to it either.

    Args:
        refitted: The recordings beside fitted numbers.
        known: Titles of recordings of which it is known already.

    Returns:
        None where there are fewer than three recordings, or where a fit takes minutes.
    """
    if not refitted.is_of_use or not refitted.has_unfitted:
        return []
    found = []
    for number, title in enumerate(refitted.titles):
        if title in known:
            continue
        every = refitted.by_others(title) if title in refitted.fitted else refitted.foreseen
        told = _apart(*_parted(every, number)) if every else None
        if told is not None:
            doubt, is_of_sensor = told
            found.append(doubt if is_of_sensor else _of_rig(refitted, number) or doubt)
    return found


def _parted(every: Sequence[Compared], number: int) -> tuple[Compared, list[Compared]]:
    """One recording, and the others."""
    return every[number], [o for i, o in enumerate(every) if i != number]


def _of_rig(refitted: Refitted, number: int) -> Doubt | None:
    """What was another in a recording that stands out, as the check asks beside the scenario as it is: an input, a
    number, or something of the rig for a while.

    It is serious where one input alone does, and no number: numbers are fitted here, and one may be off that the others
    do not determine.
    """
    every = refitted.restated(refitted.titles[number])
    if not every:
        return None
    one, others = _parted(every, number)
    of_all = (exchanged_inputs, unit_of_input, size_of_input, partial(other_course, least=0.0))
    told = late_input(one) or next((d for ask in of_all if (d := ask(one, others))), None)
    own = other_number(one, others)
    if told is None:
        own = own or changed_rig(one, others)
        return None if own is None else _beside_fitted(own, "", is_serious=False)
    also = "" if own is None else f"; another {own.subject} in this recording does as well"
    return _beside_fitted(told, also, told.is_serious and own is None)


def _beside_fitted(doubt: Doubt, also: str, is_serious: bool) -> Doubt:
    """A doubt of the check, told of the scenario with fitted numbers and not of the scenario as it is."""
    return replace(doubt, statement=f"{_FITTED}, {doubt.statement}{also}", is_serious=is_serious)


def _apart(one: Compared, others: Sequence[Compared]) -> tuple[Doubt, bool] | None:
    """A doubt about a recording beside others that are met, and whether a fault of one sensor explains it.

    None where it does not stand out.

    Args:
        one: Beside numbers that were not fitted to it.
        others: Beside the same.
    """
    mine, theirs = left_beside(one, others, left)
    channels = comparable(one)
    if not channels or theirs > 1.0 - MET or mine < max(TIMES * theirs, SAME) or not all(map(comparable, others)):
        return None
    told = f"at least {percent(1.0 - theirs)} of the variance of each other recording that can be compared"
    text = f"{_FITTED} the scenario explains {told} and {percent(max(1.0 - mine, 0.0))} of "
    text += "this one's"
    missed = [n for n, b in channels.items() if left(b, b.simulated_there) > as_explained(theirs)]
    subject, remedy, begin, end, sensor = ALL_CHANNELS, _RIG, one.begin, one.end, None
    if len(missed) == 1:
        (subject,) = missed
        text += f", where {subject} alone is missed" if len(channels) > 1 else ""
        sensor = explained_by_sensor(channels[subject], as_explained(theirs), one.units_of(subject))
        if sensor is not None:
            text += f"; as if this sensor {sensor.what}, it is {percent(1.0 - sensor.left)}"
            remedy, begin, end = _SENSOR, sensor.begin, sensor.end
    z = math.sqrt(mine / max(theirs, 1e-12))
    return Doubt(one.recording.title, subject, ODD, text, remedy, False, begin, end, z), sensor is not None
