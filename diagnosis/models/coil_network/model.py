"""Coil network and recordings as the model that the search varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from cosim.scenario import Scenario
from cosim.unit.protocol import AnyArray, Array
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.faults import network_inputs
from diagnosis.faults.law import Span, fault_term, occasion, unstated_terms
from diagnosis.models.coil_network.free import FreeSet, directions, free_parameters, sensor_values
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork, CoilNetworkError
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import Place, merge, places
from diagnosis.models.coil_network.kernel.probes import Probe, flat_probe_sensitivities
from diagnosis.models.coil_network.kernel.sensitivities import flat_sensitivities, shared_outputs
from diagnosis.models.coil_network.priors import daily_priors, own_priors, stated_priors
from diagnosis.models.coil_network.rig_scales import rig_scales
from diagnosis.models.coil_network.runs import Run, check_rig, clocks, deviation, network_quantity, own_name
from diagnosis.models.coil_network.stated import stated_candidates
from diagnosis.models.coil_network.term_at import term_at
from diagnosis.models.coil_network.translate import translate
from diagnosis.models.protocol import ModelBase
from diagnosis.models.timeline import Seat, Timeline
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.labels import labels
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Layout, Parameter, Point, Term

#: Derivatives of residuals by parameters from which another search would take minutes.
SEARCHED_AGAIN = 200_000
#: Unit (electrical, ...) whose output a quantity is.
UNIT_OF_QUANTITY = {
    "temperature": "thermal",
    "current": "electrical",
    "supply_current": "electrical",
    "resistance": "electrical",
    "power": "electrical",
    "extension": "mechanical",
    "length": "mechanical",
    "stiffness": "stiffness",
    "tension": "mechanical",
    "voltage": "electrical",
    "string_voltage": "electrical",
    "terminal_voltage": "electrical",
    "supply_power": "electrical",
}


class CoilNetworkModel(ModelBase):
    """See `diagnosis.models.protocol.DiagnosisModel`.

    Args:
        scenario: What the recordings are compared with.
        recordings: Training recordings.
        catalogue: Candidate terms that are compiled in.
        threads: Threads that share simulations.
        timeline: Recordings that were fitted, where these are others: terms have their instants on its axis.

    Raises:
        NoCoilNetwork: The scenario is none for a network.
        InputError: A recording does not fit the scenario, it is of other coils, strings or supplies than the first, or
            the recordings do not say their order clearly.
    """

    def __init__(
        self,
        scenario: Scenario,
        recordings: Sequence[Recording],
        catalogue: Sequence[CandidateTerm],
        threads: int = 1,
        timeline: Timeline | None = None,
    ) -> None:
        self._threads = threads
        self.simulations = 0
        translations = [translate(scenario_of(scenario, r)) for r in recordings]
        for recording, translation in zip(recordings, translations):
            check_rig(translation.layout, translations[0].layout, recording)
        for recording in recordings:  # what it cannot compare is said before it is compiled
            for channel in recording.channels.values():
                network_quantity(own_name(channel.target, translations[0]), translations[0].layout, recording)
        stated = stated_candidates(law for t in translations for law in t.parameters.terms)
        self.network = CoilNetwork(translations[0].layout, [*network_inputs.CANDIDATES, *stated, *catalogue])
        self._candidates = {t.identifier: t for t in catalogue}
        self._titles = labels(recordings)
        self._inputs: dict[Term, tuple[CandidateTerm, Place]] = {}
        self.runs = [Run(t, r, self.network) for t, r in zip(translations, recordings)]
        spans = [(run.translation.start, max(float(t[-1]) for t in run.times.values())) for run in self.runs]
        self._timeline = Timeline.of(recordings, spans) if timeline is None else timeline
        #: Where each recording lies on the joint axis.
        self.seats = self.timeline.seats if timeline is None else timeline.others(recordings, spans)
        self.measured = sorted({s.quantity for run in self.runs for s in run.series})
        nominal = translations[0].parameters.base
        first = translations[0]
        priors = stated_priors(first.uncertainty, first.scatter)
        daily = daily_priors([own_priors(r, first.actuator, first.ambient, first.layout.coils) for r in recordings])
        self._free = list(free_parameters(self.coils, nominal, self.measured, clocks(self.runs), priors, daily))
        self._sensors = sensor_values(self._free)
        self._sets = [FreeSet(self._free, number) for number in range(len(self.runs))]
        self._shown: dict[Term, tuple[list[int], bool] | None] = {}
        self.parameters: Sequence[Parameter] = [f.parameter for f in self._free]
        self._places: dict[Term, tuple[CandidateTerm, Place]] = {}
        self.layout = self._layout(recordings)
        every = [s for run in self.runs for s in run.series]
        self._channel_axis = np.array([QUANTITIES[s.quantity].axis for s in every])
        self._channel_element = np.array([s.element for s in every])
        self._noise = np.zeros(self.coils.size("channel"))
        for one in every:
            self._noise[self.coils.channel(one.quantity) + one.element] = deviation(one.channel)
        self._channel_number = np.array([self.coils.channel(s.quantity) + s.element for s in every])

    @property
    def timeline(self) -> Timeline:
        """The fitted recordings laid end to end."""
        return self._timeline

    def step_ends(self, run: int) -> Array:
        """Instants at which steps of the simulation of a recording end [s], shape (steps + 1,)."""
        return np.asarray(self.runs[run].inputs.time)

    @property
    def is_fast(self) -> bool:
        """True."""
        return True

    @property
    def can_be_searched_again(self) -> bool:
        """Whether it is not large."""
        return len(self.layout.time) * len(self.parameters) < SEARCHED_AGAIN

    def judged_by(self, point: Point) -> str:
        """The network itself, as long as no free run takes its place (`diagnosis.amend.evaluate`)."""
        return "the fast simulation"

    @property
    def coil_network(self) -> CoilNetworkModel:
        """Itself."""
        return self

    @property
    def coils(self) -> CoilNetworkLayout:
        """Coils and strings."""
        return self.network.layout

    def _layout(self, recordings: Sequence[Recording]) -> Layout:
        channel, time = [], []
        names: list[str] = []
        units: list[str] = []
        for run, label in zip(self.runs, labels(recordings)):
            for series in run.series:
                channel.append(np.full(len(series.samples), len(names)))
                time.append(series.times)
                names.append(series.channel.name if len(recordings) == 1 else f"{series.channel.name} ({label})")
                units.append(UNIT_OF_QUANTITY[series.quantity])
        return Layout(np.concatenate(channel), np.concatenate(time), tuple(names), tuple(units))

    def terms(self) -> list[Term]:
        """Every candidate at every place, as the search sees them."""
        if not self._places:
            scales = rig_scales(self.runs[0].translation.parameters.base)
            for candidate in self._candidates.values():
                if candidate.same_as in self._candidates:
                    continue  # one law, one term: of two that are alike chance would choose
                known: set[bytes] = set()  # one coil is all coils, one source all sources
                found = sorted(places(candidate, self.coils, self.measured), key=lambda p: p.label != "all coils")
                if any(p.name == "noise" for p in candidate.parameters):
                    found = [replace(p, fixed={**p.fixed, "noise": self._noise}) for p in found]
                for place in found:
                    if place.kind == "swap" or place.mask.tobytes() not in known:
                        for own in self._on_days(candidate, place):
                            term = term_at(candidate, own, self.coils, self.runs, self.timeline, scales)
                            self._places[term] = (candidate, own)
                        known.add(place.mask.tobytes())
        return list(self._places)

    def _on_days(self, candidate: CandidateTerm, place: Place) -> list[Place]:
        """The place, and the same on each day alone for what may belong to a day and has no instant that tells which.

        A room that drifts alike in every recording is a habit of the laboratory: it stays one effect.
        """
        days = self.timeline.days
        if candidate.scope != "day" or len(days) < 2 or any(p.is_instant for p in candidate.parameters):
            return [place]
        return [place, *(replace(place, label=f"{place.label} {day.label}", day=day) for day in days)]

    def input_terms(self) -> list[Term]:
        """Every input of every recording, as it may have been another within an interval."""
        if not self._inputs:
            for number, run in enumerate(self.runs):
                times = np.unique(np.concatenate([s.times for s in run.series]))
                span = Span(float(run.inputs.time[0]), float(times[-1]), len(times))
                for driven in network_inputs.driven_places(self.coils, run.inputs):
                    label = occasion(driven.place.label, self._titles, number)
                    if driven.stretches:
                        terms = unstated_terms(label, driven.strength, driven.stretches, span, number)
                    else:
                        terms = [fault_term(driven.fault, label, driven.strength, span, number)]
                    for term in terms:
                        self._inputs[term] = (driven.candidate, replace(driven.place, label=term.place))
        return list(self._inputs)

    def where(self, term: Term) -> tuple[CandidateTerm, Place]:
        """Candidate and place of a term."""
        return self._inputs[term] if term in self._inputs else self._places[term]

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        if term not in self._shown:
            self._shown[term] = self._shows_in(*self._places[term])
        return self._shown[term]

    def scale_uncertainty(self, term: Term) -> tuple[float, ...]:
        """See `DiagnosisModel`: every scale of a network is a parameter that is fitted."""
        return (0.0,) * len(term.parameters)

    def _shows_in(self, candidate: CandidateTerm, place: Place) -> tuple[list[int], bool] | None:
        if place.kind not in ("coil", "channel", "swap", "string", "pair"):
            return None
        axis, elements = candidate.axis, np.flatnonzero(place.mask)
        if axis == "pair":
            axis, elements = "coil", np.unique([self.coils.contacts[n] for n in elements])
        own = np.where(self._channel_axis == axis, self._channel_element, -1)
        touched = np.isin(self._channel_number if axis == "channel" else own, elements)
        found = np.flatnonzero(touched).tolist()
        return (found, place.kind == "swap") if found else None

    def network_parameters(self, point: Point, run: int) -> CoilNetworkParameters:
        """Values of the network's parameters at a point, for one recording."""
        return self._parameters(point.base, self._there(point, self.seats[run]), run)

    def _parameters(self, z: Array, there: Mapping[Term, tuple[float, ...]], run: int) -> CoilNetworkParameters:
        """Values of the network's parameters with the terms that are there, instants on the clock of the recording."""
        base = {**self.runs[run].translation.parameters.base, **self._sensors}
        base["cycles_before"] = self.seats[run].cycles_before
        self._sets[run].vary(base, z)
        return CoilNetworkParameters(base, {**self.runs[run].translation.parameters.terms, **self._arrays(there)})

    def _arrays(self, there: Mapping[Term, tuple[float, ...]]) -> dict[str, Mapping[str, float | Array]]:
        terms: dict[str, Mapping[str, float | Array]] = {}
        for term, values in there.items():
            candidate, place = self.where(term)
            own = place.values(candidate, dict(zip((p.name for p in term.parameters), values)))
            if candidate.identifier in terms:
                own = merge(candidate, terms[candidate.identifier], own)
            terms[candidate.identifier] = own
        return terms

    def _there(self, point: Point, seat: Seat) -> dict[Term, tuple[float, ...]]:
        """Terms that are there in a recording, instants on its own clock."""
        found = {term: self.local_values(term, values, seat) for term, values in point.terms.items()}
        return {term: values for term, values in found.items() if values is not None}

    def local_values(self, term: Term, values: Sequence[float], seat: Seat) -> tuple[float, ...] | None:
        """Values of a term with its instants on the clock of a recording [s].

        Returns:
            None where the term is not there: it has not set in yet, or it belongs to another day or recording.
        """
        if term.recording is not None:  # a fault, whose begin and end are on the clock of its own recording
            return tuple(values) if seat == self.timeline.seats[term.recording] else None
        candidate, place = self._places[term]
        if place.day is not None and place.day != seat.day:
            return None
        local = []
        for parameter, value in zip(term.parameters, values):
            own: float | None = value
            if parameter.is_instant:
                own = self.timeline.local(value, seat, candidate.scope == "rig")
            if own is None:
                return None
            local.append(own)
        return tuple(local)

    def terms_at(self, point: Point, seat: Seat) -> dict[str, Mapping[str, float | Array]]:
        """Terms of a point as the network takes them in a recording, without those that are not there."""
        return self._arrays(self._there(point, seat))

    def groups(self) -> dict[str, AnyArray]:
        """Channels that are looked at together: the same quantity in every string, and over all coils."""
        found: dict[str, list[int]] = {}
        number = 0
        for run in self.runs:
            for s in run.series:
                if QUANTITIES[s.quantity].axis == "coil":
                    found.setdefault(f"every {s.quantity}", []).append(number)
                    if self.coils.strings:
                        string = int(self.coils.string_of_coil[s.element]) + 1
                        found.setdefault(f"{s.quantity} in string[{string}]", []).append(number)
                number += 1
        return {name: np.array(members) for name, members in found.items() if len(members) > 1}

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        found = np.full((len(points), len(self.layout.time)), np.inf)
        begin = 0
        for number, run in enumerate(self.runs):
            there = [self._there(p, self.seats[number]) for p in points]
            for group in _by_terms(there):
                alike = _alike(points, there, group)
                parameters = [self._parameters(points[i].base, there[i], number) for i, *_ in alike]
                for members, row in zip(alike, self._simulate(run, parameters)):
                    own = None if row is None else run.residuals(row[None])[0]
                    if own is not None and np.isfinite(own).all():
                        found[members, begin : begin + run.count] = own
            begin += run.count
        return found

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """Derivative of the residuals by the strength of terms, shape (tasks, residuals).

        Args:
            point: Where; the terms are absent there.
            tasks: Terms with the values of their parameters; the strength is the step of the difference.
        """
        found = np.full((len(tasks), len(self.layout.time)), np.inf)
        begin = 0
        for number, run in enumerate(self.runs):
            parameters = self.network_parameters(point, number)
            outputs = shared_outputs(self.network, parameters, run.plan)
            absent, probes = self._probes(tasks, self.seats[number])
            own = slice(begin, begin + run.count)
            begin += run.count
            found[absent, own] = 0.0
            for (_, values), at_places in probes.items():
                members = list(at_places.values())
                term = tasks[members[0][0]][0]
                shape = dict(zip((p.name for p in term.parameters[1:]), values[1:]))
                at = [self.where(tasks[same[0]][0])[1] for same in members]
                probe = Probe(self.where(term)[0], shape, at, values[0])
                self.simulations += len(members)
                try:
                    slopes = flat_probe_sensitivities(
                        self.network, parameters, run.inputs, run.times, probe, self._threads, run.plan, outputs
                    )
                except CoilNetworkError:
                    continue
                for same, slope in zip(members, run.slopes(slopes)):
                    found[same, own] = slope
        return found

    def _probes(
        self, tasks: Sequence[tuple[Term, tuple[float, ...]]], seat: Seat
    ) -> tuple[list[int], dict[tuple[str, tuple[float, ...]], dict[int, list[int]]]]:
        """Tasks whose term is not there in a recording; the others by candidate and values, and by place.

        On the clock of a recording all instants of earlier ones are one: it is there from the start.
        """
        absent: list[int] = []
        probes: dict[tuple[str, tuple[float, ...]], dict[int, list[int]]] = {}
        for i, (term, values) in enumerate(tasks):
            local = self.local_values(term, values, seat)
            if local is None:
                absent.append(i)
            else:
                probes.setdefault((self.where(term)[0].identifier, local), {}).setdefault(id(term), []).append(i)
        return absent, probes

    def _simulate(self, run: Run, parameters: Sequence[CoilNetworkParameters]) -> list[Array | None]:
        """Outputs as the network lays them out; None where a simulation failed."""
        self.simulations += len(parameters)
        try:
            _, out = self.network.simulate_flat(parameters, run.inputs, run.times, self._threads, run.own_plan)
        except CoilNetworkError:
            if len(parameters) == 1:
                return [None]
            return [self._simulate(run, [p])[0] for p in parameters]
        return list(out)

    def predict(self, point: Point, run: int) -> list[Array]:
        """Simulated values of every channel of a recording at its samples, SI."""
        one = self.runs[run]
        row = self._simulate(one, [self.network_parameters(point, run)])[0]
        values = np.full(one.count, np.inf) if row is None else row[one.pick]
        return np.split(values, np.cumsum([len(s.samples) for s in one.series])[:-1])

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        # Single precision: a fit corrects the direction, not the sum of squares, by it.
        jacobian: AnyArray = np.zeros((len(self._free), len(self.layout.time)), dtype=np.float32)
        begin = 0
        for number, run in enumerate(self.runs):
            parameters = self.network_parameters(point, number)
            along, columns = [], []
            for i, free in enumerate(self._free):
                if free.belongs_to(number):
                    for direction, weight in directions(free, parameters):
                        along.append(direction)
                        columns.append((i, weight))
            self.simulations += len(along)
            own = slice(begin, begin + run.count)
            begin += run.count
            try:
                _, _, slopes = flat_sensitivities(
                    self.network, parameters, run.inputs, run.times, along, self._threads, run.plan
                )
            except CoilNetworkError:  # on the verge of what can be simulated: there is no way on from here
                continue
            into, factors = np.array([c[0] for c in columns]), np.array([c[1] for c in columns])
            jacobian[:, own] = run.slopes(slopes, len(self._free), into, factors)
        return jacobian.T


def _by_terms(there: Sequence[Mapping[Term, tuple[float, ...]]]) -> list[list[int]]:
    """Points that switch on the same candidates are simulated together."""
    groups: dict[frozenset[str], list[int]] = {}
    for i, terms in enumerate(there):
        groups.setdefault(frozenset(t.identifier for t in terms), []).append(i)
    return list(groups.values())


def _alike(
    points: Sequence[Point], there: Sequence[Mapping[Term, tuple[float, ...]]], group: Sequence[int]
) -> list[list[int]]:
    """Points of a group that are one in a recording: an instant outside it does not matter to it."""
    found: dict[tuple[object, ...], list[int]] = {}
    for i in group:
        key = (points[i].base.tobytes(), *((id(t), v) for t, v in there[i].items()))
        found.setdefault(key, []).append(i)
    return list(found.values())
