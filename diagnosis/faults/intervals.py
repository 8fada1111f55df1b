"""The interval of time in which a change of one thing explains most, of all intervals: a generalised likelihood ratio.

Source: generalised likelihood ratio for a change of known shape and unknown size and time, M. Basseville and
I. V. Nikiforov, Detection of Abrupt Changes: Theory and Application, Prentice Hall 1993, sections 2.4.3 and 7.2.4;
parameters that are estimated too are projected out, as in `diagnosis.search.score.Projection`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.recording.equal_readings import ends_of_runs
from diagnosis.search.posterior import HUBER
from diagnosis.search.score import LEAST_VISIBLE

#: Scatter, in deviations of the noise, up to which the readings of a sensor stand still. One that holds a value repeats
#: it; where readings scatter as noise does, a sensor that works reads something that rests.
STILL = 0.25
#: Samples on either side of an end that are tried.
MOST_NEAR = 200


@dataclass(frozen=True)
class Pieces:
    """Pieces of time, next to each other, with what a change of unit strength in each does to the residuals.

    Args:
        gram: Products of these directions with each other, the recalibration taken away, shape (pieces, pieces).
        whole: The same before it is taken away.
        along: Products with the residuals, shape (pieces,).
        noise: Products with nulls, shape (pieces, draws).
        count: Samples in each piece that are used, shape (pieces,).
    """

    gram: Array
    whole: Array
    along: Array
    noise: Array
    count: AnyArray

    def without_nulls(self) -> Pieces:
        """The same for a search that needs no chance: one column instead of one for each draw."""
        return replace(self, noise=self.noise[:, :0])


@dataclass(frozen=True)
class Best:
    """The best interval of all.

    Args:
        first: Number of its first piece.
        last: Number of the piece after its last one.
        gain: Fall of -2 log posterior by the straight line.
        amount: Strength that gives it.
        chance: Largest gain of any interval in each null, shape (draws,).
        leads: First piece, piece after the last, strength of that, for each null.
        tried: Intervals that were looked at.
    """

    first: int
    last: int
    gain: float
    amount: float
    chance: Array
    leads: tuple[tuple[int, int, float], ...]
    tried: int


def best_interval(pieces: Pieces, fewest: int, bounds: tuple[float, float]) -> Best | None:
    """The interval with the largest gain; None where none can be seen.

    An interval that holds every sample is none: that is a bias.

    Args:
        pieces: See there.
        fewest: Samples that an interval must hold.
        bounds: Of the strength: what lies beyond gains less.
    """
    first, last, held, every = _intervals(pieces)
    left, whole = (_blocks(m, first, last) for m in (pieces.gram, pieces.whole))
    sides = _sums(np.column_stack([pieces.along, pieces.noise]), first, last)
    return _best((first, last), (held >= fewest) & (held < every), (left, whole, sides), bounds)


def best_ramp(pieces: Pieces, times: Array, fewest: int, bounds: tuple[float, float]) -> Best | None:
    """The interval in which something that rises from 0 to 1 gains most; None where none can be seen.

    What rises by `t` within an interval is what rises all the time, less what it has at the begin, over its length; so
    that every interval is a sum of pieces of these two courses.

    Args:
        pieces: Of a course that stays, and of one that rises with `times`, one after the other; each of `gram` and
            `along` is twice as long as `count`.
        times: Between pieces, from 0 to 1, shape (pieces + 1,).
        fewest: Samples that an interval must hold.
        bounds: Of the strength: what lies beyond gains less.
    """
    first, last, held, _ = _intervals(pieces)
    count = len(pieces.count)
    begin, length = times[first], times[last] - times[first]

    def of_ramps(matrix: Array) -> Array:
        level, across, slope = matrix[:count, :count], matrix[:count, count:], matrix[count:, count:]
        parts = (_blocks(m, first, last) for m in (level, across, slope))
        return np.asarray(next(parts) * begin**2 - 2.0 * begin * next(parts) + next(parts)) / length**2

    sides = np.column_stack([pieces.along, pieces.noise])
    level, slope = (_sums(part, first, last) for part in (sides[:count], sides[count:]))
    along = (slope - begin[:, None] * level) / length[:, None]
    return _best((first, last), held >= fewest, (of_ramps(pieces.gram), of_ramps(pieces.whole), along), bounds)


def best_single(directions: Pieces, bounds: tuple[float, float]) -> Best | None:
    """The direction with the largest gain, each alone; None where none can be seen.

    Args:
        directions: What is tried, in place of pieces of time.
        bounds: Of the strength: what lies beyond gains less.
    """
    numbers = np.arange(len(directions.along))
    left, whole = np.diag(directions.gram), np.diag(directions.whole)
    sides = np.column_stack([directions.along, directions.noise])
    return _best((numbers, numbers + 1), directions.count > 0, (left, whole, sides), bounds)


def _intervals(pieces: Pieces) -> tuple[AnyArray, AnyArray, AnyArray, int]:
    """First piece and piece after the last of every interval, samples that it holds, and how many there are."""
    first, last = np.triu_indices(len(pieces.count) + 1, 1)
    samples = np.concatenate([[0], np.cumsum(pieces.count)])
    return first, last, samples[last] - samples[first], int(samples[-1])


def _sums(rows: Array, first: AnyArray, last: AnyArray) -> Array:
    """Sums of rows[first:last]."""
    total = np.vstack([np.zeros(rows.shape[1]), np.cumsum(rows, axis=0)])
    return np.asarray(total[last] - total[first])


def _best(
    intervals: tuple[AnyArray, AnyArray],
    allowed: AnyArray,
    products: tuple[Array, Array, Array],
    bounds: tuple[float, float],
) -> Best | None:
    """The best of some intervals.

    Args:
        intervals: First piece of each, and the piece after its last one.
        allowed: Which may be.
        products: Of the direction of each with itself, what is fitted taken away and before, and with the residuals
            and each null, shapes (intervals,), (intervals,) and (intervals, 1 + draws).
        bounds: Of the strength.
    """
    left, whole, sides = products
    seen = allowed & (left > LEAST_VISIBLE**2 * whole) & (left > 0.0)
    if not seen.any():
        return None
    first, last, left = intervals[0][seen], intervals[1][seen], left[seen]
    amounts = -sides[seen] / left[:, None]
    inside = np.clip(amounts, *bounds)
    gains = (amounts**2 - (amounts - inside) ** 2) * left[:, None]
    top = np.argmax(gains, axis=0)
    found = [(int(first[k]), int(last[k]), float(inside[k, n])) for n, k in enumerate(top.tolist())]
    best = gains[top, np.arange(gains.shape[1])]
    return Best(found[0][0], found[0][1], float(best[0]), found[0][2], best[1:], tuple(found[1:]), len(first))


def cuts_of(count: int, pieces: int) -> AnyArray:
    """Numbers of the samples at which pieces begin, and `count`: at most so many pieces, each of a sample at least."""
    return np.unique(np.linspace(0, count, min(pieces, count) + 1).astype(int))


def _blocks(matrix: Array, first: AnyArray, last: AnyArray) -> Array:
    """Sums of matrix[first:last, first:last]."""
    size = len(matrix) + 1
    total = np.zeros((size, size))
    total[1:, 1:] = np.cumsum(np.cumsum(matrix, axis=0), axis=1)
    return np.asarray(total[last, last] - total[first, last] - total[last, first] + total[first, first])


def _moments(values: Array, weight: Array) -> tuple[Array, Array]:
    """Squares and values about the mean, so that the variance of large numbers is none of rounding."""
    about = values - np.average(values, weights=weight)
    return about**2, about


def best_constant(
    residuals: Array, readings: Array, fewest: int, used: AnyArray, pieces: int, own: Array | None = None
) -> tuple[int, int, float] | None:
    """The interval in which a sensor that holds one value explains most: first sample, sample after the last, gain.

    It is sought between pieces and the ends of the longest stretches of equal readings; around the best one every
    sample is tried: one that ends with a piece would stay behind an offset or a gain of the same readings.

    Args:
        residuals: As they are, shape (samples,).
        readings: Measured values in deviations of the noise, shape (samples,).
        fewest: Samples that an interval must hold.
        used: Which samples count, shape (samples,).
        pieces: Into which the samples are cut at most; begin and end lie between two of them.
        own: Measured values in deviations of the sensor's own noise, where `readings` are scaled otherwise: a sensor
            that stands still scatters by no more than `STILL` of them.
    """
    if not used.any():
        return None
    weight = used.astype(np.float64)
    level = readings - np.average(readings, weights=weight)  # the variance of large numbers would be rounding
    size = np.abs(residuals)
    misfit = np.where(size > HUBER, 2.0 * HUBER * size - HUBER**2, size**2)
    whole = [
        np.concatenate([[0.0], np.cumsum(v * weight)])
        for v in (misfit, level**2, level, np.ones(len(level)), *_moments(readings if own is None else own, weight))
    ]

    def between(cuts: AnyArray) -> tuple[int, int, float] | None:
        first, last = np.triu_indices(len(cuts), 1)
        lost, square, total, count, squares, values = (s[cuts][last] - s[cuts][first] for s in whole)
        scatter = squares / np.maximum(count, 1.0) - (values / np.maximum(count, 1.0)) ** 2
        seen = (count >= fewest) & (count < whole[3][-1]) & (scatter < STILL**2)
        if not seen.any():
            return None
        gains = np.where(seen, lost - np.maximum(square - total**2 / np.maximum(count, 1.0), 0.0), -np.inf)
        best = int(np.argmax(gains))
        return int(cuts[first[best]]), int(cuts[last[best]]), float(gains[best])

    count = len(residuals)
    cuts = np.unique([*cuts_of(count, pieces), *ends_of_runs(readings, fewest).ravel()])
    found = between(cuts)
    if found is None:
        return None
    apart = min(-(-count // pieces), MOST_NEAR)
    near = [np.arange(max(end - apart, 0), min(end + apart, count) + 1) for end in found[:2]]
    return between(np.unique(np.concatenate([*near])))
