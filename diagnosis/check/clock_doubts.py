"""What is said of the clock of one recording: off, running wrong, or set on the way; or what else makes it seem so."""

from __future__ import annotations

import numpy as np

from diagnosis.check.beside import Compared
from diagnosis.check.clock_jump import ClockJump, clock_jump
from diagnosis.check.clock_shift import (
    SHIFTS,
    Shift,
    asked,
    clock_shift,
    direct_gain,
    event_gain,
    growth_gain,
    input_gain,
    is_drawn,
    moved_shares,
)
from diagnosis.check.explain import explains
from diagnosis.check.jump import REMEDY
from diagnosis.check.timing import between, critical, resolution
from diagnosis.judge.diagnosis import Doubt
from diagnosis.report.display import instant

#: What an event, and sensors that answer an input, are in words.
_ELSE = (
    "the rig responds by another size from some instant on",
    "the readings answer an input at once, before the body does",
    "the response to the same input changes in the course of the recording",
    "one input acts later or earlier than it is said to",
)
_FASTER = "the rig responds faster than the model says"


def shift_doubts(compared: Compared) -> list[Doubt]:
    """At most one doubt: the clock is off beyond its bound, or jumps, or a lag makes it seem so."""
    found = clock_shift(compared)
    if found is None:
        return []
    bound = max(resolution(compared, b.channel) for b in asked(compared))
    jump = _told_jump(compared, found, bound)
    if jump is not None:
        return [_jumped(compared, jump)]
    return _of_shift(compared, found, bound) if _is_followed(compared, found) else []


def _of_shift(compared: Compared, found: Shift, bound: float) -> list[Doubt]:
    """At most one doubt about a clock that is off throughout, or runs wrong.

    Args:
        compared: The recording.
        found: What the readings say of it.
        bound: Shifts up to which are no doubt [s].
    """
    slowest = max(b.channel.lag_bound for b in asked(compared))
    limit = critical(2.0 * SHIFTS)
    low, high = found.interval
    z = float(np.sqrt(max(found.gained, found.alone, 0.0)))
    where = compared.recording.title, "time", "dead time"
    over = compared.begin, compared.end, z
    # what one switch alone says may be an event beside it
    is_decisive = min(found.gained, found.spread) > limit
    if is_decisive and min(abs(low), abs(high)) > bound and low * high > 0.0:
        # what sets in in some time and stays may seem late, and what answers at once early
        is_late = found.size > 0.0 and not found.is_rate
        # what answers at once comes early
        at_once = 0.0 if is_late else direct_gain(compared)
        rivals = (event_gain(compared), at_once, growth_gain(compared, is_late), input_gain(compared, found))
        if max(rivals) > found.gained + limit:
            return []
        for rival, what in zip(rivals, _ELSE):
            if found.gained < rival + limit:
                return [_or_else(compared, found, over, what)]
        if not found.is_common:
            return [_of_one(compared, found, over)]
        if is_late:
            return [_late(compared, found, where, over)]
        if not is_drawn(_shares(compared, found)):
            return [_or_else(compared, found, over, _FASTER)]
        return [_decided(compared, found, where, over)]
    # a note names both explanations and chooses none: one test, no price for the shifts that were tried
    is_undecided = not found.is_rate and found.alone > critical(1.0) and abs(found.rival) < limit
    if is_undecided and low > bound and found.lag > max(slowest, bound):
        text = (
            f"the response comes late: a clock shift of {_size(found)} or a lag of {instant(found.lag, 3)} s "
            "cannot be told apart"
        )
        return [Doubt(*where, text, "state `offset_bound` or `lag_bound`, whichever is known", False, *over)]
    return []


def _told_jump(compared: Compared, found: Shift, bound: float) -> ClockJump | None:
    """The jump of a clock that explains more than a clock that is off and all else that makes readings late or early.

    Args:
        compared: The recording.
        found: What a clock explains that is off throughout, or runs wrong.
        bound: Shifts up to which are no doubt [s].
    """
    jump, limit = clock_jump(compared), critical(2.0 * SHIFTS)
    if jump is None or abs(jump.size) <= bound or jump.gained < max(found.gained, 0.0) + limit or not jump.is_drawn:
        return None
    rivals = (event_gain(compared), direct_gain(compared), growth_gain(compared), input_gain(compared, found))
    return jump if jump.gained > max(rivals) + limit else None


def _jumped(compared: Compared, jump: ClockJump) -> Doubt:
    """The doubt where the clock jumps."""
    over = compared.begin, compared.end, float(np.sqrt(jump.gained))
    weight = f"no clock that runs wrong explains as much: it gains {jump.gained:.3g} in -2 log likelihood"
    if not jump.is_confirmed:
        (beside,) = asked(compared)
        text = f"{jump.in_words(f'the readings of {beside.channel.name}')}; {weight}; no other channel can confirm it"
        return Doubt(compared.recording.title, "time", "clock", text, REMEDY, False, *over)
    text = f"{jump.in_words()}; {weight}"
    return Doubt(compared.recording.title, "time", "clock", text, REMEDY, True, *over)


