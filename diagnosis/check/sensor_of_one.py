"""A recording that stands out by one channel, which a fault of its sensor would explain: a drift, a lag, an offset.

A number, an input or a unit that was another in that recording explains it with one number too, and so does a sensor.
Which of them it was the readings of one channel seldom show. So where a sensor alone explains the recording as well as
the others are explained, nothing else is claimed, and the search is left to find begin, end and size.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.factors import best_logarithm
from diagnosis.check.odd_one_out import as_explained, comparable, left, left_beside, scaled_left
from diagnosis.check.straight_line import freed, line_basis
from diagnosis.check.timing import between, percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.equal_readings import ends_of_runs
from diagnosis.report.display import instant
from diagnosis.report.user_units import Units

#: Lags that are tried first, as shares of the recording; between the neighbours of the best one it is found.
LAGS = tuple(np.geomspace(2e-3, 0.3, 15).tolist())
#: Instants between which a sensor may be off, at first; then each reading about the best two.
INSTANTS = 25
#: Share of the readings that an offset has at least, and at most: the rest is another zero.
SHORTEST, LONGEST = 0.03, 0.97
#: Times that a sensor may stand still.
OCCASIONS = 2
#: How far from 1 a sensor's factor is none.
SAME_SLOPE = 0.01


@dataclass(frozen=True)
class Explained:
    """What a sensor would have done, in words, the share that is left of its channel, and the stretch concerned [s]."""

    what: str
    left: float
    begin: float
    end: float


def sensor_of_one(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about the sensor of the one channel that is missed, never serious; None where no such fault explains it.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
    """
    before, theirs = left_beside(one, others, scaled_left)
    enough = as_explained(theirs)
    channels = comparable(one)
    missed = [n for n, b in channels.items() if scaled_left(b, b.simulated_there) > enough]
    if len(missed) != 1:
        return None
    (name,) = missed
    found = explained_by_sensor(channels[name], enough, one.units_of(name))
    if found is None:
        return None
    text = (
        f"scaled and shifted as suits each channel best, the scenario explains {percent(1.0 - before)} of its variance "
        f"here, and at least {percent(1.0 - theirs)} of each channel's in the other recordings; as if this sensor "
        f"{found.what}, it is {percent(1.0 - found.left)}"
    )
    remedy = (
        "was the sensor as in the other recordings? A number, an input or a law that only this recording has may look "
        "alike in one channel: what the search finds says how well"
    )
    z = float(np.sqrt(before / max(found.left, 1e-12)))
    return Doubt(one.recording.title, name, "sensor", text, remedy, False, found.begin, found.end, z)


def explained_by_sensor(beside: Beside, enough: float, units: Units) -> Explained | None:
    """The fault of a sensor that explains a channel best, scaled and shifted too; None if none leaves so little.

    Args:
        beside: The channel of one recording.
        enough: Share of its variance that may be left.
        units: In which sizes are told.
    """
    scaled = _scaled(beside, units)
    if scaled.left <= enough:
        return scaled
    shapes = [_drift(beside, enough, units), _lag(beside), _offset(beside, enough, units)]
    found = min((*shapes, *_stuck(beside)), key=lambda f: f.left)
    return found if found.left <= enough else None


def _scaled(beside: Beside, units: Units) -> Explained:
    """Another range, amplification or zero from begin to end."""
    begin, end = float(beside.times[0]), float(beside.times[-1])
    slope = float(np.polyfit(beside.simulated_there, beside.measured, 1)[0])
    size = units.text(float(np.mean(beside.measured - beside.simulated_there)), beside.channel.unit)
    is_zero = abs(slope - 1.0) < SAME_SLOPE
    what = f"had another zero, by {size}" if is_zero else f"read {slope:.3g} times as much from another zero"
    return Explained(what, scaled_left(beside, beside.simulated_there), begin, end)


def _drift(beside: Beside, enough: float, units: Units) -> Explained:
    """A zero that moves in proportion to time."""
    begin, end = float(beside.times[0]), float(beside.times[-1])
    share = (beside.times - begin) / (end - begin)
    size, rest = _with(beside, share, enough, units)
    return Explained(f"drifted in proportion to time, by {size} from begin to end", rest, begin, end)


