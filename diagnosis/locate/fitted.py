"""A recalibrated coil network with everything that the location needs of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Columns, Fit
from diagnosis.search.problem import Model, Parameter, Point


@dataclass(frozen=True)
class Fitted:
    """A coil network at its recalibrated point.

    Args:
        outer: The model that was fitted: the network, also with biases or tempered.
        network: The model that simulates.
        parameters: All that were fitted; those of the network first, then biases of sensors.
        fit: Recalibrated, without terms.
        inflation: Of the variance of every channel, shape (channels,).
    """

    outer: Model
    network: CoilNetworkModel
    parameters: Sequence[Parameter]
    fit: Fit
    inflation: Array

    @property
    def coils(self) -> CoilNetworkLayout:
        """Coils and strings."""
        return self.network.coils

    @property
    def point(self) -> Point:
        """The recalibrated point as the network knows it."""
        return Point(self.fit.point.base[: len(self.network.parameters)])

    def values(self, recording: int) -> CoilNetworkParameters:
        """Parameters of the network for one recording."""
        return self.network.network_parameters(self.point, recording)

    def moved(self, change: Array) -> Fitted | None:
        """The same at another point; None where the model cannot be simulated there.

        Args:
            change: Of the parameters, in prior deviations, shape (parameters,).
        """
        bounds = np.array([p.bounds for p in self.parameters]) * self.fit.widths
        point = Point(np.clip(self.fit.point.base + change * self.fit.widths, -bounds, bounds))
        residuals = self.outer.residuals([point])[0]
        if not np.isfinite(residuals).all():
            return None
        columns = Columns.of(self.outer.base_jacobian(point), point.base, residuals)
        return replace(self, fit=replace(self.fit, point=point, residuals=residuals, columns=columns))


def fitted(model: DiagnosisModel, fit: Fit) -> Fitted | None:
    """The coil network inside a model, or None where there is none.

    Args:
        model: A coil network, also with biases or tempered.
        fit: Of this model, without terms.
    """
    network = model.coil_network
    return None if network is None else Fitted(model, network, model.parameters, fit, model.inflation)
