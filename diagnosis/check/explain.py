"""How well one course explains another: regressions after a recalibration, compared by likelihood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit import Array
from diagnosis.check.beside import Beside
from diagnosis.recording.series import Series, sample

#: Probability that a recording that fits its scenario raises one false serious doubt.
LEVEL = 1e-3


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

    @property
    def squares(self) -> float:
        """Sum of squares that is left, noise included."""
        return float(self.residual @ self.residual) + len(self.residual) * self.floor

    @property
    def share(self) -> float:
        """Share of the readings' variance that is explained, 0 to 1."""
        left = float(self.residual @ self.residual)
        return max(0.0, 1.0 - left / self.total) if self.total else 0.0


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

    Errors are those of the model and not white: of N samples count only as many as are independent, by the residual that
    is correlated further. Negative where the other fit is worse.
    """
    count = min(independent(own.residual), independent(other.residual))
    floor = np.finfo(float).tiny
    return float(count * np.log(max(own.squares, floor) / max(other.squares, floor)))


def fit(measured: Array, columns: Array, floor: float) -> Fit:
    """Least squares of readings on columns, shape (samples, columns)."""
    scale = np.linalg.norm(columns, axis=0)
    scaled = columns / np.where(scale > 0.0, scale, 1.0)
    # orthogonal columns; directions that rounding alone makes are left out
    left, sizes, _ = np.linalg.svd(scaled, full_matrices=False)
    basis = left[:, sizes > 1e-7 * sizes[0]]
    centred = measured - measured.mean()
    shifted = centred - basis @ (basis.T @ centred)
    return Fit(shifted, floor**2, float(centred @ centred))


def design(
    beside: Beside, course: Beside, times: Array, at: Array, is_free: bool = True
) -> Array:  # fmt: skip
    """Columns that explain a channel by a simulated course.

    Offset, gain, first-order lags (whose weights may be negative: any change of a time constant is such a sum), and what
    remains of another initial state. So neither a parameter that is off nor a lag of the sensor is a misfit.

    Args:
        beside: The channel that is explained; its lags are used.
        course: The channel whose simulation explains.
        times: Of the readings [s].
        at: Where on the simulation's clock they are taken [s].
        is_free: Whether lags and decays may be weighted freely; else offset and gain alone.
    """
    assert course.simulated is not None
    own = course.simulated
    columns = [np.ones(len(times)), sample(own, at)]
    if is_free:
        columns += [np.interp(at, own.times, row) for row in course.lagged]
        columns += [np.exp(-(times - times[0]) / lag) for lag in beside.lags]
    return np.stack(columns, axis=1)


def explained(beside: Beside, course: Beside, at: Array | None = None, inside: Array | None = None) -> Fit:
    """The channel explained by a simulated course.

    Args:
        beside: The channel.
        course: Whose simulation explains it.
        at: Times on the simulation's clock, shape (picked,); default: those of the samples.
        inside: Which samples count, shape (picked,); default: all.
    """
    chosen = np.ones(len(beside.pick), dtype=bool) if inside is None else np.asarray(inside, dtype=bool)
    times = beside.times[chosen]
    instants = times if at is None else at[chosen]
    return fit(beside.measured[chosen], design(beside, course, times, instants), beside.tolerance)


def lagged_series(beside: Beside, number: int) -> Series:
    """The simulated course behind the lag of a number."""
    assert beside.simulated is not None
    own = beside.simulated
    return Series(own.times, beside.lagged[number], own.is_flow, own.unit)
