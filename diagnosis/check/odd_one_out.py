"""One recording that the scenario misses while it meets the others: what is wrong is of that recording alone.

A wrong number or a law that is missing acts in all recordings, if all of them reach where it acts. Where the scenario
as it is explains nearly all of the others and not this one, its input, its start or its day is another one. Which of
them, the readings need not show.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import ODD
from diagnosis.report.display import instant

#: Share of their variance that the scenario explains of the others, all numbers as they are.
MET = 0.95
#: What a doubt is about where it is not known what of the recording is off.
ALL_CHANNELS = "all channels"
#: How many times more of its variance is left of a recording that stands out, and how much of it at least: any model
#: leaves a hundredth (`diagnosis.check.beside.DISCREPANCY`).
TIMES, LEAST = 10.0, 0.01
#: Share of the variance of a channel that is left, scaled and shifted as suits best, of a recording one of whose
#: inputs hardly is the one that acted: the same numbers explain the others.
HALF = 0.5
#: Readings of a running median, so that two in a row do not move it; how many times the scatter a wild reading is off,
#: and the largest share of such; deviation of a normal distribution over its median absolute deviation.
WINDOW, WILD, MOST_WILD, MAD = 5, 6.0, 0.02, 1.4826
#: How many times what the others leave a recording may leave that is explained, and what is explained in any case.
ALIKE, SAME = 2.0, 1e-3
#: Share of the range of the others by which a recording may go beyond it, and how much faster it may change.
BEYOND, FASTER = 0.5, 2.0
#: Shares of a recording of which the first part is asked whether it is explained, the longest first: an experiment
#: that is another one is so from its begin. So many readings, and so much of the others' variance, a part has at least.
PARTS, FEWEST_READINGS, MOVED = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2), 24, 0.1
#: Other recordings that have to be met: one alone may be the odd one itself.
OTHERS = 2


@dataclass(frozen=True)
class _Left:
    """What the scenario leaves of a channel: as it is, and scaled and shifted as suits best.

    Args:
        name: Of the channel.
        as_is: Share of the variance.
        scaled: Share of the variance.
        size: Mean square, scaled and shifted, in the channel's unit.
    """

    name: str
    as_is: float
    scaled: float
    size: float


def odd_ones(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about recordings that stand out from the others, one each; serious where little of one is explained.

    Others are met as they are, or scaled and shifted where numbers are off. Then a recording in which little moves is
    no odd one: more of its variance is left, and no more of its unit. It is serious then only where it moves within
    what the others move within, so that no law acts in it alone.
    """
    channels = [_left(one) for one in every]
    found = []
    for number, (one, own) in enumerate(zip(every, channels)):
        others = [c for i, c in enumerate(channels) if i != number and c]
        if not own or len(others) < OTHERS:
            continue
        told = _told(own, others)
        if told is None:
            continue
        text, is_as_it_is, z = told
        worst = max(own, key=lambda c: c.scaled)
        if worst.scaled >= HALF:
            text += f", of {worst.name} at most {percent(1.0 - worst.scaled)} however it is scaled and shifted"
        remedy = (
            "a wrong number shows in all of them, and so does a missing law unless only this one reaches where it "
            "acts: look at this recording's input, start and day first"
        )
        rest = [o for i, o in enumerate(every) if i != number]
        is_alike = is_as_it_is or is_within(one, rest)
        is_serious = is_alike and worst.scaled >= HALF
        until = _met_until(one, rest, is_as_it_is) if is_serious else None
        if until is not None:
            text += f"; until {instant(until, 3)} s it does not stand out"
            remedy = (
                "what happened after that, to the rig, a sensor or an input? The search looks for events and for "
                "faults of a while"
            )
            is_serious = False
        title = one.recording.title
        found.append(Doubt(title, ALL_CHANNELS, ODD, text, remedy, is_serious, one.begin, one.end, z))
    return found


