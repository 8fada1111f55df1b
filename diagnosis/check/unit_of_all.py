"""A channel that all recordings state in another unit than it was written in, by its size before anything moves.

A drive that is stronger, or a number that is off, changes how far a channel moves. How large it is at the start, where
that is stated and is not zero, it does not change. Where the readings are as many times the simulation in both, and
that is the factor to another unit of the quantity, it is asked whether the unit is right.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.check import scale
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.unit_of_one import slope, stated_unit, units_near
from diagnosis.judge.diagnosis import Doubt

#: Largest deviation of ln(first reading / simulated start) from that of the factor: a start is stated as the scale
#: showed it.
LEVEL = 0.03
#: Deviations of its noise by which a start is away from zero, and that a channel moves by.
SEEN = 30.0
#: Recordings that have to say the same: one start may be stated wrongly.
RECORDINGS = 2
#: Quantities of which zero is a matter of the unit: a level says nothing there.
_WITHOUT_ZERO = ("K",)


@dataclass(frozen=True)
class _Size:
    """How large a channel is beside its simulation.

    Args:
        level: First readings over what is simulated there.
        moved: Slope of the readings in the simulation.
        stated: Unit that the recording states.
        units: Those in which both would be about 1.
    """

    level: float
    moved: float
    stated: str
    units: tuple[str, ...]


def units_of_all(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about the unit of a channel in all recordings, one for each recording; all are serious."""
    found: list[Doubt] = []
    for name in dict.fromkeys(n for one in every for n in one.channels):
        having = [one for one in every if name in one.channels]
        sizes = [s for one in having if (s := _size(one, name)) is not None]
        if len(having) < RECORDINGS or len(sizes) < len(having):
            continue
        common = [u for u in sizes[0].units if all(u in size.units for size in sizes)]
        if common:
            found += [_doubt(one, name, size, common) for one, size in zip(having, sizes)]
    return found


def _size(one: Compared, name: str) -> _Size | None:
    """How far a channel moves and where it starts; None where either says nothing."""
    beside = one.channels[name]
    base = beside.channel.unit
    moved = slope(beside)
    if base in _WITHOUT_ZERO or moved is None or not moved > 0.0 or np.ptp(beside.measured) < SEEN * beside.floor:
        return None
    level = _level(beside)
    if level is None:
        return None
    stated = stated_unit(one, name)
    by_level = units_near(level, stated, base, LEVEL)
    return _Size(level, moved, stated, tuple(u for u in units_near(moved, stated, base) if u in by_level))


def _level(beside: Beside) -> float | None:
    """How many times the simulated start the first readings are; None where one of them is nearly zero."""
    readings, _ = scale.first(beside)
    simulated = float(np.median(beside.at(beside.channel.times[: len(readings)])))
    measured = float(np.median(readings))
    if min(abs(measured), abs(simulated)) < SEEN * beside.floor or measured * simulated < 0.0:
        return None
    return measured / simulated


def _doubt(one: Compared, name: str, size: _Size, units: Sequence[str]) -> Doubt:
    text = (
        f"its first readings are {size.level:.3g} times what is simulated there and its changes {size.moved:.3g} times "
        f"the simulated ones, as if it were in {' or '.join(units)} and not in {size.stated}; so it is in every other "
        "recording that has it"
    )
    remedy = f"is `channels.{name}.unit` right, and is the start?"
    z = abs(float(np.log(size.level))) / LEVEL
    return Doubt(one.recording.title, name, "unit", text, remedy, True, one.begin, one.end, z)
