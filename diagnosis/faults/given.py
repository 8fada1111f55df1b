"""Models whose faults are settled: not looked for, or known and left as they are while laws are looked for."""

from __future__ import annotations

from collections.abc import Mapping

from diagnosis.models.protocol import DiagnosisModel, Scaled, unscaled
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Point, Term
from diagnosis.search.score import Projection


class LawsOnly(WrappedModel):
    """A model of which no fault is looked for; those of a point are simulated all the same."""

    def interval_scores(self, base: Fit, projection: Projection, scaled: Scaled = unscaled) -> None:
        """None: there is nothing to look for."""
        return


class GivenFaults(LawsOnly):
    """A model with faults that stay as they are.

    A fault says nothing about other stretches of time than its own, so that none of them can confirm it: where laws
    are validated on stretches that they were not fitted to, it belongs to what was done and not to what is tried.

    Args:
        inner: The model that simulates.
        faults: With the values of their parameters.
    """

    def __init__(self, inner: DiagnosisModel, faults: Mapping[Term, tuple[float, ...]]) -> None:
        super().__init__(inner)
        self.given = dict(faults)

    def inside(self, point: Point) -> Point:
        """The point with the faults."""
        return Point(point.base, {**point.terms, **self.given})


def lasting_laws(model: DiagnosisModel) -> list[Term]:
    """Terms that are there in every recording from its begin to its end, so that any of them can show them."""
    return [
        t
        for t in model.terms()
        if t.recording is None and not any(p.is_instant for p in t.parameters) and model.where(t)[1].day is None
    ]


def faults_of(point: Point) -> dict[Term, tuple[float, ...]]:
    """The faults of a point, which belong to one recording each."""
    return {t: v for t, v in point.terms.items() if t.recording is not None}
