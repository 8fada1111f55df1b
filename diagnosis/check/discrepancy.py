"""A channel by a course with kinks, a smooth discrepancy and noise: whose likelihood tells instants.

What a model lacks bends a temperature slowly; what is switched kinks it at once. The discrepancy is an integrated
Wiener process (a cubic smoothing spline: Wahba, Spline Models for Observational Data, 1990), the noise is white, so
that an instant is known by the kink and not by the size or the length of a response (Kennedy, O'Hagan, J. R. Stat.
Soc. B 63 (2001) 425-464). The ratio of both is the one that restricted likelihood prefers (Patterson, Thompson,
Biometrika 58 (1971) 545-554).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from cosim.unit.protocol import Array

#: Ratios of discrepancy to noise that are tried: what the discrepancy does over the recording, in noises of a reading.
RATIOS = np.geomspace(5.0, 2e4, 5)
#: Samples of a channel; more are averaged in blocks.
MOST = 150


@dataclass(frozen=True)
class Thinned:
    """A channel's readings, averaged in blocks of neighbours where there are more than `MOST`.

    Args:
        times: Of every reading that is used [s], shape (readings,).
        blocks: First reading of each block, shape (blocks,).
        counts: Readings of each block, shape (blocks,).
        values: Mean of each block, shape (blocks,).
        centres: Mean time of each block [s], shape (blocks,).
    """

    times: Array
    blocks: np.ndarray[tuple[int], np.dtype[np.int64]]
    counts: Array
    values: Array
    centres: Array

    def means(self, rows: Array) -> Array:
        """Means over the blocks of something at all readings, shape (any, readings) to (any, blocks)."""
        return np.asarray(np.add.reduceat(rows, self.blocks, axis=-1) / self.counts)


def thin(times: Array, values: Array, most: int = MOST) -> Thinned:
    """Average readings in blocks of equal numbers."""
    size = max(1, -(-len(times) // most))
    blocks = np.arange(0, len(times), size)
    counts = np.diff(np.append(blocks, len(times))).astype(float)
    means = [np.add.reduceat(v, blocks) / counts for v in (values, times)]
    return Thinned(times, blocks, counts, means[0], means[1])


class Whitener:
    """Takes the correlation of a discrepancy and noise off: whitened readings are independent, of one variance.

    Args:
        centres: Mean time of each block of readings [s], shape (blocks,).
        counts: Readings of each block, shape (blocks,).
        ratio: Standard deviation of the discrepancy at the end of the recording, in noises of a reading.
        order: 2: slopes wander (temperatures); 1: values do (currents, which step).
    """

    def __init__(self, centres: Array, counts: Array, ratio: float, order: int) -> None:
        begin = float(centres[0])
        span = max(float(centres[-1]) - begin, 1e-300)
        x = (centres - begin) / span
        low, high = np.minimum(x[:, None], x[None, :]), np.maximum(x[:, None], x[None, :])
        kernel = 3.0 * low**2 * (high / 2.0 - low / 6.0) if order == 2 else low
        self._triangle = np.linalg.cholesky(np.diag(1.0 / counts) + ratio**2 * kernel)
        self.log_determinant = 2.0 * float(np.sum(np.log(np.diag(self._triangle))))
        trend = np.stack([np.ones_like(x), x][:order])
        white = self._solved(trend)
        basis, triangle = np.linalg.qr(white.T)
        self._basis = basis
        self.log_trend = 2.0 * float(np.sum(np.log(np.abs(np.diag(triangle)))))

    def _solved(self, rows: Array) -> Array:
        return np.asarray(solve_triangular(self._triangle, rows.T, lower=True, check_finite=False).T)

    def __call__(self, rows: Array) -> Array:
        """Whitened rows, without what the level (and slope) at the begin explain; shape (any, blocks)."""
        white = self._solved(np.atleast_2d(rows))
        return np.asarray(white - (white @ self._basis) @ self._basis.T)


def whitener(at: Thinned, ratio: float, order: int) -> Whitener:
    """Of a channel's readings; what is asked again of the same readings is not factorised again."""
    return _whitener(at.centres.tobytes(), at.counts.tobytes(), ratio, order)


