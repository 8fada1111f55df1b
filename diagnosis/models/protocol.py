"""What judging, locating, amending and reporting ask of a model, whatever simulates it.

No other package asks of which kind a model is: it asks a member of `DiagnosisModel`. `ModelBase` answers what most
models answer; a wrapper (`diagnosis.models.wrappers.wrapped`) hands every question on to the model inside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from cosim.scenario import Scenario
from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.answers import Answers
from diagnosis.models.timeline import Timeline
from diagnosis.recording.recording import Channel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Layout, Parameter, Point, Term
from diagnosis.search.score import Projection, Scoring
from diagnosis.search.search import Outcome, Settings

if TYPE_CHECKING:
    from diagnosis.models.coil_network.model import CoilNetworkModel

#: What wrapping models make of changes of some residuals of the inner one: rows, shape (k, residuals), and which.
Scaled = Callable[[Array, slice], Array]


def unscaled(rows: Array, own: slice) -> Array:
    """Changes of residuals as they are."""
    return rows


@dataclass(frozen=True)
class Scatter:
    """What simulations of equal rigs differ by.

    Args:
        deviations: By channel, SI.
        together: How many times more the sum of squares over all channels varies than if each scattered by itself.
    """

    deviations: Mapping[str, float] = field(default_factory=dict)
    together: float = 1.0


class Effect(Protocol):
    """What a law says about itself."""

    @property
    def name(self) -> str:
        """In plain words."""
        ...

    @property
    def law(self) -> str:
        """Formula."""
        ...

    @property
    def confused_with(self) -> Mapping[str, str]:
        """Identifiers that data often cannot tell from it, with what decides."""
        ...

    @property
    def is_of_a_day(self) -> bool:
        """Whether it belongs to the day in which it sets in, and does not last."""
        ...

    @property
    def is_of_either(self) -> bool:
        """Whether it is written as a law of a sensor, and the rig may do the same before the sensor."""
        ...


class Spot(Protocol):
    """Where a law acts."""

    @property
    def label(self) -> str:
        """For people."""
        ...

    @property
    def mask(self) -> AnyArray | None:
        """Weight of its strength at every element, shape (elements,); None where places have no elements."""
        ...

    @property
    def day(self) -> object:
        """The day on which it acts alone (`diagnosis.models.timeline.Day`); None: on every one."""
        ...

    @property
    def channels(self) -> tuple[int, ...] | None:
        """Numbers of the channels that alone can show it; None: any may."""
        ...


@dataclass(frozen=True)
class Labelled:
    """A place with a name and no elements, on every day.

    Args:
        label: For people.
        channels: See `Spot`.
    """

    label: str
    channels: tuple[int, ...] | None = None

    @property
    def mask(self) -> AnyArray | None:
        """None."""
        return None

    @property
    def day(self) -> object:
        """None."""
        return None


class Series(Protocol):
    """One channel of one recording, as the model samples it."""

    @property
    def channel(self) -> Channel:
        """The channel."""
        ...

    @property
    def samples(self) -> AnyArray:
        """One number for each sample that is compared; they are the last ones of the channel."""
        ...

    @property
    def used(self) -> AnyArray:
        """Which of them count, shape (samples,)."""
        ...


class RecordedRun(Protocol):
    """One recording."""

    @property
    def series(self) -> Sequence[Series]:
        """Its channels."""
        ...

    @property
    def shares(self) -> Array:
        """Share of the sum of a channel's residuals that is taken from each of them, shape (channels,).

        The zero of a channel is unknown (`diagnosis.models.coil_network.kernel.whiten`); 0 where nothing is taken.
        """
        ...


@dataclass(frozen=True)
class ComparedSeries:
    """See `Series`."""

    channel: Channel
    samples: AnyArray
    used: AnyArray


@dataclass(frozen=True)
class ComparedRun:
    """See `RecordedRun`."""

    series: tuple[ComparedSeries, ...]
    shares: Array


def compared_run(series: Iterable[ComparedSeries], shares: Array | None = None) -> ComparedRun:
    """A recording of which nothing is taken from residuals, where no shares are given.

    Args:
        series: Its channels.
        shares: See `RecordedRun.shares`.
    """
    every = tuple(series)
    return ComparedRun(every, np.zeros(len(every)) if shares is None else shares)


@runtime_checkable
class DiagnosisModel(Protocol):
    """What `diagnosis.search.problem.Model` has, and what judging, locating, amending and reporting need besides."""

    parameters: Sequence[Parameter]
    layout: Layout

    @property
    def runs(self) -> Sequence[RecordedRun]:
        """One for each recording, in order."""
        ...

    @property
    def simulations(self) -> int:
        """How many were made so far."""
        ...

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        ...

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        ...

    def terms(self) -> list[Term]:
        """Every law that may be missing, at every place."""
        ...

    def where(self, term: Term) -> tuple[Effect, Spot]:
        """What a term says about itself, and where it acts."""
        ...

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        ...

    def scale_uncertainty(self, term: Term) -> Sequence[float]:
        """Relative deviations of its parameters that recordings cannot lower: what scales them leaves no trace."""
        ...

    def simulated_interval(self, term: Term) -> tuple[float, float] | None:
        """Strengths between which simulations meet the recordings as well; None where a fit's curvature tells them."""
        ...

    def groups(self) -> Mapping[str, AnyArray]:
        """Channels that are looked at together, by name."""
        ...

    def predict(self, point: Point, run: int) -> Sequence[Array]:
        """Simulated values of every channel of a recording at its samples, SI; infinite where that is impossible."""
        ...

    # What it is made of.

    @property
    def innermost(self) -> DiagnosisModel:
        """The model that simulates: itself, or what its wrappers hold."""
        ...

    def innermost_point(self, point: Point) -> Point:
        """A point as the innermost model knows it."""
        ...

    @property
    def plain(self) -> DiagnosisModel:
        """The model with the noise of the sensors as it is: what is left is stated in that."""
        ...

    @property
    def inflation(self) -> Array:
        """Factor of the variance of each channel by which it is known to err beyond its noise, shape (channels,)."""
        ...

    @property
    def coil_network(self) -> CoilNetworkModel | None:
        """The coil network that simulates it, with its equations by unit; None where other equations do.

        By them units are driven alone, structure is analysed, experiments are designed and circuits amended.
        """
        ...

    # What can be asked of it.

    @property
    def is_fast(self) -> bool:
        """Whether a simulation takes milliseconds."""
        ...

    @property
    def can_be_searched_again(self) -> bool:
        """Whether another search takes a minute or two: not many channels and numbers, not many steps."""
        ...

    @property
    def can_be_refitted(self) -> bool:
        """Whether a few fits of its numbers alone take seconds."""
        ...

    @property
    def can_be_fitted(self) -> bool:
        """Whether it has residuals and derivatives; else it predicts alone, and each prediction takes minutes."""
        ...

    @property
    def has_scatter(self) -> bool:
        """Whether its noise holds what the simulation scatters by itself (contacts of a fabric)."""
        ...

    def refine(self, point: Point) -> bool:
        """See `diagnosis.search.problem.refined`."""
        ...

    def solving_error(self, point: Point) -> Array | None:
        """About how far residuals are from those of a co-simulation with infinitely short macro-steps.

        Shape (residuals,), in deviations of the noise; None where that is not known.
        """
        ...

    def row_shifts(self, point: Point) -> Array:
        """How residuals move where changes of a recorded input came half a row of its table earlier than they stand.

        One for each input of each recording that was sampled; shape (inputs, residuals), in deviations of the noise; no
        rows where there is no such input, or where that is not known.
        """
        ...

    @property
    def has_ridges(self) -> bool:
        """See `diagnosis.search.problem.has_ridges`."""
        ...

    @property
    def sizes_are_believed(self) -> bool:
        """See `diagnosis.search.problem.limits_of`."""
        ...

    @property
    def residual_of_reading(self) -> AnyArray | None:
        """Residual that each reading is part of, run by run, channel by channel; None: each reading has its own."""
        ...

    # When things happen in it.

    @property
    def timeline(self) -> Timeline | None:
        """The fitted recordings laid end to end; None where no law of it has an instant."""
        ...

    def step_ends(self, run: int) -> Array:
        """Instants at which steps of the simulation of a recording end [s], shape (steps + 1,).

        What sets in within a step is spread over it. Empty where readings hang on no step.
        """
        ...

    # What may be missing, and how it is looked for.

    @property
    def untried(self) -> tuple[str, ...]:
        """Where no law can be tried, and why."""
        ...

    @property
    def hidden(self) -> tuple[str, ...]:
        """Components that hide their states: laws inside them are described at their inputs and outputs alone."""
        ...

    @property
    def answers(self) -> Answers | None:
        """What its search simulated, with channels that nobody recorded; None where a simulation costs nothing."""
        ...

    def input_terms(self) -> list[Term]:
        """Every input of every recording, as it may have been another within an interval."""
        ...

    def faults(self) -> tuple[Term, ...]:
        """Faults with begin and end that a search tries beside `terms`."""
        ...

    def interval_scores(self, base: Fit, projection: Projection, scaled: Scaled = unscaled) -> Scoring | None:
        """The best interval of every fault; None where none is looked for.

        Args:
            base: Converged fit, of this model or of one that wraps it.
            projection: Of that fit, with nulls.
            scaled: What wrapping models make of changes of residuals.
        """
        ...

    def near_intervals(self, point: Point) -> Iterable[Point]:
        """Points with begin or end of a fault elsewhere."""
        ...

    def own_search(self, settings: Settings, on_progress: Callable[[str], None]) -> Outcome | None:
        """Outcome of a search of its own kind; None where it is searched as any other (`diagnosis.model_error`).

        Args:
            settings: Of the search.
            on_progress: Told what is being done.

        Raises:
            InputError: It cannot be simulated.
        """
        ...

    # What its simulation scatters by itself.

    def scatter(self) -> Scatter:
        """What its own search found the simulation to scatter by; nothing where it does not."""
        ...

    def take_scatter(self, scatter: Scatter) -> None:
        """Count scatter that another model of the same rig found as noise of the same channels.

        Args:
            scatter: See `scatter`.
        """
        ...

    # As a judge of other recordings, and after the search.

    def is_moved_by(self, term: Term, values: Sequence[float]) -> bool:
        """Whether a term changes any residual of these recordings, at the nominal point.

        Args:
            term: Of a model of the same rig.
            values: Of its parameters.
        """
        ...

    def judged_by(self, point: Point) -> str:
        """What simulated recordings that judge, for people.

        Args:
            point: At which they were judged, of this model.
        """
        ...

    def restated(self, scenario: Scenario, point: Point) -> Scenario | None:
        """The scenario with a point's numbers that all recordings share; None where the model does not state them.

        Args:
            scenario: What was diagnosed.
            point: Fitted values, of this model.
        """
        ...

    def amend(self, scenario: Scenario, point: Point, folder: Path) -> Path | None:
        """Write the scenario with a point's numbers and laws; None where there is no way to.

        A scenario with a coil network is amended by that (`diagnosis.amend.amend`).

        Args:
            scenario: What was diagnosed.
            point: Fitted values, of this model.
            folder: Where the scenario goes.

        Returns:
            The file that `cosim run` takes.

        Raises:
            CannotAmend: Something that was found has no place in a scenario.
            InputError: An FMU cannot be compiled.
        """
        ...


