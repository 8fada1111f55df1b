"""Coil bank and recordings as the model that the search varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.errors import InputError
from cosim.scenario import Scenario
from cosim.unit import AnyArray, Array
from diagnosis.bank.bank import Bank, BankError
from diagnosis.bank.inputs import BankInputs
from diagnosis.bank.layout import AXIS_OF_FIELD, QUANTITIES, BankLayout
from diagnosis.bank.parameters import BankParameters
from diagnosis.bank.places import Place, coil_label, merge, places
from diagnosis.bank.probes import Probe, probe_sensitivities
from diagnosis.bank.sensitivities import Direction, sensitivities
from diagnosis.bank.steps import choose_step
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.problem import Layout, Parameter, Point, Term, TermParameter
from diagnosis.simulator.priors import DAILY, PRIORS, Prior, matters
from diagnosis.simulator.translate import Translation, translate

#: Unit (electrical, ...) whose output a quantity is.
UNIT_OF_QUANTITY = {
    "temperature": "thermal", "current": "electrical", "supply_current": "electrical", "resistance": "electrical",
    "power": "electrical", "extension": "mechanical", "length": "mechanical", "stiffness": "stiffness",
}  # fmt: skip
#: Instants at which an effect that begins some time is tried first.
INSTANTS = 9


@dataclass(frozen=True)
class _Free:
    """A parameter of the search in terms of the bank: values change by a factor or a summand over a mask."""

    field: str
    mask: Array
    recording: int | None
    parameter: Parameter


@dataclass(frozen=True)
class _Series:
    """One channel of one recording, as the bank samples it."""

    channel: Channel
    quantity: str
    element: int
    samples: AnyArray
    used: AnyArray


@dataclass(frozen=True)
class _Run:
    """One recording, ready to be simulated."""

    translation: Translation
    inputs: BankInputs
    times: Mapping[str, Array]
    series: tuple[_Series, ...]


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
        self, scenario: Scenario, recordings: Sequence[Recording], catalogue: Sequence[CandidateTerm], threads: int = 2
    ) -> None:
        self._threads = threads
        self.simulations = 0
        translations = [translate(scenario_of(scenario, r)) for r in recordings]
        self.bank = Bank(translations[0].layout, catalogue)
        self._candidates = {t.identifier: t for t in catalogue}
        self.runs = [self._run(t, r) for t, r in zip(translations, recordings)]
        self.measured = sorted({s.quantity for run in self.runs for s in run.series})
        self._free = list(self._free_parameters())
        self.parameters: Sequence[Parameter] = [f.parameter for f in self._free]
        self._places: dict[Term, tuple[CandidateTerm, Place]] = {}
        self.layout = self._layout(recordings)

    @property
    def coils(self) -> BankLayout:
        """Coils and strings."""
        return self.bank.layout

    def _run(self, translation: Translation, recording: Recording) -> _Run:
        entries = [(c, *_bank_quantity(c.target, translation.layout, recording)) for c in recording.channels.values()]
        times: dict[str, Array] = {}
        for channel, quantity, _ in entries:
            inside = channel.times[channel.times >= translation.start]
            times[quantity] = np.union1d(times.get(quantity, np.zeros(0)), inside)
        deviations = {q: min(c.deviation for c, quantity, _ in entries if quantity == q) for q in times}
        choice = choose_step(self.bank, translation.parameters, translation.drive, translation.start, times, deviations)
        switches = np.array(translation.drive.switches())
        series = []
        for channel, quantity, element in entries:
            known = channel.times >= translation.start
            used = known & ~channel.is_clipped
            if switches.size and len(switches) < 0.2 * len(channel.times):  # a course recorded as an input always jumps
                nearest = np.min(np.abs(channel.times[:, None] - switches[None, :]), axis=1)
                used &= nearest > recording.switch_margin
            samples = np.searchsorted(times[quantity], channel.times[known])
            series.append(_Series(channel, quantity, element, samples, used[known]))
        return _Run(translation, choice.inputs, times, tuple(series))

    def _layout(self, recordings: Sequence[Recording]) -> Layout:
        channel, time = [], []
        names: list[str] = []
        units: list[str] = []
        for run, recording in zip(self.runs, recordings):
            for series in run.series:
                inside = series.channel.times[series.channel.times >= run.translation.start]
                channel.append(np.full(len(inside), len(names)))
                time.append(inside)
                names.append(
                    series.channel.name if len(recordings) == 1 else f"{series.channel.name} ({recording.title})"
                )
                units.append(UNIT_OF_QUANTITY[series.quantity])
        return Layout(np.concatenate(channel), np.concatenate(time), tuple(names), tuple(units))

    def _free_parameters(self) -> list[_Free]:
        layout, nominal = self.coils, self.runs[0].translation.parameters.base
        measured = set(self.measured)
        found = []
        for name, prior in PRIORS.items():
            value = float(np.mean(nominal[name])) if name in nominal else 0.0
            if not matters(prior, measured) or (prior.is_relative and value == 0.0):
                continue
            if name == "reference_resistance" and not layout.strings:
                continue  # power is given: the resistance does nothing
            size = layout.size(AXIS_OF_FIELD.get(name, "coil"))
            if prior.shared:
                found.append(_free(name, name, np.ones(size), None, value, prior.shared, prior))
            if prior.scatter:
                for i in range(size):
                    label = f"{coil_label(layout, i)}.{name}"
                    found.append(_free(label, name, np.eye(size)[i], None, value, prior.scatter, prior))
        for number in range(len(self.runs)):
            for name, prior in DAILY.items():
                label = f"{name} of recording {number + 1}"
                found.append(_free(label, name, np.ones(layout.coils), number, 0.0, prior.shared, prior))
        return found

    def terms(self) -> list[Term]:
        """Every candidate at every place, as the search sees them."""
        for candidate in self._candidates.values():
            for place in places(candidate, self.coils, self.measured):
                self._places.setdefault(self._term(candidate, place), (candidate, place))
        return list(self._places)

    def where(self, term: Term) -> tuple[CandidateTerm, Place]:
        """Candidate and place of a term."""
        return self._places[term]

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        candidate, place = self._places[term]
        if place.kind not in ("coil", "channel", "swap", "string"):
            return None
        elements = set(np.flatnonzero(place.mask).tolist())
        found, number = [], 0
        for run in self.runs:
            for s in run.series:
                axis = QUANTITIES[s.quantity].axis
                if candidate.axis == "channel":
                    is_touched = self.coils.channel(s.quantity) + s.element in elements
                elif candidate.axis == "coil":
                    is_touched = axis == "coil" and s.element in elements
                else:
                    is_touched = candidate.axis == "string" and axis == "string" and s.element in elements
                if is_touched:
                    found.append(number)
                number += 1
        return (found, place.kind == "swap") if found else None

    def _term(self, candidate: CandidateTerm, place: Place) -> Term:
        end = max(float(t[-1]) for run in self.runs for t in run.times.values())
        begin = min(run.translation.start for run in self.runs)
        free = []
        for p in candidate.parameters:
            if p.is_fixed:
                continue
            lower, upper, starts = p.lower, p.upper, p.starts
            if p.is_instant:
                lower, upper = begin, end
                starts = tuple(float(v) for v in np.linspace(begin, end, INSTANTS + 2)[1:-1])
            free.append(TermParameter(p.name, p.unit, lower, upper, starts))
        return Term(candidate.identifier, place.label, candidate.unit, tuple(free), candidate.is_named, candidate.law)

    def bank_parameters(self, point: Point, run: int) -> BankParameters:
        """Values of the bank's parameters at a point, for one recording."""
        base = dict(self.runs[run].translation.parameters.base)
        for free, z in zip(self._free, point.base):
            if free.recording in (None, run) and z != 0.0:
                _vary(base, free, float(z))
        terms: dict[str, Mapping[str, float | Array]] = {}
        for term, values in point.terms.items():
            candidate, place = self._places[term]
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
            count = sum(len(s.samples) for s in run.series)
            for group in _by_terms(points):
                parameters = [self.bank_parameters(points[i], number) for i in group]
                rows = self._simulate(run, parameters)
                for i, row in zip(group, rows):
                    if row is not None:
                        found[i, begin : begin + count] = self._compare(run, row)
            begin += count
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
            probes.setdefault((term.identifier, values), []).append(i)
        begin = 0
        for number, run in enumerate(self.runs):
            parameters = self.bank_parameters(point, number)
            end = begin + sum(len(s.samples) for s in run.series)
            for (identifier, values), members in probes.items():
                term = tasks[members[0]][0]
                shape = dict(zip((p.name for p in term.parameters[1:]), values[1:]))
                at = [self._places[tasks[i][0]][1] for i in members]
                probe = Probe(self._candidates[identifier], shape, at, values[0])
                self.simulations += len(members)
                try:
                    _, slopes = probe_sensitivities(self.bank, parameters, run.inputs, run.times, probe, self._threads)
                except BankError:
                    continue
                found[members, begin:end] = self._scaled(run, slopes)
            begin = end
        return found

    @staticmethod
    def _scaled(run: _Run, slopes: Mapping[str, Array]) -> Array:
        """Derivatives of outputs to those of the residuals, shape (rows, residuals of the run)."""
        parts = []
        for s in run.series:
            part = -slopes[s.quantity][:, s.samples, s.element] / _deviation(s.channel)
            parts.append(np.where(s.used, part, 0.0))
        return np.concatenate(parts, axis=1)

    def _simulate(self, run: _Run, parameters: Sequence[BankParameters]) -> list[dict[str, Array] | None]:
        self.simulations += len(parameters)
        try:
            batch = self.bank.simulate_batch(parameters, run.inputs, run.times, self._threads)
        except BankError:
            if len(parameters) == 1:
                return [None]
            return [self._simulate(run, [p])[0] for p in parameters]
        return [{q: values[i] for q, values in batch.items()} for i in range(len(parameters))]

    def _compare(self, run: _Run, outputs: Mapping[str, Array]) -> Array:
        parts = []
        for s in run.series:
            measured = s.channel.values[-len(s.samples) :]
            difference = (measured - outputs[s.quantity][s.samples, s.element]) / _deviation(s.channel)
            parts.append(np.where(s.used, difference, 0.0))
        return np.concatenate(parts)

    def predict(self, point: Point, run: int) -> list[Array]:
        """Simulated values of every channel of a recording at its samples, SI."""
        rows = self._simulate(self.runs[run], [self.bank_parameters(point, run)])[0]
        if rows is None:
            return [np.full(len(s.samples), np.inf) for s in self.runs[run].series]
        return [rows[s.quantity][s.samples, s.element] for s in self.runs[run].series]

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        jacobian = np.zeros((len(self.layout.time), len(self._free)))
        begin = 0
        for number, run in enumerate(self.runs):
            parameters = self.bank_parameters(point, number)
            chosen = [i for i, f in enumerate(self._free) if f.recording in (None, number)]
            directions, columns = [], []
            for i in chosen:
                for direction, weight in _directions(self._free[i], parameters):
                    directions.append(direction)
                    columns.append((i, weight))
            _, slopes = sensitivities(self.bank, parameters, run.inputs, run.times, directions, self._threads)
            for s in run.series:
                rows = slice(begin, begin + len(s.samples))
                scaled = -slopes[s.quantity][:, s.samples, s.element] / _deviation(s.channel)
                scaled = np.where(s.used, scaled, 0.0)
                for (i, weight), column in zip(columns, scaled):
                    jacobian[rows, i] += weight * column
                begin += len(s.samples)
        return jacobian


