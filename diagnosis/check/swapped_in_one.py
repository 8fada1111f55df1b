"""Two channels that are exchanged in one recording alone, seen beside the other recordings.

Where a rig's parts are much alike, their simulations differ by less than numbers of the scenario are off, and one
recording does not tell which column is which. But what the scenario misses of a channel it misses in every recording:
by a straight line from the simulation to the readings of the others each channel has an expectation of its own.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.judge.diagnosis import Doubt

#: Share of the squares of both channels that is left once they are exchanged, at most; and how many times their noise
#: they are off as they are.
LEFT, OFF = 0.25, 2.0
#: Other recordings that give the expectation: of two, either may be the wrong one.
OTHERS = 2


def swapped_in_one(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about pairs of channels of one unit in one recording; all are serious."""
    found = []
    for one in every:
        others = [o for o in every if o is not one]
        pairs = _pairs(one, others) if len(others) >= OTHERS else []
        taken: set[str] = set()
        for gain, first, second, told in sorted(pairs, reverse=True):
            if {first, second} & taken:
                continue
            taken |= {first, second}
            text = (
                f"the readings of {first} and {second} are each as the other one is expected to read, by the "
                f"simulation and the other recordings: exchanged they leave {told} of their squares"
            )
            remedy = "exchange these columns of this recording, or look at its sensors and drives: they read the same"
            title = one.recording.title
            found.append(Doubt(title, f"{first}, {second}", "swapped", text, remedy, True, one.begin, one.end, gain))
    return found


def _pairs(one: Compared, others: Sequence[Compared]) -> list[tuple[float, str, str, str]]:
    """Pairs that every other recording by itself says are exchanged: one of these may be the exchanged one.

    Returns:
        Root of the gain in squares of the noise, both channels, and what is left of them; by the other recording that
        speaks least for it.
    """
    found = [{(first, second): (gain, told) for gain, first, second, told in _pairs_by(one, o)} for o in others]
    common = set(found[0]).intersection(*found[1:])
    return [(gain, *pair, told) for pair in common for gain, told in (min(f[pair] for f in found),)]


def _pairs_by(one: Compared, other: Compared) -> list[tuple[float, str, str, str]]:
    """The same by one other recording."""
    lines = {n: line for n, b in one.channels.items() if _is_read(b) and (line := _line(n, other)) is not None}
    own = {n: _squares(one.channels[n], one.channels[n], line) for n, line in lines.items()}
    off = [n for n in lines if own[n] > (OFF * one.channels[n].floor) ** 2]
    found = []
    for first, second in itertools.combinations(off, 2):
        a, b = one.channels[first], one.channels[second]
        if a.channel.unit != b.channel.unit:
            continue
        left = _squares(a, b, lines[second]) / own[first], _squares(b, a, lines[first]) / own[second]
        if max(left) < LEFT:
            gain = sum((1.0 - s) * own[n] / one.channels[n].floor ** 2 for s, n in zip(left, (first, second)))
            found.append((float(np.sqrt(gain)), first, second, " and ".join(f"{100.0 * s:.2g} %" for s in left)))
    return found


def _is_read(beside: Beside) -> bool:
    return beside.is_comparable and beside.floor > 0.0


def _line(name: str, other: Compared) -> Array | None:
    """Slope and level of a channel's readings in its simulation, of another recording."""
    beside = other.channels.get(name)
    if beside is None or not _is_read(beside) or np.ptp(beside.simulated_there) == 0.0:
        return None
    return np.asarray(np.polyfit(beside.simulated_there, beside.measured, 1))


def _squares(readings: Beside, source: Beside, line: Array) -> float:
    """Mean square of what is left of a channel's readings, by the expectation of another one (or its own)."""
    return float(np.mean((readings.measured - np.polyval(line, source.at(readings.times))) ** 2))
