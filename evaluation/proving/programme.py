"""What is done to a rig: voltage, power or bath over time."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from evaluation.proving.rig import Array


@dataclass(frozen=True)
class Programme:
    """Levels that hold from their times on.

    Args:
        times: First one 0 [s], rising, shape (points,).
        levels: Voltage [V], shape (points,); power of every element [W], shape (points, coils); or bath [K].
        stop: End [s].
        is_ramped: Whether levels are joined by straight lines (a bath) and not by jumps.
    """

    times: Array
    levels: Array
    stop: float
    is_ramped: bool = False

    def at(self, time: float, slew: float = 0.0) -> Array:
        """Level at a time, shape of one level; a jump takes `slew` [s]."""
        if self.is_ramped:
            flat = self.levels.reshape(len(self.times), -1)
            return np.array([np.interp(time, self.times, column) for column in flat.T]).reshape(self.levels.shape[1:])
        now = int(np.searchsorted(self.times, time + 1e-12, side="right")) - 1
        if now <= 0 or slew <= 0.0:
            return np.asarray(self.levels[max(now, 0)], dtype=np.float64)
        share = min(1.0, (time - self.times[now]) / slew)
        return np.asarray(self.levels[now - 1] + share * (self.levels[now] - self.levels[now - 1]))

    def grid(self, step: float, slew: float, instants: tuple[float, ...] = ()) -> Array:
        """Ends of steps [s]: all switches, ends of slews and instants, and between them steps of at most `step`."""
        corners = [0.0, *self.times, *(self.times + slew), *instants, self.stop]
        knots = np.unique(np.round([c for c in corners if 0.0 <= c <= self.stop], 9))
        parts = []
        for low, high in itertools.pairwise(knots.tolist()):
            count = max(1, int(np.ceil((high - low) / step - 1e-9)))
            parts.append(low + (high - low) / count * np.arange(count))
        return np.concatenate([*parts, [self.stop]])


def staircase(rng: np.random.Generator, top: float, stop: float) -> Programme:
    """Levels from about 40 % of the top to the top and back to 0, held for 12 to 20 s, each a draw."""
    count = int(stop // 16)
    shares = np.concatenate([[0.0], rng.permutation(np.linspace(0.45, 1.0, count - 2))[: count - 2], [0.0]])
    lengths = rng.uniform(0.8, 1.2, count)
    times = np.concatenate([[0.0], 2.0 + np.cumsum(lengths[:-1]) / lengths.sum() * (stop - 2.0)])
    times[1] = 2.0
    return Programme(np.round(times, 1), np.round(top * shares, 2), stop)


def pulses(rng: np.random.Generator, top: float, stop: float) -> Programme:
    """Pulses of 10 to 16 s with pauses of 8 to 20 s."""
    times, levels, t = [0.0], [0.0], 2.0
    while t < stop - 12.0:
        width, pause = rng.uniform(10.0, 16.0), rng.uniform(8.0, 20.0)
        times += [t, t + width]
        levels += [top * rng.uniform(0.85, 1.0), 0.0]
        t += width + pause
    return Programme(np.round(times, 1), np.round(levels, 2), stop)


def soak(rng: np.random.Generator, top: float, stop: float) -> Programme:
    """One long hold below the transformation, one above, and a long rest."""
    first, second = rng.uniform(0.3, 0.36) * stop, rng.uniform(0.62, 0.68) * stop
    low, high = top * rng.uniform(0.5, 0.6), top * rng.uniform(0.9, 1.0)
    return Programme(np.round([0.0, 2.0, first, second], 1), np.round([0.0, low, high, 0.0], 2), stop)


def partial(rng: np.random.Generator, top: float, stop: float) -> Programme:
    """Heating that turns within the transformation, again and again: minor loops."""
    times, levels, t = [0.0], [0.0], 2.0
    while t < stop - 11.0:  # a level lasts at least 1 s before the last switch: instants are rounded to 0.1 s
        width = rng.uniform(6.0, 12.0)
        times.append(t)
        levels.append(top * (rng.uniform(0.85, 1.0) if len(times) % 2 == 0 else rng.uniform(0.5, 0.72)))
        t += width
    return Programme(np.round([*times, stop - 10.0], 1), np.round([*levels, 0.0], 2), stop)


SHAPES = (staircase, pulses, soak, partial)


def offset(programme: Programme, span: tuple[float, float], factor: float, added: float) -> Programme:
    """The same programme with its level times `factor` plus `added` within a stretch of time.

    A ramped programme goes over within 0.1 s on both sides.
    """
    begin, end = span
    knots = [begin, begin + 0.1, end, end + 0.1] if programme.is_ramped else [begin, end]
    times = np.unique(np.round(np.concatenate([programme.times, knots]), 6))
    times = times[times <= programme.stop]
    levels = np.array([programme.at(t) for t in times.tolist()])
    inside = (times >= begin + 0.05) & (times < end + 0.05) if programme.is_ramped else (times >= begin) & (times < end)
    shape = (-1,) + (1,) * (levels.ndim - 1)
    changed = np.where(inside.reshape(shape), factor * levels + added, levels)
    return Programme(times, changed, programme.stop, programme.is_ramped)


def delayed(programme: Programme, dead_time: float) -> Programme:
    """The same programme later; until then its first level holds."""
    times = np.concatenate([[0.0], programme.times + dead_time])
    levels = np.concatenate([programme.levels[:1], programme.levels])
    kept = times <= programme.stop
    if programme.is_ramped:  # the last piece of a ramp ends beyond the stop
        kept[np.argmin(kept)] = True
    return Programme(times[kept], levels[kept], programme.stop, programme.is_ramped)
