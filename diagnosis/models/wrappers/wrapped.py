"""A model that hands everything on to another; those that change something build on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.build import DiagnosisModel, Effect, RecordedRun, Spot
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Layout, Parameter, Point, Term, has_ridges, strength_slopes
from diagnosis.search.score import Projection, Scoring

#: What wrapping models make of changes of some residuals of the inner one: rows, shape (k, residuals), and which.
Scaled = Callable[[Array, slice], Array]


def unscaled(rows: Array, own: slice) -> Array:
    """Changes of residuals as they are."""
    return rows


class WrappedModel:
    """See `diagnosis.models.build.DiagnosisModel`.

    Args:
        inner: The model that simulates.
    """

    def __init__(self, inner: DiagnosisModel) -> None:
        self.inner = inner
        self.parameters: Sequence[Parameter] = inner.parameters
        self.layout: Layout = inner.layout

    @property
    def runs(self) -> Sequence[RecordedRun]:
        """One for each recording, in order."""
        return self.inner.runs

    @property
    def simulations(self) -> int:
        """How many were made so far."""
        return self.inner.simulations

    @property
    def sizes_are_believed(self) -> bool:
        """See `diagnosis.search.problem.limits_of`."""
        return bool(getattr(self.inner, "sizes_are_believed", False))

    def inside(self, point: Point) -> Point:
        """The point as the inner model knows it."""
        return point

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return self.inner.residuals([self.inside(p) for p in points])

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return self.inner.base_jacobian(self.inside(point))

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """Derivative of the residuals by the strength of terms, shape (tasks, residuals)."""
        return strength_slopes(self.inner, self.inside(point), None, tasks)

    def scaled(self, rows: Array, own: slice) -> Array:
        """Changes of this model's residuals, from those of the inner model's; shape (k, residuals of `own`)."""
        return rows

    def interval_scores(self, base: Fit, projection: Projection, scaled: Scaled = unscaled) -> Scoring | None:
        """Scores of faults that have begin and end; None where the model knows none.

        See `diagnosis.faults.model.FaultyModel.interval_scores`.
        """
        inner = getattr(self.inner, "interval_scores", None)
        found = inner(base, projection, lambda rows, own: scaled(self.scaled(rows, own), own)) if inner else None
        return found if isinstance(found, Scoring) else None

    def near_intervals(self, point: Point) -> Iterator[Point]:
        """Points with begin or end of a fault elsewhere; their parameters are those of this model."""
        inner = getattr(self.inner, "near_intervals", None)
        for other in inner(point) if inner else ():
            yield Point(point.base, other.terms)

    def terms(self) -> list[Term]:
        """Every law that may be missing, at every place."""
        return self.inner.terms()

    def where(self, term: Term) -> tuple[Effect, Spot]:
        """What a term says about itself, and where it acts."""
        return self.inner.where(term)

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        return self.inner.shows_in(term)

    @property
    def has_ridges(self) -> bool:
        """See `diagnosis.search.problem.has_ridges`."""
        return has_ridges(self.inner)

    @property
    def can_be_fitted(self) -> bool:
        """See `diagnosis.models.fabric.model.FabricModel`."""
        return bool(getattr(self.inner, "can_be_fitted", True))

    def scale_uncertainty(self, term: Term) -> Sequence[float]:
        """See `DiagnosisModel`."""
        return self.inner.scale_uncertainty(term)

    def groups(self) -> Mapping[str, AnyArray]:
        """Channels that are looked at together, by name."""
        return self.inner.groups()

    def predict(self, point: Point, run: int) -> Sequence[Array]:
        """Simulated values of every channel of a recording at its samples, SI."""
        return self.inner.predict(self.inside(point), run)
