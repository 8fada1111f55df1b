"""A model that does not see some of its samples: they are kept to validate it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.search.problem import Point, Term


class MaskedModel(WrappedModel):
    """A model with residuals of 0 where a sample is hidden.

    Args:
        inner: The model that simulates.
        seen: Which residuals are seen, shape (residuals,).
    """

    def __init__(self, inner: DiagnosisModel, seen: AnyArray) -> None:
        super().__init__(inner)
        self._seen = np.asarray(seen, dtype=bool)

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.where(self._seen, super().residuals(points), 0.0)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.where(self._seen[:, None], super().base_jacobian(point), 0.0)

    def scaled(self, rows: Array, own: slice) -> Array:
        """See `WrappedModel`."""
        return np.where(self._seen[own], rows, 0.0)

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """Derivative of the residuals by the strength of terms, shape (tasks, residuals)."""
        return np.where(self._seen, super().slopes(point, tasks), 0.0)
