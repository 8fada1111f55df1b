"""Coil bank and recordings as the model that the search varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from cosim.scenario import Scenario
from cosim.unit import AnyArray, Array
from diagnosis.bank.bank import Bank, BankError
from diagnosis.bank.layout import QUANTITIES, BankLayout
from diagnosis.bank.parameters import BankParameters
from diagnosis.bank.places import Place, merge, places
from diagnosis.bank.probes import Probe, flat_probe_sensitivities
from diagnosis.bank.sensitivities import flat_sensitivities, shared_outputs
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.faults import bank_inputs
from diagnosis.faults.law import INPUT, Span, fault_term, occasion
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Layout, Parameter, Point, Term
from diagnosis.simulator.free import FreeSet, directions, free_parameters, sensor_values
from diagnosis.simulator.priors import daily_priors, stated_priors
from diagnosis.simulator.runs import Run, clocks, deviation
from diagnosis.simulator.term_at import term_at
from diagnosis.simulator.translate import translate

#: Unit (electrical, ...) whose output a quantity is.
UNIT_OF_QUANTITY = {
    "temperature": "thermal", "current": "electrical", "supply_current": "electrical", "resistance": "electrical",
    "power": "electrical", "extension": "mechanical", "length": "mechanical", "stiffness": "stiffness",
}  # fmt: skip


class BankModel:
    """See `diagnosis.search.problem.Model`.

    Args:
        scenario: What the recordings are compared with.
        recordings: Training recordings.
        catalogue: Candidate terms that are compiled in.
        threads: Threads that share simulations.

    Raises:
        NoBank: The scenario is none for a bank.
        InputError: A recording does not fit the scenario.
    """

    def __init__(
        self, scenario: Scenario, recordings: Sequence[Recording], catalogue: Sequence[CandidateTerm], threads: int = 1
    ) -> None:
        self._threads = threads
        self.simulations = 0
        translations = [translate(scenario_of(scenario, r)) for r in recordings]
        self.bank = Bank(translations[0].layout, [*bank_inputs.CANDIDATES, *catalogue])
        self._candidates = {t.identifier: t for t in catalogue}
        self._titles = [r.title for r in recordings]
        self._inputs: dict[Term, tuple[CandidateTerm, Place]] = {}
        self.runs = [Run(t, r, self.bank) for t, r in zip(translations, recordings)]
        self.measured = sorted({s.quantity for run in self.runs for s in run.series})
        nominal = translations[0].parameters.base
        first = translations[0]
        priors = stated_priors(first.uncertainty, first.scatter)
        daily = [daily_priors(r, f"{first.actuator}.initial_temperature", first.ambient) for r in recordings]
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
    def coils(self) -> BankLayout:
        """Coils and strings."""
        return self.bank.layout

    def _layout(self, recordings: Sequence[Recording]) -> Layout:
        channel, time = [], []
        names: list[str] = []
        units: list[str] = []
        for run, recording in zip(self.runs, recordings):
            for series in run.series:
                channel.append(np.full(len(series.samples), len(names)))
                time.append(series.times)
                names.append(
                    series.channel.name if len(recordings) == 1 else f"{series.channel.name} ({recording.title})"
                )
                units.append(UNIT_OF_QUANTITY[series.quantity])
        return Layout(np.concatenate(channel), np.concatenate(time), tuple(names), tuple(units))

    def terms(self) -> list[Term]:
        """Every candidate at every place, as the search sees them."""
        if not self._places:
            for candidate in self._candidates.values():
                if candidate.same_as in self._candidates:
                    continue  # one law, one term: of two that are alike chance would choose
                known: set[bytes] = set()  # one coil is all coils, one source all sources
                found = sorted(places(candidate, self.coils, self.measured), key=lambda p: p.label != "all coils")
                if any(p.name == "noise" for p in candidate.parameters):
                    found = [replace(p, fixed={**p.fixed, "noise": self._noise}) for p in found]
                for place in found:
                    if place.kind == "swap" or place.mask.tobytes() not in known:
                        self._places[term_at(candidate, place, self.coils, self.runs)] = (candidate, place)
                        known.add(place.mask.tobytes())
        return list(self._places)

    def input_terms(self) -> list[Term]:
        """Every input of every recording, as it may have been another within an interval."""
        if not self._inputs:
            for number, run in enumerate(self.runs):
                times = np.unique(np.concatenate([s.times for s in run.series]))
                span = Span(float(run.inputs.time[0]), float(times[-1]), len(times))
                for candidate, place in bank_inputs.driven_places(self.coils, run.inputs):
                    label = occasion(place.label, self._titles, number)
                    term = fault_term(INPUT, label, bank_inputs.gain(), span, number)
                    self._inputs[term] = (candidate, replace(place, label=label))
        return list(self._inputs)

    def where(self, term: Term) -> tuple[CandidateTerm, Place]:
        """Candidate and place of a term."""
        return self._inputs[term] if term in self._inputs else self._places[term]

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        if term not in self._shown:
            self._shown[term] = self._shows_in(*self._places[term])
        return self._shown[term]

    def unseen(self, term: Term) -> tuple[float, ...]:
        """See `DiagnosisModel`: every scale of a bank is a parameter that is fitted."""
        return (0.0,) * len(term.parameters)

    def _shows_in(self, candidate: CandidateTerm, place: Place) -> tuple[list[int], bool] | None:
        if place.kind not in ("coil", "channel", "swap", "string"):
            return None
        axis, elements = candidate.axis, np.flatnonzero(place.mask)
        own = np.where(self._channel_axis == axis, self._channel_element, -1)
        touched = np.isin(self._channel_number if axis == "channel" else own, elements)
        found = np.flatnonzero(touched).tolist()
        return (found, place.kind == "swap") if found else None

    def bank_parameters(self, point: Point, run: int) -> BankParameters:
        """Values of the bank's parameters at a point, for one recording."""
        base = {**self.runs[run].translation.parameters.base, **self._sensors}
        self._sets[run].vary(base, point.base)
        terms: dict[str, Mapping[str, float | Array]] = {}
        for term, values in point.terms.items():
            if term.recording not in (None, run):
                continue  # it belongs to another recording
            candidate, place = self.where(term)
            own = place.values(candidate, dict(zip((p.name for p in term.parameters), values)))
            if candidate.identifier in terms:
                own = merge(candidate, terms[candidate.identifier], own)
            terms[candidate.identifier] = own
        return BankParameters(base, terms)

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
            for group in _by_terms(points):
                parameters = [self.bank_parameters(points[i], number) for i in group]
                for i, row in zip(group, self._simulate(run, parameters)):
                    if row is not None:
                        found[i, begin : begin + run.count] = run.residuals(row[None])[0]
            begin += run.count
        return found

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """Derivative of the residuals by the strength of terms, shape (tasks, residuals).

        Args:
            point: Where; the terms are absent there.
            tasks: Terms with the values of their parameters; the strength is the step of the difference.
        """
        found = np.full((len(tasks), len(self.layout.time)), np.inf)
        probes: dict[tuple[str, tuple[float, ...]], list[int]] = {}
        for i, (term, values) in enumerate(tasks):
            probes.setdefault((self.where(term)[0].identifier, values), []).append(i)
        begin = 0
        for number, run in enumerate(self.runs):
            parameters = self.bank_parameters(point, number)
            outputs = shared_outputs(self.bank, parameters, run.plan)
            own = slice(begin, begin + run.count)
            begin += run.count
            for values, every in ((key[1], members) for key, members in probes.items()):
                members = [i for i in every if tasks[i][0].recording in (None, number)]
                found[[i for i in every if i not in members], own] = 0.0
                if not members:
                    continue
                term = tasks[members[0]][0]
                shape = dict(zip((p.name for p in term.parameters[1:]), values[1:]))
                candidate, _ = self.where(term)
                probe = Probe(candidate, shape, [self.where(tasks[i][0])[1] for i in members], values[0])
                self.simulations += len(members)
                try:
                    slopes = flat_probe_sensitivities(
                        self.bank, parameters, run.inputs, run.times, probe, self._threads, run.plan, outputs
                    )
                except BankError:
                    continue
                found[members, own] = run.slopes(slopes)
        return found

    def _simulate(self, run: Run, parameters: Sequence[BankParameters]) -> list[Array | None]:
        """Outputs as the bank lays them out; None where a simulation failed."""
        self.simulations += len(parameters)
        try:
            _, out = self.bank.simulate_flat(parameters, run.inputs, run.times, self._threads)
        except BankError:
            if len(parameters) == 1:
                return [None]
            return [self._simulate(run, [p])[0] for p in parameters]
        return list(out)

    def predict(self, point: Point, run: int) -> list[Array]:
        """Simulated values of every channel of a recording at its samples, SI."""
        one = self.runs[run]
        row = self._simulate(one, [self.bank_parameters(point, run)])[0]
        values = np.full(one.count, np.inf) if row is None else row[one.pick]
        return np.split(values, np.cumsum([len(s.samples) for s in one.series])[:-1])

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        # Single precision: a fit corrects the direction, not the sum of squares, by it.
        jacobian: AnyArray = np.zeros((len(self._free), len(self.layout.time)), dtype=np.float32)
        begin = 0
        for number, run in enumerate(self.runs):
            parameters = self.bank_parameters(point, number)
            along, columns = [], []
            for i, free in enumerate(self._free):
                if free.recording in (None, number):
                    for direction, weight in directions(free, parameters):
                        along.append(direction)
                        columns.append((i, weight))
            self.simulations += len(along)
            own = slice(begin, begin + run.count)
            begin += run.count
            try:
                _, _, slopes = flat_sensitivities(
                    self.bank, parameters, run.inputs, run.times, along, self._threads, run.plan
                )
            except BankError:  # on the verge of what can be simulated: there is no way on from here
                continue
            into, factors = np.array([c[0] for c in columns]), np.array([c[1] for c in columns])
            jacobian[:, own] = run.slopes(slopes, len(self._free), into, factors)
        return jacobian.T


def _by_terms(points: Sequence[Point]) -> list[list[int]]:
    """Points that switch on the same candidates are simulated together."""
    groups: dict[frozenset[str], list[int]] = {}
    for i, point in enumerate(points):
        groups.setdefault(frozenset(t.identifier for t in point.terms), []).append(i)
    return list(groups.values())
