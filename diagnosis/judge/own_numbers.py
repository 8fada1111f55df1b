"""What belongs to a recording alone: the room of its day, how somebody let go; no fit of another recording knows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cosim.unit import Array
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, Term
from diagnosis.search.shares import is_carried
from diagnosis.simulator.models import DiagnosisModel
from diagnosis.simulator.wrapped import WrappedModel


def own_numbers(judge: DiagnosisModel, trained: DiagnosisModel) -> list[int]:
    """Numbers of the parameters of the judge that belong to its recordings alone, or to days that were not fitted."""
    known = {p.name for p in trained.parameters if is_carried(p.name)}
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


def foretold(judge: DiagnosisModel, trained: DiagnosisModel, points: Mapping[str, Point]) -> dict[str, float]:
    """-2 log of how well recordings are foretold, with the numbers that are theirs alone unknown within their priors.

    A room 0.3 K warmer than written down adds more to the chi-square of 36 thermometers than most effects do, and it
    speaks neither for nor against any. Everything that was fitted stays as it was fitted.

    Args:
        judge: Model of the held-out recordings.
        trained: Model that was fitted.
        points: Stage to point of the judge.

    Returns:
        Stage to the least sum of squared residuals (Huber) and squared distances from the priors.
    """
    own = own_numbers(judge, trained)
    found = {}
    for stage, point in points.items():
        found[stage] = fit(OwnNumbers(judge, point, own), Point(point.base[own]), iterations=30).cost
    return found
