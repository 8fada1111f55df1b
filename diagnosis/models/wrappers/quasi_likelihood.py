"""A model that is known to be wrong by more than the noise: its likelihood is tempered until it is honest.

Readings of a real rig are met far worse than their noise, and neighbouring residuals are alike. Taken for independent
readings with that noise, hundreds of them would vote for any term that bends the curve a little. What counts is how
many independent statements they make, and how large the errors of the best model are.

Source: quasi-likelihood with a variance inflation from the most general model, K. P. Burnham and D. R. Anderson, Model
Selection and Multimodel Inference, 2nd ed., Springer 2002, section 2.5; independent samples among correlated ones,
A. Sokal, Monte Carlo Methods in Statistical Mechanics, 1997, section 3.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.search.problem import Layout, Point, Term

#: Inflation of the variance up to which noise alone is believed: quantised or slightly filtered readings reach it.
BELIEVED = 4.0
#: Lags are summed up to this many correlation times.
WINDOW = 5.0


class QuasiLikelihoodModel(WrappedModel):
    """A model whose residuals count less.

    Args:
        inner: The model that simulates.
        inflation: Of the variance, of every channel, shape (channels,).
    """

    def __init__(self, inner: DiagnosisModel, inflation: Array) -> None:
        super().__init__(inner)
        self._inflation = inflation
        self._factor = 1.0 / np.sqrt(inflation)[np.asarray(inner.layout.channel, dtype=int)]

    @property
    def inflation(self) -> Array:
        """Of the variance of every channel, shape (channels,)."""
        return self._inflation

    @property
    def plain(self) -> DiagnosisModel:
        """The inner model."""
        return self.inner

    @property
    def sizes_are_believed(self) -> bool:
        """See `diagnosis.search.problem.limits_of`: such a model errs by more than noise."""
        return True

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.asarray(super().residuals(points) * self._factor)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.asarray(super().base_jacobian(point) * self._factor[:, None])

    def scaled(self, rows: Array, own: slice) -> Array:
        """See `WrappedModel`."""
        return np.asarray(rows * self._factor[own])

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """Derivative of the residuals by the strength of terms, shape (tasks, residuals)."""
        return np.asarray(super().slopes(point, tasks) * self._factor)


def inflation(residuals: Array, layout: Layout) -> Array:
    """By how much the variance of each channel's mean is larger than its noise says, at least 1, shape (channels,).

    Args:
        residuals: Of the most general model, divided by the deviation of the noise; 0 where a sample is not used.
        layout: What each belongs to.
    """
    found = np.ones(len(layout.names))
    for number in range(len(layout.names)):
        own = residuals[layout.channel == number]
        own = own[own != 0.0]
        if len(own):
            found[number] = max(1.0, float(np.mean(own**2)) * correlation_time(own))
    return found


def correlation_time(values: Array) -> float:
    """Samples per independent sample, at least 1: 1 + 2 sum of autocorrelations, to a window that fits itself."""
    count = len(values)
    power = np.abs(np.fft.rfft(values, 2 * count)) ** 2
    covariance = np.fft.irfft(power)[:count]
    if not covariance[0] > 0:
        return 1.0
    times = 2.0 * np.cumsum(covariance / covariance[0]) - 1.0
    enough = np.flatnonzero(np.arange(count) >= WINDOW * times)
    last = int(enough[0]) if enough.size else count - 1
    return max(1.0, float(times[last]))
