"""Families of programmes as shares of the greatest heating over time; what each of them brings out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array

#: Levels of a staircase up and down again: each twice, so that history and temperature part.
_STAIRS = (0.15, 0.3, 0.45, 0.6, 0.8, 1.0, 0.7, 0.5, 0.35, 0.2, 0.0)
#: Levels of steps in no order, between which every size of jump occurs.
_MIXED = (1.0, 0.2, 0.7, 0.0, 0.45, 0.9, 0.1, 0.6, 0.3, 1.0, 0.0)

#: Multiples of it, modulo 1, are spread evenly however many there are.
_GOLDEN = 0.6180339887498949
_BELOW = "below the transformation"
_UNEVEN = "uneven strings"


@dataclass(frozen=True)
class Shape:
    """A programme without units.

    Args:
        kind: Its family.
        times: Corners [s] from the begin, rising, the first 0.
        heat: Share of the greatest heating, shape (corners, columns).
        duration: End [s].
        is_linear: Linear between the corners, else held.
    """

    kind: str
    times: Array
    heat: Array
    duration: float
    is_linear: bool = False


@dataclass(frozen=True)
class Levels:
    """Shares of the greatest heating with a meaning.

    Args:
        below: Steady at this share, coils stay below their transformation; 0 where there is none.
        low: Steady in the lower part of the transformation; 0 where there is none.
        high: Steady in the upper part of it.
    """

    below: float = 0.0
    low: float = 0.0
    high: float = 0.0


def shapes(duration: float, columns: int, levels: Levels) -> Iterator[Shape]:
    """One programme of each family.

    Args:
        duration: Of the recording [s]; none is longer than twice this.
        columns: How many courses can differ.
        levels: Of these coils.
    """
    yield _steps("staircase", _STAIRS, duration, columns)
    yield _steps("steps in mixed order", _MIXED, duration, columns)
    yield _steps("pulses", (1.0, 0.0) * 3, duration, columns)
    yield _steps("pulses", (1.0, 0.0) * 8, duration, columns)
    yield _edges(duration, columns)
    yield _soak("long soak", 0.5, 2.0 * duration, columns)
    yield _soak("long soak", 1.0, 2.0 * duration, columns)
    yield _after_rest(duration, columns)
    yield _ramp(duration, columns)
    if levels.below:
        yield _steps(_BELOW, [levels.below * s for s in _STAIRS], duration, columns)
        yield _steps(_BELOW, (levels.below, 0.0) * 4, duration, columns)
        yield _soak(_BELOW, levels.below, 2.0 * duration, columns)
    if levels.high:
        yield _turns(duration, columns, levels)
    if columns > 1:
        yield _uneven(duration, columns)
        yield _one_against_the_rest(duration, columns)


def stretched(shape: Shape, duration: float) -> Shape:
    """The same over another time."""
    return Shape(shape.kind, shape.times * duration / shape.duration, shape.heat, duration, shape.is_linear)


def again(shape: Shape, times: int) -> Shape:
    """The same several times, one after the other: what grows from cycle to cycle."""
    begins = shape.duration * np.arange(times)
    starts = shape.times[shape.times < shape.duration]
    corners = np.concatenate([b + starts for b in begins])
    heat = np.concatenate([shape.heat[: len(starts)]] * times)
    return Shape(f"{shape.kind}, {times} times", corners, heat, times * shape.duration, shape.is_linear)


def _steps(kind: str, levels: Sequence[float], duration: float, columns: int) -> Shape:
    """Levels of equal length, after a twentieth of the time at rest."""
    times = np.concatenate([[0.0], np.linspace(0.05, 1.0, len(levels) + 1)[:-1]]) * duration
    return _same(kind, times, np.array([0.0, *levels]), duration, columns)


def _same(kind: str, times: Array, heat: Array, duration: float, columns: int, is_linear: bool = False) -> Shape:
    return Shape(kind, times, np.repeat(heat[:, None], columns, axis=1), duration, is_linear)


def _edges(duration: float, columns: int) -> Shape:
    """Shift-register sequence of 31 places: edges at all distances (S. W. Golomb, Shift Register Sequences, 1967)."""
    register, bits = [1, 0, 0, 0, 0], []
    for _ in range(31):
        bits.append(register[-1])
        register = [register[4] ^ register[1], *register[:-1]]
    even = _steps("sharp edges", [0.9 * b + 0.1 for b in bits], duration, columns)
    # Off the even grid, so that samples at a fixed rate fall at all distances after an edge.
    moved = 0.3 * duration / 31 * np.concatenate([[0.0], _GOLDEN * np.arange(31) % 1.0])
    return Shape(even.kind, even.times + moved, even.heat, duration)


def _soak(kind: str, level: float, duration: float, columns: int) -> Shape:
    return _same(kind, np.array([0.0, 0.05, 0.7]) * duration, np.array([0.0, level, 0.0]), duration, columns)


def _after_rest(duration: float, columns: int) -> Shape:
    times = np.array([0.0, 0.5, 0.7]) * duration
    return _same("long rest, then one pulse", times, np.array([0.0, 1.0, 0.0]), duration, columns)


def _ramp(duration: float, columns: int) -> Shape:
    times = np.array([0.0, 0.05, 0.5, 0.95, 1.0]) * duration
    return _same("slow ramp", times, np.array([0.0, 0.0, 1.0, 0.0, 0.0]), duration, columns, True)


def _turns(duration: float, columns: int, levels: Levels) -> Shape:
    """Turning points within the transformation, closing in on its middle."""
    middle, half = 0.5 * (levels.low + levels.high), 0.5 * (levels.high - levels.low)
    swings = [middle + half * s for s in (1.0, -1.0, 0.75, -0.75, 0.5, -0.5, 0.25)]
    times = np.concatenate([[0.0], np.linspace(0.1, 0.9, len(swings)), [1.0]]) * duration
    return _same("turns within the transformation", times, np.array([0.0, *swings, 0.0]), duration, columns, True)


def _uneven(duration: float, columns: int) -> Shape:
    """Every second course at rest while the others are driven, then the other way round."""
    odd = np.arange(columns) % 2 == 1
    levels = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0, 0.4], [0.4, 1.0], [0.0, 0.0]])
    times = np.array([0.0, 0.05, 0.25, 0.35, 0.55, 0.65, 0.8, 0.9])
    return Shape(_UNEVEN, times * duration, np.where(odd[None, :], levels[:, 1:], levels[:, :1]), duration)


def _one_against_the_rest(duration: float, columns: int) -> Shape:
    heat = np.zeros((4, columns))
    heat[1, 0] = heat[2, 1:] = 1.0
    return Shape(_UNEVEN, np.array([0.0, 0.05, 0.4, 0.75]) * duration, heat, duration)