def _deviation(channel: Channel) -> float:
    """Noise and rounding together."""
    return float(np.hypot(channel.deviation, channel.quantum / np.sqrt(12.0) if channel.is_deviation_given else 0.0))


def _by_terms(points: Sequence[Point]) -> list[list[int]]:
    """Points that switch on the same candidates are simulated together."""
    groups: dict[frozenset[str], list[int]] = {}
    for i, point in enumerate(points):
        groups.setdefault(frozenset(t.identifier for t in point.terms), []).append(i)
    return list(groups.values())


def _free(
    name: str, field: str, mask: Array, recording: int | None, nominal: float, deviation: float, prior: Prior
) -> _Free:  # fmt: skip
    unit = "K" if not prior.is_relative else "1"
    return _Free(field, mask, recording, Parameter(name, unit, nominal, deviation, prior.is_relative))


def _vary(base: dict[str, float | Array], free: _Free, z: float) -> None:
    """Change base parameters as a free parameter at z says."""
    amount = free.parameter.deviation * z
    if free.field in ("heating_shift", "cooling_shift"):
        branch = free.field.removesuffix("_shift")
        # b exp(-c (T - shift)) = b exp(c shift) exp(-c T)
        base[f"{branch}_b"] = np.asarray(base[f"{branch}_b"]) * np.exp(np.asarray(base[f"{branch}_c"]) * amount)
    elif free.parameter.is_relative:
        base[free.field] = np.asarray(base[free.field]) * np.exp(amount * free.mask)
    else:
        base[free.field] = np.asarray(base.get(free.field, 0.0)) + amount * free.mask