def _is_followed(compared: Compared, found: Shift) -> bool:
    """Whether the readings follow the programme at all, as it is or moved, behind any lags.

    Of a response to something else some shift leaves a little less than none does, and says nothing of a clock.
    """
    return explains(0.0, float(np.median([max(pair) for pair in _shares(compared, found)])))


def _shares(compared: Compared, found: Shift) -> list[tuple[float, float]]:
    """Share of variance that the response explains of each channel that is asked, as it is and moved."""
    rate = found.rate * found.size if found.is_rate else 0.0
    shift = 0.0 if found.is_rate else found.size
    return moved_shares(asked(compared), lambda times: (times - shift) / (1.0 + rate))


def _decided(compared: Compared, found: Shift, where: tuple[str, str, str], over: tuple[float, float, float]) -> Doubt:
    """The doubt where no lag competes."""
    low, high = sorted(abs(v) for v in found.interval)
    weight = f"no lag explains as much: it gains {found.gained:.3g} in -2 log likelihood"
    if found.is_rate:
        fast = "fast" if found.size > 0 else "slow"
        low, high = (100.0 * found.rate * v for v in (low, high))
        text = f"the readings' clock runs {found.percent:.2g} % too {fast} ({low:.2g} to {high:.2g} %, 95 %); {weight}"
        remedy = "compare two instants that both clocks know; correct the column of times or its unit"
        return Doubt(where[0], where[1], "clock", text, remedy, True, *over)
    stated = max(b.channel.offset_bound for b in asked(compared))
    text = (
        f"the response comes {instant(abs(found.size), 3)} s earlier than {compared.drive} "
        f"({between(low, high)} s, 95 %), where at most {instant(stated, 3)} s are stated; {weight}"
    )
    remedy = "correct `time.zero` or the programme's times, or state the clock's `offset_bound`"
    return Doubt(*where, text, remedy, True, *over)


def _late(compared: Compared, found: Shift, where: tuple[str, str, str], over: tuple[float, float, float]) -> Doubt:
    """The doubt where the response comes late: a dead time and many lags in series make it late too."""
    low, high = found.interval
    text = (
        f"the response comes {instant(found.size, 3)} s later than {compared.drive} "
        f"({between(low, high)} s, 95 %), by more than one or two lags explain "
        f"({found.gained:.3g} in -2 log likelihood): a clock that is off, a dead time and many lags in series cannot "
        "be told apart"
    )
    remedy = "correct `time.zero` or the programme's times, or model the dead time"
    return Doubt(*where, text, remedy, False, *over, is_far=True)


def _size(found: Shift) -> str:
    """How far a clock is off, with its interval."""
    factor, unit = (100.0 * found.rate, "%") if found.is_rate else (1.0, "s")
    sign = 1.0 if found.size >= 0.0 else -1.0
    low, high = sorted(sign * factor * v for v in found.interval)
    return f"{factor * abs(found.size):.3g} {unit} ({low:.3g} to {high:.3g} {unit}, 95 %)"


def _or_else(compared: Compared, found: Shift, over: tuple[float, float, float], what: str) -> Doubt:
    """The doubt where something else explains as much: the search knows it."""
    way = "later" if found.size > 0.0 else "earlier"
    off = f"the response seems to come {way} than {compared.drive} by {_size(found)}"
    if found.is_rate:
        off = f"the readings' clock seems to run wrong by {_size(found)}"
    text = f"{off}, or {what}: these cannot be told apart"
    remedy = "compare two instants that both clocks know"
    return Doubt(compared.recording.title, "time", "clock", text, remedy, False, *over)


def _of_one(compared: Compared, found: Shift, over: tuple[float, float, float]) -> Doubt:
    """The doubt where one channel alone is off: the search knows such a fault, so that it is no other experiment."""
    asking = asked(compared)
    names = " and ".join(b.channel.name for b in asking)
    if found.is_rate:
        text = f"the times of {names} seem to be off by {_size(found)}: its own clock, or that of the recording"
    else:
        way, causes = ("later", ", or a dead time") if found.size > 0.0 else ("earlier", "")
        text = (
            f"the response of {names} comes {way} than {compared.drive} by {_size(found)}: the clock of the channel, "
            f"of the input or of the recording{causes}"
        )
    more = "no other channel can confirm it" if len(asking) == 1 else "not every channel shows the same"
    text = f"{text}; {more}"
    remedy = "compare two instants that both clocks know, or state the channel's `offset_bound`"
    return Doubt(compared.recording.title, "time", "clock", text, remedy, False, *over)
