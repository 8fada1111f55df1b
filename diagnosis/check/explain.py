"""How well one course explains another: regressions after a recalibration, compared by likelihood."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import nnls

from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside
from diagnosis.recording.series import sample

#: Probability that a recording that fits its scenario raises one false serious doubt.
LEVEL = 1e-3
#: Share of what is left as it is that another explanation leaves at most. Of many readings a likelihood prefers one
#: that leaves hardly less; but a law that is missing, or a resonance that is off, is followed in part by any of them.
MOST_LEFT = 0.5


@dataclass(frozen=True)
class Fit:
    """A regression.

    Args:
        residual: Measured minus fitted, shape (samples,).
        floor: Variance that any fit leaves.
        total: Sum of squares of the readings about their mean.
    """

    residual: Array
    floor: float
    total: float

    @cached_property
    def squares(self) -> float:
        """Sum of squares that is left, noise included."""
        return float(self.residual @ self.residual) + len(self.residual) * self.floor

    @property
    def share(self) -> float:
        """Share of the readings' variance that is explained, 0 to 1."""
        left = float(self.residual @ self.residual)
        return max(0.0, 1.0 - left / self.total) if self.total else 0.0

    @cached_property
    def independent(self) -> float:
        """Number of independent samples among those of the residual."""
        return independent(self.residual)


def independent(residual: Array) -> float:
    """Number of independent samples among correlated ones.

    N / (1 + 2 sum rho), the sum of autocorrelations over the initial positive sequence (Geyer, Statistical Science 7
    (1992) 473-483). At least 2.
    """
    count = len(residual)
    centred = residual - residual.mean() if count else residual
    power = np.abs(np.fft.rfft(centred, 2 * count)) ** 2
    covariance = np.fft.irfft(power)[:count] if count else np.zeros(0)
    if count < 4 or not covariance[0] > 0.0:
        return max(2.0, float(count))
    rho = covariance / covariance[0]
    pairs = rho[0 : count - 1 : 2] + rho[1:count:2]
    last = int(np.argmax(pairs <= 0.0)) if (pairs <= 0.0).any() else len(pairs)
    return float(np.clip(count / max(2.0 * float(pairs[:last].sum()) - 1.0, 1.0), 2.0, count))


def gain(own: Fit, other: Fit) -> float:
    """-2 log likelihood that the other fit gains, both with the same number of samples and of parameters.

    Errors are those of the model and not white: of N samples count only as many as are independent, by the residual
    that
    is correlated further. Negative where the other fit is worse.
    """
    count = min(own.independent, other.independent)
    floor = np.finfo(float).tiny
    return float(count * np.log(max(own.squares, floor) / max(other.squares, floor)))


def fit(measured: Array, columns: Array, tolerance: float, free: Array | None = None) -> Fit:
    """Least squares of readings on an offset and columns with weights that are not negative.

    Args:
        measured: Shape (samples,).
        columns: Shape (samples, columns).
        tolerance: Standard deviation that any fit leaves.
        free: Columns whose weights may have any sign, shape (samples, any).
    """
    return Basis(columns, free).fit(measured, tolerance)