def _directions(free: _Free, parameters: BankParameters) -> list[tuple[Direction, float]]:
    """Directions of the bank whose weighted sum is the derivative by z."""
    deviation = free.parameter.deviation
    base = parameters.base
    if free.field in ("heating_shift", "cooling_shift"):
        branch = free.field.removesuffix("_shift")
        slope = np.asarray(base[f"{branch}_b"]) * np.asarray(base[f"{branch}_c"]) * free.mask
        return [(Direction(f"{branch}_b", slope, 1e-3), deviation)]
    if free.parameter.is_relative:
        return [(Direction(free.field, np.asarray(base[free.field]) * free.mask, 1e-4), deviation)]
    return [(Direction(free.field, free.mask, 1e-3), deviation)]


def _bank_quantity(target: Target, layout: BankLayout, recording: Recording) -> tuple[str, int]:
    """Quantity of the bank and number of its element (from 0) for a channel."""
    source = recording.path / "recording.yaml"
    if target.kind == "supply" and target.quantity == "current" and layout.strings:
        return "supply_current", 0
    if target.kind == "string" and target.quantity == "current" and target.element[0] <= len(layout.strings):
        return "current", target.element[0] - 1
    if target.kind == "coil" and target.quantity in QUANTITIES and QUANTITIES[target.quantity].axis == "coil":
        coil = _coil(target.element, layout)
        if coil is not None:
            return target.quantity, coil
    name = f"{target.kind}{list(target.element) or ''}.{target.quantity}"
    raise InputError(source, f"channels.{name}", "the scenario has no such quantity",
                     f"it has {layout.coils} coils in {len(layout.strings)} strings")  # fmt: skip


def _coil(element: tuple[int, ...], layout: BankLayout) -> int | None:
    if len(element) == 1:
        return element[0] - 1 if element[0] <= layout.coils else None
    string, place = element
    if string > len(layout.strings) or place > layout.strings[string - 1]:
        return None
    return layout.first[string - 1] + place - 1