def _met_until(one: Compared, others: Sequence[Compared], is_as_it_is: bool) -> float | None:
    """Until when a recording that stands out does not [s]; None where it does from its begin.

    Args:
        one: The recording.
        others: Those that are met.
        is_as_it_is: Whether by the scenario as it is, or scaled and shifted as suits one of the others.
    """
    channels = comparable(one)
    same = {name: [o.channels[name] for o in others if name in comparable(o)] for name in channels}
    if not all(same.values()):
        return None
    lines = {name: [(1.0, 0.0)] if is_as_it_is else [_line(b) for b in there] for name, there in same.items()}
    usual = max(min(_part_left(b, x) for x in lines[name]) for name, there in same.items() for b in there)
    for share in PARTS:
        end = one.begin + share * (one.end - one.begin)
        moving = [name for name, beside in channels.items() if _moves(beside, same[name], end)]
        if not moving:
            return None
        left_there = max(min(_part_left(channels[name], x, end) for x in lines[name]) for name in moving)
        if left_there < max(TIMES * usual, LEAST):
            return float(end)
    return None


def _line(beside: Beside) -> tuple[float, float]:
    """Slope and offset from the simulation to the readings of a recording."""
    slope, offset = np.polyfit(beside.simulated_there, beside.measured, 1)
    return float(slope), float(offset)


def _moves(beside: Beside, same: Sequence[Beside], end: float) -> bool:
    """Whether a channel moves enough until then that what is left of it says something."""
    part = beside.measured[beside.times <= end]
    least = MOVED * max(float(np.var(b.measured)) for b in same)
    return len(part) >= FEWEST_READINGS and float(np.var(part)) >= least


def _part_left(beside: Beside, line: tuple[float, float], end: float = math.inf) -> float:
    """Share of the variance of the readings until then that is left by a line in the simulation."""
    part = beside.times <= end
    return _share(beside.measured[part], line[0] * beside.simulated_there[part] + line[1], beside.floor)


def _told(own: Sequence[_Left], others: Sequence[Sequence[_Left]]) -> tuple[str, bool, float] | None:
    """How a recording stands out, whether with all numbers as they are, and by how much; None if it does not."""
    mine, theirs = max(c.as_is for c in own), max(c.as_is for o in others for c in o)
    if theirs <= 1.0 - MET and mine >= max(TIMES * theirs, LEAST):
        told = f"at least {percent(1.0 - theirs)} of the variance of each other recording that can be compared"
        text = f"the scenario as it is explains {told} and {percent(max(1.0 - mine, 0.0))} of this one's"
        return text, True, float(np.sqrt(mine / max(theirs, 1e-12)))
    mine, theirs = max(c.scaled for c in own), max(c.scaled for o in others for c in o)
    if theirs > 1.0 - MET or mine < max(TIMES * theirs, LEAST) or not _is_larger(own, others):
        return None
    told = f"at least {percent(1.0 - theirs)} of the variance of each channel in each other recording"
    text = f"scaled and shifted as suits each channel best, the scenario explains {told}, and here as little as "
    return f"{text}{percent(1.0 - mine)}", False, float(np.sqrt(mine / max(theirs, 1e-12)))


def _is_larger(own: Sequence[_Left], others: Sequence[Sequence[_Left]]) -> bool:
    """Whether what is left of the channel that is explained least is larger in its unit too."""
    worst = max(own, key=lambda c: c.scaled)
    sizes = [c.size for o in others for c in o if c.name == worst.name]
    return bool(sizes) and worst.size >= TIMES * max(sizes)


def is_within(one: Compared, others: Sequence[Compared]) -> bool:
    """Whether readings and simulation of a recording go no farther, either way and per second, than those of others.

    A law that is missing and acts at large values, or in fast motion, may act in one recording alone.
    """
    for name, beside in comparable(one).items():
        there = [o.channels[name] for o in others if name in o.channels and o.channels[name].is_comparable]
        for mine, theirs in (
            (beside.measured, [b.measured for b in there]),
            (beside.simulated_there, [b.simulated_there for b in there]),
        ):
            if not theirs:
                return False
            low, high = min(float(np.min(v)) for v in theirs), max(float(np.max(v)) for v in theirs)
            margin = BEYOND * (high - low)
            if float(np.min(mine)) < low - margin or float(np.max(mine)) > high + margin:
                return False
        if _speed(beside) > FASTER * max(_speed(b) for b in there):
            return False
    return True


