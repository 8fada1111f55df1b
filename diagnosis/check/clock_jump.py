"""A clock that was right up to an instant and is off by a constant from there on: it stood still, or was set.

The course of every channel is moved from the instant on, by the likelihood of `diagnosis.check.clock_shift`. A clock
that runs wrong is off by as much in the middle, and is no rival of one that jumped where readings are exact.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Compared
from diagnosis.check.clock_shift import (
    LONGEST,
    SUPPORT,
    asked,
    is_drawn,
    lag_grid,
    moved_shares,
    reading_step,
    spread_gain,
    timed_channels,
)
from diagnosis.check.jump import SIZES, TRIED, Jump, best_jump, offsets
from diagnosis.check.timing import critical


@dataclass(frozen=True)
class ClockJump(Jump):
    """What the readings say of a clock that jumps.

    Args:
        gained: What it gains in -2 log likelihood over no jump, both behind any lag.
        is_confirmed: Whether another channel than one says so.
        is_drawn: Whether the moved response draws nearly all of the readings, or the move takes away most of what is
            left.
    """

    gained: float
    is_confirmed: bool
    is_drawn: bool


def clock_jump(compared: Compared) -> ClockJump | None:
    """The jump of a recording's clock that gains most; None where chance gives as much.

    What one stretch between two switches says alone may be an event, and where several channels are asked, two have to
    say so and none the reverse.
    """
    leads = asked(compared)
    if not leads or not len(compared.switches()):
        return None
    span, least = compared.end - compared.begin, reading_step(leads)
    lags = lag_grid(least, LONGEST * span)
    plain = timed_channels(leads, np.zeros((1, 2)), lags)
    few = np.unique(np.concatenate([[0.0], *(lags[[int(t.deviance[0].argmin())]] for t in plain)]))

    def moves(jumps: Array) -> Array:
        return np.column_stack([np.zeros((len(jumps), 2)), jumps])

    def deviance(jumps: Array) -> Array:
        return np.asarray(np.sum([t.deviance.min(axis=1) for t in timed_channels(leads, moves(jumps), few)], axis=0))

    sizes = np.geomspace(least, LONGEST * span, SIZES)
    best = best_jump(compared.begin, compared.end, sizes, deviance)
    timed = timed_channels(leads, moves(np.array([[0.0, best.at], [best.size, best.at]])), lags)
    gains = [float(t.deviance[0].min() - t.deviance[1].min()) for t in timed]
    limit = critical(TRIED)
    if min(sum(gains), spread_gain(compared, timed, 0, 1)) <= limit or min(gains) < -critical(1.0):
        return None
    is_confirmed = sum(g > SUPPORT for g in gains) > 1
    if len(leads) > 1 and not is_confirmed:
        return None
    shares = moved_shares(leads, lambda times: times - offsets(times, best.size, best.at))
    return ClockJump(best.size, best.at, best.value, sum(gains), is_confirmed, is_drawn(shares))
