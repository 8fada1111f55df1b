"""Sensors whose zero may be off by a stated amount: within it the bias is estimated, as any parameter of the model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.protocol import DiagnosisModel, Series
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.search.problem import Parameter, Point

#: A stated bound is taken for so many standard deviations.
DEVIATIONS_IN_BOUND = 2.0


class BiasedModel(WrappedModel):
    """A model whose sensors have biases: measured = simulated + bias.

    A sensor is the same in every recording, so a channel of one name has one bias.

    Args:
        inner: The model that simulates.
    """

    def __init__(self, inner: DiagnosisModel) -> None:
        super().__init__(inner)
        every = [s for run in inner.runs for s in run.series]
        bounds = {s.channel.name: s.channel.bias_bound for s in every if s.channel.bias_bound > 0}
        units = {s.channel.name: s.channel.unit for s in every}
        self._names = list(bounds)
        self._count = len(inner.parameters)
        own = [
            Parameter(f"bias of {n}", units[n], 0.0, b / DEVIATIONS_IN_BOUND, False, DEVIATIONS_IN_BOUND)
            for n, b in bounds.items()
        ]
        self.parameters = [*inner.parameters, *own]
        #: Derivative of the residuals by the z of each bias, shape (biases, residuals).
        self._rows = np.array(
            [
                np.concatenate([_row(s, p.deviation if s.channel.name == n else 0.0) for s in every])
                for n, p in zip(self._names, own)
            ]
        ).reshape(len(own), len(inner.layout.time))
        self._deviations = dict(zip(self._names, (p.deviation for p in own)))

    def inside(self, point: Point) -> Point:
        """The point without the biases."""
        return Point(point.base[: self._count], point.terms)

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        biases = np.array([p.base[self._count :] for p in points])
        return np.asarray(super().residuals(points) + biases @ self._rows)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.hstack([super().base_jacobian(point), self._rows.T])

    def predict(self, point: Point, run: int) -> Sequence[Array]:
        """Simulated values of every channel of a recording at its samples, SI, as its sensors read them."""
        biases = {n: self._deviations[n] * z for n, z in zip(self._names, point.base[self._count :])}
        values = super().predict(point, run)
        return [v + biases.get(s.channel.name, 0.0) for v, s in zip(values, self.runs[run].series)]


def _row(series: Series, amount: float) -> Array:
    return np.where(series.used, -amount / deviation(series.channel), 0.0)


def with_biases(model: DiagnosisModel) -> DiagnosisModel:
    """The model, with biases where a recording states a bound for one."""
    stated = any(s.channel.bias_bound > 0 for run in model.runs for s in run.series)
    return BiasedModel(model) if stated else model