def _speed(beside: Beside) -> float:
    """Mean size of the simulated changes per second: the readings' own are noise where they are close together."""
    length = float(beside.times[-1] - beside.times[0])
    return float(np.sum(np.abs(np.diff(beside.simulated_there)))) / max(length, 1e-12)


def _left(one: Compared) -> list[_Left]:
    """What is left of each channel; empty where nothing can be compared."""
    shares = []
    for name, beside in comparable(one).items():
        scaled = scaled_left(beside, beside.simulated_there)
        size = scaled * float(np.var(beside.measured))
        shares.append(_Left(name, left(beside, beside.simulated_there), scaled, size))
    return shares


def comparable(one: Compared) -> dict[str, Beside]:
    """Channels whose noise is less of their variance than what a recording that is met may leave.

    They are without wild readings: one that is off alone, or two in a row, is no other input, number or sensor.
    """
    return {
        name: b
        for name, found in one.channels.items()
        if found.is_comparable and (b := _without_wild(found)).floor ** 2 < (1.0 - MET) * float(np.var(b.measured))
    }


def _without_wild(beside: Beside) -> Beside:
    """The channel without the readings that are off alone, or two in a row; all of them where these are many.

    Source: running medians, F. R. Hampel, J. Am. Stat. Assoc. 69 (1974) 383-393; median absolute deviation as a scale.
    """
    if "tame" not in beside.memo:
        misfit = beside.measured - beside.simulated_there
        apart = np.abs(misfit - median_filter(misfit, size=WINDOW, mode="nearest"))
        is_wild = apart > WILD * max(MAD * float(np.median(apart)), beside.floor)
        few = 0 < np.count_nonzero(is_wild) <= MOST_WILD * len(misfit)
        beside.memo["tame"] = replace(beside, pick=beside.pick[~is_wild]) if few else beside
    found = beside.memo["tame"]
    assert isinstance(found, Beside)
    return found


def left(beside: Beside, simulated: Array) -> float:
    """Share of a channel's variance that simulated readings leave, beyond what says nothing; infinite of a run that
    runs away."""
    if not np.isfinite(simulated).all():
        return math.inf
    return _share(beside.measured, simulated, beside.floor)


def _share(measured: Array, predicted: Array, floor: float) -> float:
    """Share of the variance of readings that a prediction leaves, beyond what says nothing."""
    rest = float(np.mean((measured - predicted) ** 2)) - floor**2
    return max(rest, 0.0) / float(np.var(measured))


def scaled_left(beside: Beside, simulated: Array) -> float:
    """The same, scaled and shifted as suits best."""
    if not np.isfinite(simulated).all():
        return math.inf
    moves = float(np.std(simulated)) > 0.0
    followed = float(np.corrcoef(beside.measured, simulated)[0, 1]) if moves else 0.0
    return max(1.0 - max(followed, 0.0) ** 2 - beside.floor**2 / float(np.var(beside.measured)), 0.0)


def most_left(channels: Iterable[Beside], share: Callable[[Beside, Array], float]) -> float:
    """Largest share of a channel's variance that the scenario as it is leaves; 1 of no channel.

    Args:
        channels: Of one recording, or of several.
        share: `left` or `scaled_left`.
    """
    return max((share(b, b.simulated_there) for b in channels), default=1.0)


def left_beside(
    one: Compared, others: Sequence[Compared], share: Callable[[Beside, Array], float]
) -> tuple[float, float]:
    """`most_left` of a recording, and of all others of the rig."""
    theirs = most_left((b for o in others for b in comparable(o).values()), share)
    return most_left(comparable(one).values(), share), theirs


def in_words(before: float, theirs: float) -> str:
    """What is explained of a recording that stands out, and of the others, scaled and shifted."""
    return (
        f"scaled and shifted as suits each channel best, the scenario explains as little as {percent(1.0 - before)} of "
        f"the variance of a channel of this recording, and at least {percent(1.0 - theirs)} in the other recordings"
    )


def as_explained(theirs: float) -> float:
    """What a recording may leave that is explained as well as others which leave so much."""
    return max(ALIKE * theirs, SAME)