class Basis:
    """Columns of a regression, made ready once for any readings at the same instants; see `fit`.

    Args:
        columns: Shape (samples, columns).
        free: Columns whose weights may have any sign, shape (samples, any).
    """

    def __init__(self, columns: Array, free: Array | None = None) -> None:
        rest = columns - columns.mean(axis=0) if columns.shape[1] else columns
        self._free: Array | None = None
        if columns.shape[1] and free is not None and free.shape[1]:
            basis, sizes, _ = np.linalg.svd(free - free.mean(axis=0), full_matrices=False)
            basis = basis[:, sizes > 1e-9 * max(float(sizes[0]), 1e-300)]
            self._free = basis
            rest = rest - basis @ (basis.T @ rest)
        scale = np.linalg.norm(rest, axis=0)
        self._rest = rest[:, scale > 1e-9 * max(float(scale.max(initial=0.0)), 1e-300)]
        if self._rest.shape[1]:
            self._scale = np.linalg.norm(self._rest, axis=0)
            # of a tall problem only its triangle matters
            self._left, self._triangle = np.linalg.qr(self._rest / self._scale)

    def fit(self, measured: Array, tolerance: float) -> Fit:
        """Readings, shape (samples,), on an offset and these columns."""
        centred = measured - measured.mean()
        total, target = float(centred @ centred), centred
        if self._free is not None:
            target = centred - self._free @ (self._free.T @ centred)
        if not self._rest.shape[1]:
            return Fit(target, tolerance**2, total)
        weights, _ = nnls(self._triangle, self._left.T @ target)
        return Fit(target - self._rest @ (weights / self._scale), tolerance**2, total)

    def least(self, measured: Array) -> Array:
        """Squares that weights of any sign would leave of readings, shape (samples, any): no fit leaves less."""
        centred = measured - measured.mean(axis=0)
        if self._free is not None:
            centred = centred - self._free @ (self._free.T @ centred)
        if self._rest.shape[1]:
            centred = centred - self._left @ (self._left.T @ centred)
        return np.asarray(np.einsum("ij,ij->j", centred, centred))


def design(course: Beside, at: Array) -> Array:
    """Columns by which a simulated course may explain a channel, with weights that are not negative.

    The course itself; the course behind one lag, or two of them: a sensor, a mass, a parameter that makes it slower;
    and
    twice the course less the course behind a lag: time constants shorter by a factor of up to 2. So a parameter that
    is off or a
    lag is no misfit; a response to something else is.

    Args:
        course: Channel whose simulation explains.
        at: Where on the simulation's clock [s], shape (samples,).
    """
    assert course.simulated is not None
    own = sample(course.simulated, at)
    behind = _between(at, course.simulated.times, course.lagged)
    return np.hstack([own[:, None], behind, 2.0 * own[:, None] - behind[:, : len(course.lags)]])


def _between(at: Array, times: Array, rows: Array) -> Array:
    """Straight lines between the values of rows, shape (samples, rows); beyond the ends the end values hold."""
    clipped = np.clip(at, times[0], times[-1])
    low = np.clip(np.searchsorted(times, clipped, side="right") - 1, 0, max(len(times) - 2, 0))
    high = np.minimum(low + 1, len(times) - 1)
    left, right = rows[:, low], rows[:, high]
    width = np.where(high > low, times[high] - times[low], 1.0)
    found = (right - left) / width * (clipped - times[low]) + left
    return np.where(clipped == times[high], right, found).T


def basis(beside: Beside) -> Basis:
    """What a channel's own simulation explains at its own samples, made ready once."""
    found = beside.memo.get("basis")
    if not isinstance(found, Basis):
        found = beside.memo["basis"] = Basis(design(beside, beside.times))
    return found


def explained(beside: Beside, course: Beside, at: Array | None = None, inside: Array | None = None) -> Fit:
    """The channel explained by a simulated course.

    Args:
        beside: The channel.
        course: Whose simulation explains it.
        at: Times on the simulation's clock, shape (picked,); default: those of the samples.
        inside: Which samples count, shape (picked,); default: all.
    """
    if at is None and inside is None and course is beside:
        return basis(beside).fit(beside.measured, beside.tolerance)
    chosen = np.ones(len(beside.pick), dtype=bool) if inside is None else np.asarray(inside, dtype=bool)
    times = beside.times[chosen]
    instants = times if at is None else at[chosen]
    return fit(beside.measured[chosen], design(course, instants), beside.tolerance)


def explains(own: float, other: float, most_left: float = MOST_LEFT) -> bool:
    """Whether another explanation takes away enough of what the recording's own conditions leave.

    Args:
        own: Share of the variance that these explain.
        other: Share that it explains.
        most_left: Share of what is left that it leaves at most.

    >>> explains(0.97, 0.999), explains(0.38, 0.51)
    (True, False)
    """
    return 1.0 - other <= most_left * (1.0 - own)
