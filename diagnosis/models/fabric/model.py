"""A scenario with a fabric and its recordings, as the model that the search varies: coil network and Bullet."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from cosim.components import FabricComponent
from cosim.compute.batch import Batches
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.answers import Answers
from diagnosis.models.coil_network.kernel.places import Place
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.translate import NoCoilNetwork, translate
from diagnosis.models.fabric.amended import amend_fabric, judged_by
from diagnosis.models.fabric.bins import Binning
from diagnosis.models.fabric.camera import Camera, CameraLaw
from diagnosis.models.fabric.laws import LinkPlace, fabric_laws, link_laws, link_places
from diagnosis.models.fabric.mechanical import MechanicalModel
from diagnosis.models.fabric.runs import (
    BulletRuns,
    ClosedRuns,
    FabricRuns,
    beginning,
    divided,
    fabric_layout,
    fabric_of,
    in_other_engine,
)
from diagnosis.models.fabric.scatter import FEWEST
from diagnosis.models.fabric.search import SAME, STEP, search_fabric
from diagnosis.models.fabric.unmeasured import UnmeasuredBins, with_unmeasured
from diagnosis.models.protocol import ComparedRun, ComparedSeries, Labelled, ModelBase, Scatter, compared_run
from diagnosis.models.timeline import Timeline
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.cosim_model import with_law
from diagnosis.search.free_numbers import Free, Numbers, free_parameters
from diagnosis.search.problem import Layout, Parameter, Point, Term
from diagnosis.search.search import Outcome, Settings
from diagnosis.search.unit_law import UnitLaw

#: Speed of random starts where the scenario gives none [m/s]: within milliseconds it moves links by micrometres.
START_SPEED = 1e-3
#: Share of the time of a recording that is simulated first where it is asked whether anything moves at all.
BEGIN = 0.1
#: Simulations from starts of their own whose mean is a prediction. Of three, a quarter less of a gain is by chance than
#: of one run against another (docs/decisions/0033-means-of-several-runs.md).
PREDICTED = 3


class FabricModel(ModelBase):
    """See `diagnosis.models.protocol.DiagnosisModel`.

    Currents, temperatures and stiffness come from the coil network, poses from Bullet. The search varies the mechanical
    part through `prepared`, which `diagnosis.models.fabric.search` makes from few simulations;
    `predict` always simulates.

    Args:
        scenario: What the recordings are compared with.
        recordings: Recordings of it.
        catalogue: Candidates of the coil network.
        batches: Makes the simulations of the fabric.
        without: Laws of the fabric that the model must not know.
        timeline: Recordings that were fitted, where these are others.

    Raises:
        InputError: A scenario is wrong, a recording does not fit it, or it has no mechanical channel.
    """

    def __init__(
        self,
        scenario: Scenario,
        recordings: Sequence[Recording],
        catalogue: Sequence[CandidateTerm],
        batches: Batches | None = None,
        without: Sequence[str] = (),
        timeline: Timeline | None = None,
    ) -> None:
        name = fabric_of(scenario)
        assert name is not None, "the scenario has one fabric"
        self.component, self.batches = name, batches or Batches()
        parts = [divided(r, name) for r in recordings]
        self.mechanical_recordings = [p[1] for p in parts]
        for whole, (_, own) in zip(recordings, parts):
            if not own.channels:
                raise InputError(
                    whole.path / "recording.yaml",
                    "channels",
                    "no channel measures the fabric",
                    "diagnose circuit and coils with a scenario that has no fabric",
                )
        self.network = _network(scenario, [p[0] for p in parts], catalogue, timeline)
        found = fabric_layout(scenario, name)
        given = scenario.components[name]
        assert isinstance(given, FabricComponent)
        #: The recordings with channels that nobody recorded behind their own: the same simulations give both.
        self._wider = with_unmeasured(self.mechanical_recordings, 2 * given.rows, len(found.row))
        self.fabric_runs = self._simulations(scenario, self._wider)
        self._scenario = scenario
        #: Why no other engine was asked; empty where one was, or was not asked yet.
        self._is_alone = ""
        self.free: list[Free] = [f for f in free_parameters(scenario, recordings) if f.component == name]
        self._numbers = Numbers(scenario)
        self._laws: dict[Term, UnitLaw] = {u.place.term: u for u in fabric_laws(name)}
        of_links = link_laws(name, link_places(name, found))
        #: Terms of rows and links to where they act.
        self.link_places: Mapping[Term, LinkPlace] = {t: place for t, (_, place) in of_links.items()}
        self._laws |= {t: law for t, (law, _) in of_links.items()}
        self._laws = {t: law for t, law in self._laws.items() if t.identifier not in without}
        own_parameters = [f.parameter for f in self.free]
        self.parameters: Sequence[Parameter] = [*(self.network.parameters if self.network else ()), *own_parameters]
        self.binning = Binning(self.mechanical_recordings)
        self.camera = Camera(
            self.binning.targets, self.binning.bins.channel, self.binning.bins.time, self.binning.recordings
        )
        self._camera_terms = {t: own for t, own in self.camera.terms.items() if t.identifier not in without}
        self._cameras = [_camera_of(r) for r in self.mechanical_recordings]
        self._mechanical: MechanicalModel | None = None
        #: What each residual belongs to, those of the coil network first; known once it is prepared.
        self.layout = Layout(np.zeros(0), np.zeros(0), (), ())
        self._scatter = Scatter()
        self._intervals: dict[Term, tuple[float, float]] = {}
        self._has_speed = "start_speed" in given.parameters
        recorded = [len(r.channels) for r in self.mechanical_recordings]
        self._unmeasured = UnmeasuredBins(self.binning, self._wider, recorded)
        #: Points and starts that were simulated and what they gave, recorded or not; the same of the other engine.
        self._kept: list[tuple[Point, int, Array]] = []
        self._kept_elsewhere: list[tuple[Point, int, Array]] = []

    def _simulations(self, scenario: Scenario, recordings: Sequence[Recording]) -> FabricRuns:
        if self.network is None:
            return ClosedRuns(scenario, self.component, recordings, self.batches)
        return BulletRuns(scenario, self.component, recordings, self.network, self.batches)

    @property
    def timeline(self) -> Timeline | None:
        """The recordings laid end to end; None where it has no coil network."""
        return self.network.timeline if self.network else None

    @property
    def first_own(self) -> int:
        """Index of the first parameter of the fabric: those of the coil network come before."""
        return len(self.network.parameters) if self.network else 0

    @property
    def simulations(self) -> int:
        """How many were made so far, of the coil network and of Bullet."""
        return self.batches.made + (self.network.simulations if self.network else 0)

    def prepare(self, mechanical: MechanicalModel) -> None:
        """Give it the mechanical part that the search varies."""
        self._mechanical, own = mechanical, mechanical.layout
        if self.network is None:
            self.layout = own
            return
        first = self.network.layout
        self.layout = Layout(
            np.concatenate([first.channel, own.channel + len(first.names)]),
            np.concatenate([first.time, own.time]),
            (*first.names, *own.names),
            (*first.units, *own.units),
            np.arange(len(first.time) + len(own.time)) >= len(first.time),
        )

    @property
    def can_be_fitted(self) -> bool:
        """Whether the mechanical part is prepared; a model that only judges simulates each point by Bullet."""
        return self._mechanical is not None

    @property
    def prepared(self) -> MechanicalModel:
        """The mechanical part, once it was simulated."""
        assert self._mechanical is not None, "search_fabric prepares it"
        return self._mechanical

    @property
    def runs(self) -> Sequence[ComparedRun]:
        """One for each recording, in order; scatter that is known counts as noise of its channel."""
        found = []
        for number, recording in enumerate(self.mechanical_recordings):
            given = self.network.runs[number].series if self.network else ()
            electrical = tuple(ComparedSeries(s.channel, s.samples, s.used) for s in given)
            own = []
            for c in recording.channels.values():
                scatter = self._scatter.deviations.get(c.name, 0.0)
                both = replace(
                    c,
                    deviation=float(np.hypot(c.deviation, scatter)),
                    scatter=scatter,
                    scatter_together=self._scatter.together,
                    scatter_runs=PREDICTED,
                )
                own.append(ComparedSeries(both, np.arange(len(c.times)), ~c.is_clipped))
            found.append(compared_run((*electrical, *own)))
        return found

    @property
    def residual_of_reading(self) -> AnyArray:
        """Residual of the search that each reading is part of, run by run, channel by channel."""
        found: list[AnyArray] = []
        begin, channel = 0, 0
        first = len(self.network.layout.time) if self.network else 0
        for number, recording in enumerate(self.mechanical_recordings):
            for series in self.network.runs[number].series if self.network else ():
                found.append(begin + np.arange(len(series.samples)))
                begin += len(series.samples)
            for _ in recording.channels:
                found.append(first + self.binning.bin_of(channel))
                channel += 1
        return np.concatenate(found)

    @property
    def effort(self) -> float:
        """Of one simulation of every recording: links times micro-steps, and more for many iterations."""
        return self.fabric_runs.effort

    def network_point(self, point: Point) -> Point:
        """What of a point belongs to the coil network."""
        return Point(point.base[: self.first_own], {t: v for t, v in point.terms.items() if not self._is_own(t)})

    def _is_own(self, term: Term) -> bool:
        return term in self._laws or term in self._camera_terms

    def own_point(self, point: Point) -> Point:
        """What of a point belongs to the fabric."""
        return Point(point.base[self.first_own :], {t: v for t, v in point.terms.items() if self._is_own(t)})

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        own = self.prepared.residuals([self.own_point(p) for p in points])
        if self.network is None:
            return own
        return np.hstack([self.network.residuals([self.network_point(p) for p in points]), own])

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        own = self.prepared.base_jacobian(self.own_point(point))
        if self.network is None:
            return own
        first = self.network.base_jacobian(self.network_point(point))
        whole = np.zeros((len(first) + len(own), first.shape[1] + own.shape[1]), dtype=first.dtype)
        whole[: len(first), : first.shape[1]] = first
        whole[len(first) :, first.shape[1] :] = own
        return whole

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """See `diagnosis.search.problem.strength_slopes`."""
        own = [i for i, (term, _) in enumerate(tasks) if self._is_own(term)]
        others = [i for i, (term, _) in enumerate(tasks) if not self._is_own(term)]
        count = len(self.prepared.measured)
        first = len(self.network.layout.time) if self.network else 0
        found = np.zeros((len(tasks), first + count))
        found[own, first:] = self.prepared.slopes(self.own_point(point), [tasks[i] for i in own])
        if self.network is not None and others:
            found[others, :first] = self.network.slopes(self.network_point(point), [tasks[i] for i in others])
        return found

    def laws(self) -> list[Term]:
        """Effects of the fabric alone, which are simulated: those of all links, of rows, of single links."""
        return list(self._laws)

    def camera_terms(self) -> list[Term]:
        """What the camera may do to places: known without a simulation."""
        return list(self._camera_terms)

    def terms(self) -> list[Term]:
        """Every law that may be missing, at every place."""
        return [*(self.network.terms() if self.network else ()), *self._laws, *self._camera_terms]

    def where(self, term: Term) -> tuple[UnitLaw | CameraLaw | CandidateTerm, Labelled | Place]:
        """Effect and place of a term."""
        if term in self._laws:
            return self._laws[term], Labelled(term.place)
        if term in self._camera_terms:
            return self._camera_terms[term]
        assert self.network is not None
        return self.network.where(term)

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        return None if self._is_own(term) or self.network is None else self.network.shows_in(term)

    def scale_uncertainty(self, term: Term) -> tuple[float, ...]:
        """See `DiagnosisModel`: masses are taken as given."""
        return (0.0,) * len(term.parameters)

    def simulated_interval(self, term: Term) -> tuple[float, float] | None:
        """See `diagnosis.models.fabric.strengths.interval_of`; None of what was not found, or costs no simulation."""
        return self._intervals.get(term)

    def take_interval(self, term: Term, interval: tuple[float, float]) -> None:
        """Remember between which strengths simulations meet the recordings as well."""
        self._intervals[term] = interval

    def groups(self) -> Mapping[str, AnyArray]:
        """Channels of the coil network that are looked at together."""
        return self.network.groups() if self.network else {}

    def fabric_parameters(self, point: Point, number: int, start: int = 0) -> dict[str, PhysicalValue]:
        """Parameters of the fabric at a point, for one recording.

        Args:
            point: The point.
            number: Of the recording.
            start: Which random start; 0: that of the scenario.
        """
        own = self.own_point(point)
        found = {}
        for free, z in zip(self.free, own.base):
            if free.belongs_to(number) and z:
                found[free.name] = PhysicalValue(free.parameter.value(float(z)), free.parameter.unit)
        for term, values in own.terms.items():
            if term not in self._laws:  # what the camera does moves nothing
                continue
            law = self._laws[term].place
            for name in law.names:
                found.update(with_law(self._numbers, replace(law, names=(name,)), values, found))
        if start:
            found["start_number"] = PhysicalValue(float(start), "1")
            if not self._has_speed:
                found["start_speed"] = PhysicalValue(START_SPEED, "m/s")
        return found

    def simulated(self, wanted: Sequence[tuple[Point, int]]) -> list[Array | None]:
        """Bins of all recordings, for points and starts; None where a run stopped.

        Args:
            wanted: Point and number of its random start.
        """
        return self._bins_by(self.fabric_runs, wanted, self._kept)

    def begins_as_plain(self, wanted: Sequence[Point], plain: Point, start: int) -> list[bool]:
        """Whether fabrics move at first (`BEGIN`) exactly as the plain one does; a run of that costs little.

        Args:
            wanted: Points with something that may do nothing.
            plain: The point without it.
            start: Random start of all of them.
        """
        short = [beginning(r, BEGIN) for r in self._wider]
        recordings = [r for r in short if r is not None]
        if len(recordings) < len(short):
            return [True] * len(wanted)
        runs = self._simulations(self._scenario, recordings)
        first, *others = self._made(runs, [(p, start) for p in (plain, *wanted)])
        return [_are_same(first, other) for other in others]

    def simulated_elsewhere(self, wanted: Sequence[tuple[Point, int]]) -> list[Array | None]:
        """The same by the other engine; empty where it is not installed or cannot simulate such a fabric."""
        try:
            runs = self._simulations(in_other_engine(self._scenario, self.component), self._wider)
        except InputError as error:
            self._is_alone = str(error)
            return []
        found = self._bins_by(runs, wanted, self._kept_elsewhere)
        if not any(f is not None for f in found):
            self._is_alone = (runs.reasons or ["it stops"])[0]
        return found

    @property
    def untried(self) -> tuple[str, ...]:
        """What was not tried, and why: the error of the engine that simulates."""
        if not self._is_alone:
            return ()
        return (f"what two engines differ by is not known and not counted as uncertainty: {self._is_alone}",)

    def _made(self, runs: FabricRuns, wanted: Sequence[tuple[Point, int]]) -> list[list[list[Array] | None]]:
        """Values of every recording, for points and starts."""
        count = len(self.mechanical_recordings)
        points: dict[int, Point] = {id(p): self.network_point(p) for p, _ in wanted}
        tasks = [(n, self.fabric_parameters(p, n, s), points[id(p)]) for p, s in wanted for n in range(count)]
        values = runs.make(tasks)
        return [values[first : first + count] for first in range(0, len(values), count)]

    def _bins_by(
        self, runs: FabricRuns, wanted: Sequence[tuple[Point, int]], kept: list[tuple[Point, int, Array]]
    ) -> list[Array | None]:
        found: list[Array | None] = []
        for (point, start), values in zip(wanted, self._made(runs, wanted)):
            whole = [v for v in values if v is not None]
            if len(whole) < len(values):
                found.append(None)
                continue
            recorded, others = self._unmeasured.divided(whole)
            found.append(self.binning.bins_of(recorded))
            kept.append((self.own_point(point), start, np.concatenate([found[-1], others])))
        return found

    @property
    def answers(self) -> Answers | None:
        """Runs of the search at one parameter or one effect of all links, with channels that nobody recorded."""
        nominal = {start: row for point, start, row in self._kept if _is_nominal(point)}
        if len(nominal) < FEWEST:
            return None
        plain = np.array(list(nominal.values()))
        mean = plain.mean(axis=0)
        elsewhere = [row for point, _, row in self._kept_elsewhere if _is_nominal(point)]
        slopes = np.zeros((len(self.free), len(mean)))
        for i in range(len(self.free)):
            own = [row for point, _, row in self._kept if not point.terms and _is_unit(point.base, i)]
            if own:
                slopes[i] = (np.mean(own, axis=0) - mean) / STEP
        effects: dict[Term, dict[float, list[Array]]] = {}
        for point, start, row in self._kept:
            if start in nominal or len(point.terms) != 1 or np.any(point.base):
                continue  # a start of the plain fabric would be in both that are compared
            ((term, values),) = point.terms.items()
            if term in self._laws and term not in self.link_places:
                effects.setdefault(term, {}).setdefault(values[0], []).append(row)
        return Answers(
            self._unmeasured.with_scale(plain),
            self._unmeasured.extra,
            plain,
            np.mean(elsewhere, axis=0) - mean if elsewhere else None,
            slopes,
            {t: {s: np.array(rows) for s, rows in own.items()} for t, own in effects.items()},
            [f.name for f in self.free],
        )

    def predict(self, point: Point, run: int) -> list[Array]:
        """Values of every channel of a recording at its samples, SI: the mean of `PREDICTED` simulations of the fabric,
        never the surface; infinite where one of them stopped."""
        own = self.network_point(point)
        first = list(self.network.predict(own, run)) if self.network else []
        made = self.fabric_runs.make([(run, self.fabric_parameters(point, run, s), own) for s in range(PREDICTED)])
        channels = self.mechanical_recordings[run].channels.values()
        whole = [m for m in made if m is not None]
        if len(whole) < len(made):
            return [*first, *(np.full(len(c.times), np.inf) for c in channels)]
        own_channels = [np.mean(runs, axis=0) for runs in list(zip(*whole))[: len(channels)]]
        seen = self._cameras[run].seen(np.concatenate(own_channels), point.terms)
        return [*first, *np.split(seen, np.cumsum([len(v) for v in own_channels])[:-1])]

    @property
    def has_scatter(self) -> bool:
        """True: contacts scatter."""
        return True

    def scatter(self) -> Scatter:
        """Contact scatter by channel, and how far channels scatter together, once it is prepared."""
        deviation = self.prepared.scatter_deviation()
        found: dict[str, list[float]] = {}
        for number, name in enumerate(self.binning.plain_names):
            found.setdefault(name, []).extend((deviation[self.prepared.bins.channel == number] ** 2).tolist())
        deviations = {name: float(np.sqrt(np.mean(squares))) for name, squares in found.items()}
        return Scatter(deviations, self.prepared.scatters_together())

    def take_scatter(self, scatter: Scatter) -> None:
        """Count contact scatter as noise of the channels."""
        self._scatter = scatter

    def own_search(self, settings: Settings, on_progress: Callable[[str], None]) -> Outcome:
        """See `diagnosis.models.fabric.search.search_fabric`."""
        return search_fabric(self, settings, on_progress)

    def judged_by(self, point: Point) -> str:
        """The engine, driven by the coil network or in the closed co-simulation."""
        given = self._scenario.components[self.component]
        assert isinstance(given, FabricComponent)
        return judged_by(given.engine, PREDICTED, self.network is not None)

    def amend(self, scenario: Scenario, point: Point, folder: Path) -> Path:
        """See `diagnosis.models.fabric.amended.amend_fabric`."""
        return amend_fabric(scenario, self, point, folder)

    def is_moved_by(self, term: Term, values: Sequence[float]) -> bool:
        """Asked of its coils: it is not fitted where it judges, and what has an instant or a day belongs to them."""
        return self.network is not None and self.network.is_moved_by(term, values)


def _are_same(one: Sequence[list[Array] | None], other: Sequence[list[Array] | None]) -> bool:
    """Whether two runs of all recordings gave the same; runs that stopped are not compared."""
    if any(part is None for part in (*one, *other)):
        return True
    pairs = [(a, b) for own, rest in zip(one, other) for a, b in zip(own or [], rest or [])]
    return all(np.allclose(a, b, rtol=0.0, atol=SAME) for a, b in pairs)


def _is_nominal(point: Point) -> bool:
    return not point.terms and not np.any(point.base)


def _is_unit(base: Array, number: int) -> bool:
    """Whether one parameter alone is off, by the step at which its answer is simulated."""
    return bool(base[number] == STEP and np.count_nonzero(base) == 1)


def _camera_of(recording: Recording) -> Camera:
    """What is seen of the samples of a recording, channel after channel."""
    channels = list(recording.channels.values())
    number = np.repeat(np.arange(len(channels)), [len(c.times) for c in channels])
    return Camera(
        [c.target for c in channels], number, np.concatenate([c.times for c in channels]), [0] * len(channels)
    )


def _network(
    scenario: Scenario, recordings: Sequence[Recording], catalogue: Sequence[CandidateTerm], timeline: Timeline | None
) -> CoilNetworkModel | None:
    """The coil network of the other channels; None where there are none, or where no network simulates them.

    Raises:
        InputError: Some recordings have such channels and some not, or nothing simulates them.
    """
    if not any(r.channels for r in recordings):
        return None
    for recording in recordings:
        if not recording.channels:
            raise InputError(
                recording.path / "recording.yaml",
                "channels",
                "it measures the fabric alone, other recordings do not",
                "measure the same kinds of channels in every recording",
            )
    try:
        for recording in recordings:
            translate(scenario_of(scenario, recording))
    except NoCoilNetwork as reason:
        channel = next(iter(recordings[0].channels))
        raise InputError(
            recordings[0].path / "recording.yaml",
            f"channels.{channel}",
            f"in a scenario with a fabric this channel needs the coil network, but {reason}",
            "give channels of the fabric alone, or use thermal_stiffness as actuator",
        ) from reason
    # The network has no load here: what moves coils is the fabric's.
    return CoilNetworkModel(scenario, recordings, [c for c in catalogue if c.unit != "mechanical"], timeline=timeline)