class ModelBase:
    """What most models that simulate answer to the questions of `DiagnosisModel`.

    A new kind of model begins with it and answers otherwise where it is otherwise.
    """

    parameters: Sequence[Parameter]
    layout: Layout

    @property
    def innermost(self: DiagnosisModel) -> DiagnosisModel:
        """Itself."""
        return self

    def innermost_point(self, point: Point) -> Point:
        """The point."""
        return point

    @property
    def plain(self: DiagnosisModel) -> DiagnosisModel:
        """Itself."""
        return self

    @property
    def inflation(self) -> Array:
        """1 for each channel: its noise is that of the sensors."""
        return np.ones(len(self.layout.names))

    @property
    def coil_network(self) -> CoilNetworkModel | None:
        """None."""
        return None

    @property
    def is_fast(self) -> bool:
        """False."""
        return False

    @property
    def can_be_searched_again(self) -> bool:
        """False."""
        return False

    @property
    def can_be_refitted(self) -> bool:
        """As far as it can be searched again."""
        return self.can_be_searched_again

    @property
    def can_be_fitted(self) -> bool:
        """True."""
        return True

    def simulated_interval(self, term: Term) -> tuple[float, float] | None:
        """None: its fits are of simulations."""
        return None

    def refine(self, point: Point) -> bool:
        """False: it simulates all points alike."""
        return False

    def solving_error(self, point: Point) -> Array | None:
        """None: not known."""
        return None

    def row_shifts(self, point: Point) -> Array:
        """No rows: not known."""
        return np.zeros((0, len(self.layout.time)))

    @property
    def has_scatter(self) -> bool:
        """False."""
        return False

    @property
    def has_ridges(self) -> bool:
        """False."""
        return False

    @property
    def sizes_are_believed(self) -> bool:
        """False: the readings decide."""
        return False

    @property
    def residual_of_reading(self) -> AnyArray | None:
        """None: each reading has its own residual."""
        return None

    @property
    def timeline(self) -> Timeline | None:
        """None: no law has an instant."""
        return None

    def step_ends(self, run: int) -> Array:
        """None are told."""
        return np.zeros(0)

    @property
    def untried(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    @property
    def hidden(self) -> tuple[str, ...]:
        """None."""
        return ()

    @property
    def answers(self) -> Answers | None:
        """None."""
        return None

    def input_terms(self) -> list[Term]:
        """None."""
        return []

    def faults(self) -> tuple[Term, ...]:
        """None; `diagnosis.faults.model.with_faults` adds them."""
        return ()

    def interval_scores(self, base: Fit, projection: Projection, scaled: Scaled = unscaled) -> Scoring | None:
        """None: no fault is looked for."""
        return None

    def near_intervals(self, point: Point) -> Iterable[Point]:
        """None."""
        return ()

    def own_search(self, settings: Settings, on_progress: Callable[[str], None]) -> Outcome | None:
        """None: it is searched as any other."""
        return None

    def scatter(self) -> Scatter:
        """Nothing: the same simulation gives the same values."""
        return Scatter()

    def take_scatter(self, scatter: Scatter) -> None:
        """Nothing is taken."""

    def is_moved_by(self: DiagnosisModel, term: Term, values: Sequence[float]) -> bool:
        """By its terms of the same name, and its residuals; False where it has none of that name."""
        own = {str(t): t for t in self.terms()}.get(str(term))
        if own is None:
            return False
        nominal = Point(np.zeros(len(self.parameters)))
        without, with_it = self.residuals([nominal, nominal.plus(own, tuple(values))])
        return not np.array_equal(without, with_it)

    def judged_by(self, point: Point) -> str:
        """The model that was fitted."""
        return "the model that was fitted"

    def restated(self, scenario: Scenario, point: Point) -> Scenario | None:
        """None: it does not state them."""
        return None

    def amend(self, scenario: Scenario, point: Point, folder: Path) -> Path | None:
        """None: there is no way to."""
        return None