def _lag(beside: Beside) -> Explained:
    """A first-order lag."""
    span = float(np.ptp(beside.times))

    def missed(logarithm: float) -> float:
        return scaled_left(beside, beside.behind(float(np.exp(logarithm))))

    logarithm, share = best_logarithm(missed, [float(np.log(s * span)) for s in LAGS])
    what = f"had a lag of about {instant(float(np.exp(logarithm)), 2)} s"
    return Explained(what, share, float(beside.times[0]), float(beside.times[-1]))


def _offset(beside: Beside, enough: float, units: Units) -> Explained:
    """A zero that is off between two instants."""
    basis, count = line_basis(beside.simulated_there), len(beside.times)
    rest = freed(beside.measured, basis)
    # sums of the rest and of the basis up to each reading: an offset from i to j is a difference of two of them
    ahead = np.concatenate([[0.0], np.cumsum(rest)])
    explained = np.vstack([np.zeros(basis.shape[1]), np.cumsum(basis, axis=0)])

    def gains(begins: AnyArray, ends: AnyArray) -> Array:
        size = ends - begins
        there = np.sum((explained[ends] - explained[begins]) ** 2, axis=1)
        is_asked = (size >= SHORTEST * count) & (size <= LONGEST * count)
        return np.where(is_asked, (ahead[ends] - ahead[begins]) ** 2 / np.maximum(size - there, 1e-9), 0.0)

    edges = np.unique(np.linspace(0, count, INSTANTS).astype(int))
    begin, end = _best(gains, _pairs(edges, edges))
    step = int(np.ceil(count / (INSTANTS - 1)))
    near = [np.arange(max(at - step, 0), min(at + step, count) + 1) for at in (begin, end)]
    begin, end = _best(gains, _pairs(*near))
    there = np.arange(count)
    box = ((there >= begin) & (there < end)).astype(np.float64)
    first, last = float(beside.times[begin]), float(beside.times[end - 1])
    size, share = _with(beside, box, enough, units)
    return Explained(f"was off by {size} from about {between(first, last)} s", share, first, last)


def _stuck(beside: Beside) -> Iterator[Explained]:
    """One value, repeated once or twice: nothing is compared there."""
    channel = beside.channel
    runs = [(float(channel.times[a]), float(channel.times[b - 1])) for a, b in ends_of_runs(channel.values).T]
    stretches: list[tuple[float, float]] = []
    for _ in range(OCCASIONS):
        every = {run: _without(beside, (*stretches, run)) for run in runs if run not in stretches}
        lefts = {r: scaled_left(b, b.simulated_there) for r, b in every.items() if 2 * len(b.pick) > len(beside.pick)}
        if not lefts:
            return
        run = min(lefts, key=lambda r: lefts[r])
        stretches = sorted([*stretches, run])
        what = f"stood still from {' and from '.join(f'{between(*s)} s' for s in stretches)}"
        yield Explained(what, lefts[run], stretches[0][0], stretches[-1][1])


def _without(beside: Beside, stretches: Sequence[tuple[float, float]]) -> Beside:
    """The channel without the readings of stretches."""
    is_in = np.any([(beside.times >= a) & (beside.times <= b) for a, b in stretches], axis=0)
    return replace(beside, pick=beside.pick[~is_in])


def _pairs(begins: AnyArray, ends: AnyArray) -> Iterator[tuple[int, int]]:
    return ((int(b), int(e)) for b in begins for e in ends if b < e)


def _best(gains: Callable[[AnyArray, AnyArray], Array], pairs: Iterator[tuple[int, int]]) -> tuple[int, int]:
    every = np.array(list(pairs))
    best = every[int(np.argmax(gains(every[:, 0], every[:, 1])))]
    return int(best[0]), int(best[1])


def _with(beside: Beside, column: Array, enough: float, units: Units) -> tuple[str, float]:
    """By how much of a column a channel is off, and the share of its variance that is left then.

    The size has its unit and the sizes that leave no more than enough; the simulated course is scaled and shifted.
    """
    basis = line_basis(beside.simulated_there)
    rest, free = freed(beside.measured, basis), freed(column, basis)
    size = float(rest @ free) / max(float(free @ free), 1e-300)
    share = left(beside, beside.measured - (rest - free * size))
    part = max(float(np.mean(free**2)), 1e-300)
    half = math.sqrt(max(enough - share, 0.0) * float(np.var(beside.measured)) / part)
    return units.scale(size, beside.channel.unit).interval(size, size - half, size + half), share
