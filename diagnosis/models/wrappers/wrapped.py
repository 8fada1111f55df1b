"""A model that hands everything on to another; those that change something build on it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cosim.scenario import Scenario
from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.answers import Answers
from diagnosis.models.protocol import DiagnosisModel, Effect, RecordedRun, Scaled, Scatter, Spot, unscaled
from diagnosis.models.timeline import Timeline
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Layout, Parameter, Point, Term, refined, strength_slopes
from diagnosis.search.score import Projection, Scoring
from diagnosis.search.search import Outcome, Settings

if TYPE_CHECKING:
    from diagnosis.models.coil_network.model import CoilNetworkModel


class WrappedModel:
    """See `diagnosis.models.protocol.DiagnosisModel`; every member is that of the inner model but for `own_search`.

    Args:
        inner: The model that simulates, or another that wraps it.
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

    def terms(self) -> list[Term]:
        """Every law that may be missing, at every place."""
        return self.inner.terms()

    def where(self, term: Term) -> tuple[Effect, Spot]:
        """What a term says about itself, and where it acts."""
        return self.inner.where(term)

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        return self.inner.shows_in(term)

    def scale_uncertainty(self, term: Term) -> Sequence[float]:
        """See `DiagnosisModel`."""
        return self.inner.scale_uncertainty(term)

    def simulated_interval(self, term: Term) -> tuple[float, float] | None:
        """See `DiagnosisModel`."""
        return self.inner.simulated_interval(term)

    def groups(self) -> Mapping[str, AnyArray]:
        """Channels that are looked at together, by name."""
        return self.inner.groups()

    def predict(self, point: Point, run: int) -> Sequence[Array]:
        """Simulated values of every channel of a recording at its samples, SI."""
        return self.inner.predict(self.inside(point), run)

    @property
    def innermost(self) -> DiagnosisModel:
        """The model that simulates."""
        return self.inner.innermost

    def innermost_point(self, point: Point) -> Point:
        """A point as the innermost model knows it."""
        return self.inner.innermost_point(self.inside(point))

    @property
    def plain(self: DiagnosisModel) -> DiagnosisModel:
        """Itself: what it changes is no noise."""
        return self

    @property
    def inflation(self) -> Array:
        """See `DiagnosisModel`."""
        return self.inner.inflation

    @property
    def coil_network(self) -> CoilNetworkModel | None:
        """See `DiagnosisModel`."""
        return self.inner.coil_network

    @property
    def is_fast(self) -> bool:
        """Whether a simulation takes milliseconds."""
        return self.inner.is_fast

    @property
    def can_be_searched_again(self) -> bool:
        """See `DiagnosisModel`."""
        return self.inner.can_be_searched_again

    @property
    def can_be_refitted(self) -> bool:
        """See `DiagnosisModel`."""
        return self.inner.can_be_refitted

    @property
    def can_be_fitted(self) -> bool:
        """See `DiagnosisModel`."""
        return self.inner.can_be_fitted

    @property
    def has_scatter(self) -> bool:
        """See `DiagnosisModel`."""
        return self.inner.has_scatter

    def refine(self, point: Point) -> bool:
        """See `diagnosis.search.problem.refined`."""
        return refined(self.inner, self.inside(point))

    def solving_error(self, point: Point) -> Array | None:
        """As the inner model has it, whose residuals these are."""
        return self.inner.solving_error(self.inside(point))

    def row_shifts(self, point: Point) -> Array:
        """As the inner model has them, whose residuals these are."""
        return self.inner.row_shifts(self.inside(point))

    @property
    def has_ridges(self) -> bool:
        """See `diagnosis.search.problem.has_ridges`."""
        return self.inner.has_ridges

    @property
    def sizes_are_believed(self) -> bool:
        """See `diagnosis.search.problem.limits_of`."""
        return self.inner.sizes_are_believed

    @property
    def residual_of_reading(self) -> AnyArray | None:
        """See `DiagnosisModel`."""
        return self.inner.residual_of_reading

    @property
    def timeline(self) -> Timeline | None:
        """See `DiagnosisModel`."""
        return self.inner.timeline

    def step_ends(self, run: int) -> Array:
        """Instants at which steps of the simulation of a recording end [s], shape (steps + 1,)."""
        return self.inner.step_ends(run)

    @property
    def answers(self) -> Answers | None:
        """See `DiagnosisModel`."""
        return self.inner.answers

    @property
    def untried(self) -> tuple[str, ...]:
        """Where no law can be tried, and why."""
        return self.inner.untried

    @property
    def hidden(self) -> tuple[str, ...]:
        """See `DiagnosisModel`."""
        return self.inner.hidden

    def input_terms(self) -> list[Term]:
        """See `DiagnosisModel`."""
        return self.inner.input_terms()

    def faults(self) -> tuple[Term, ...]:
        """See `DiagnosisModel`."""
        return self.inner.faults()

    def interval_scores(self, base: Fit, projection: Projection, scaled: Scaled = unscaled) -> Scoring | None:
        """See `DiagnosisModel`; with what this model makes of changes of residuals."""
        return self.inner.interval_scores(base, projection, lambda rows, own: scaled(self.scaled(rows, own), own))

    def near_intervals(self, point: Point) -> Iterable[Point]:
        """Points with begin or end of a fault elsewhere; their parameters are those of this model."""
        for other in self.inner.near_intervals(point):
            yield Point(point.base, other.terms)

    def own_search(self, settings: Settings, on_progress: Callable[[str], None]) -> Outcome | None:
        """None: the points of such an outcome would be those of the inner model."""
        return None

    def scatter(self) -> Scatter:
        """See `DiagnosisModel`."""
        return self.inner.scatter()

    def take_scatter(self, scatter: Scatter) -> None:
        """See `DiagnosisModel`."""
        self.inner.take_scatter(scatter)

    def is_moved_by(self, term: Term, values: Sequence[float]) -> bool:
        """See `DiagnosisModel`."""
        return self.inner.is_moved_by(term, values)

    def judged_by(self, point: Point) -> str:
        """See `DiagnosisModel`."""
        return self.inner.judged_by(self.inside(point))

    def restated(self, scenario: Scenario, point: Point) -> Scenario | None:
        """See `DiagnosisModel`."""
        return self.inner.restated(scenario, self.inside(point))

    def amend(self, scenario: Scenario, point: Point, folder: Path) -> Path | None:
        """See `DiagnosisModel`."""
        return self.inner.amend(scenario, self.inside(point), folder)
