"""What belongs to a recording alone: the room of its day, how somebody let go; no fit of another recording knows it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.search.problem import Point, Term


def recording_parameters(judge: DiagnosisModel, trained: DiagnosisModel) -> list[int]:
    """Numbers of the parameters of the judge that belong to its recordings alone, or to days that were not fitted."""
    known = {p.name for p in trained.parameters if p.is_carried}
    return [i for i, p in enumerate(judge.parameters) if p.name not in known]


class OwnNumbers(WrappedModel):
    """A model of which only some parameters are free; everything else, terms too, stays as it is."""

    def __init__(self, inner: DiagnosisModel, point: Point, own: Sequence[int]) -> None:
        super().__init__(inner)
        self._point, self._own = point, list(own)
        self.parameters = [inner.parameters[i] for i in own]

    def inside(self, point: Point) -> Point:
        base = self._point.base.copy()
        base[self._own] = point.base
        return Point(base, self._point.terms)

    def base_jacobian(self, point: Point) -> Array:
        return np.asarray(super().base_jacobian(point)[:, self._own])

    def terms(self) -> list[Term]:
        return []