@functools.lru_cache(maxsize=4 * len(RATIOS))
def _whitener(centres: bytes, counts: bytes, ratio: float, order: int) -> Whitener:
    return Whitener(np.frombuffer(centres), np.frombuffer(counts), ratio, order)


@dataclass(frozen=True)
class Likelihoods:
    """How well each of several sets of columns explains a channel, for every ratio of discrepancy to noise.

    Args:
        deviance: -2 log likelihood of each set with its best ratio, shape (sets,).
        every: The same for each ratio, shape (ratios, sets).
        variance: Of a reading's noise, shape (ratios, sets).
        left: Whitened residuals, shape (ratios, sets, blocks).
    """

    deviance: Array
    every: Array
    variance: Array
    left: Array

    def gain_by_block(self, without: int, with_: int) -> Array:
        """What the set `with_` gains over the set `without` in each block, shape (blocks,).

        With the ratio that is best for the second, and with one variance for both sets, the logarithmic mean of their
        own: of a profiled variance, n log(v / w) is n (v - w) over that mean, so that the blocks sum to the gain.
        """
        ratio = int(np.argmin(self.every[:, with_]))
        v, w = (float(self.variance[ratio, k]) for k in (without, with_))
        mean = w if np.isclose(v, w, rtol=1e-9) else (v - w) / float(np.log(v / w))
        return np.asarray((self.left[ratio, without] ** 2 - self.left[ratio, with_] ** 2) / mean)


def likelihoods(at: Thinned, columns: Array, order: int, noise: float) -> Likelihoods:
    """Fit sets of columns to a channel with a smooth discrepancy and noise.

    The variance is that of maximum likelihood, so that sets of different size are compared in any unit; restricted
    likelihood, which takes the level and slope out, is for the ratio.

    Args:
        at: Readings, thinned.
        columns: At every reading, shape (sets, columns, readings).
        order: Of the discrepancy, see `Whitener`.
        noise: Standard deviation of a reading that is stated or estimated: half of it is the least that is left.
    """
    rows = at.means(columns)
    degrees = rows.shape[-1] - order
    every, variances, kept = [], [], []
    for ratio in RATIOS:
        taken_off = whitener(at, float(ratio), order)
        with np.errstate(over="ignore", invalid="ignore"):  # a simulation that runs away explains nothing
            white = taken_off(rows.reshape(-1, rows.shape[-1])).reshape(rows.shape)
            left = _left(taken_off(at.values[None])[0], white)
            squares = np.sum(left**2, axis=-1)
        squares = np.where(np.isfinite(squares), squares, np.inf)
        variance = np.maximum(np.where(squares < np.inf, squares, 0.0) / degrees, 0.25 * noise**2)
        constant = taken_off.log_determinant + taken_off.log_trend
        every.append(degrees * np.log(variance) + squares / variance + constant)
        variances.append(variance)
        kept.append(left)
    return Likelihoods(np.min(every, axis=0), np.array(every), np.array(variances), np.array(kept))


def _left(white: Array, columns: Array) -> Array:
    """What each set of columns leaves of a whitened channel, shape (sets, blocks)."""
    gram = columns @ np.swapaxes(columns, 1, 2)
    size = np.sqrt(np.maximum(np.einsum("sii->si", gram), 1e-300))
    gram = gram / (size[:, :, None] * size[:, None, :]) + 1e-9 * np.eye(columns.shape[1])
    right = (columns @ white) / size
    weights = np.linalg.solve(gram, right[..., None])[..., 0] / size
    return np.asarray(white - np.einsum("sc,scb->sb", weights, columns))
