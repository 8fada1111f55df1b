"""What a fitted point changes in a scenario: factors of its parameters, terms, sensors."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from cosim.scenario import Scenario
from diagnosis.amend.parts import Part, part_of
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.layout import QUANTITY_FIELDS, Array, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.translate import Translation, translate
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Point

#: Fields of the network that are moved by an amount and not by a factor: the room, and the start.
OFFSETS = ("ambient_offset", "initial_temperature")
#: Values this close to each other are one value: what is written has ten digits.
SAME = 1e-10


class CannotAmend(Exception):
    """A model cannot be written as a scenario; the text says which term or parameter, and why."""


@dataclass(frozen=True)
class FittedTerm:
    """A term with the values of its parameters.

    Args:
        term: From the catalogue.
        values: Parameter to its values over the coils, strings, sources or channels.
    """

    term: CandidateTerm
    values: Mapping[str, Array]

    @property
    def part(self) -> Part:
        """Where it acts."""
        return part_of(self.term)

    def contacts(self, layout: CoilNetworkLayout) -> dict[tuple[int, int], int]:
        """Pairs of coils of a term that acts between them, where its amplitude is not 0, to their numbers."""
        if self.term.axis != "pair":
            return {}
        amplitude = self.values[self.term.amplitude.name]
        return {layout.contacts[n]: n for n in np.flatnonzero(amplitude).tolist()}


@dataclass(frozen=True)
class Changes:
    """What a point changes.

    Args:
        translation: The scenario as a network.
        factors: Base parameter of the network to the factor that the fit found, a number or one per element.
        terms: Terms in the order of the catalogue.
        sensors: Base parameters of the sensors (how late the clock of every quantity is) with their values.
        offsets: Those of `OFFSETS` that all recordings share, and by how much they are moved [K].
        cycles_before: Full cycles of the rig before a run of the scenario.
        terms_in: From a recording to the terms as they are in it, in the order of `terms`; None: as in `terms`.
    """

    translation: Translation
    factors: Mapping[str, Array]
    terms: Sequence[FittedTerm]
    sensors: Mapping[str, Array]
    offsets: Mapping[str, float] = field(default_factory=dict)
    cycles_before: float = 0.0
    terms_in: Callable[[Recording], Sequence[FittedTerm]] | None = None

    def of(self, part: Part) -> list[FittedTerm]:
        """The terms of a part."""
        return [t for t in self.terms if t.part is part]

    @property
    def contacts(self) -> list[tuple[int, int]]:
        """Pairs of coils that touch."""
        return sorted({pair for t in self.terms for pair in t.contacts(self.translation.layout)})

    def value(self, field: str) -> Array:
        """Recalibrated value of a base parameter of the network, SI."""
        nominal = np.asarray(self.translation.parameters.base[field], dtype=np.float64)
        return np.asarray(nominal * self.factors.get(field, np.ones(())))


def changes_of(scenario: Scenario, model: CoilNetworkModel, point: Point) -> Changes:
    """What a fitted point changes in a scenario.

    The scenario becomes the rig after the last recording: what has set in is there from the start, and what every day
    has of its ambient and its first temperature is in. What belongs to a day alone is left as the scenario has it (also
    a fault with begin and end), or stands there with the strength 0 (its draught); `Changes.terms_in` knows it.

    Raises:
        CannotAmend: A parameter of the scenario was changed that no scenario can say.
    """
    lasting = np.array([z if p.own is None else 0.0 for p, z in zip(model.parameters, point.base)], dtype=np.float64)
    nominal = model.network_parameters(Point(np.zeros(len(lasting))), 0)
    fitted = model.network_parameters(Point(lasting), 0)
    sensors = {name: np.asarray(fitted.base[name], dtype=np.float64) for name in QUANTITY_FIELDS if name in fitted.base}
    known, point = model.network.terms, point.lasting
    every = known_terms(known, [model.terms_at(point, s) for s in (*model.seats, model.timeline.afterwards)])

    def terms_in(recording: Recording) -> list[FittedTerm]:
        span = translate(scenario_of(scenario, recording)).start, recording.end
        return as_in(every, known, model.terms_at(point, model.timeline.seat_of(recording, span)))

    afterwards = model.timeline.afterwards
    return Changes(
        translate(scenario),
        _factors(nominal, fitted),
        as_in(every, known, model.terms_at(point, afterwards)),
        sensors,
        _offsets(nominal, fitted),
        afterwards.cycles_before,
        terms_in,
    )


def _offsets(nominal: CoilNetworkParameters, fitted: CoilNetworkParameters) -> dict[str, float]:
    """Shared by all coils: `diagnosis.models.coil_network.free`."""
    found = {}
    for name in OFFSETS:
        amount = np.asarray(fitted.base.get(name, 0.0)) - np.asarray(nominal.base.get(name, 0.0))
        if np.any(amount):
            found[name] = float(np.mean(amount))
    return found


def known_terms(
    catalogue: Sequence[CandidateTerm], seen: Sequence[Mapping[str, Mapping[str, float | Array]]]
) -> list[FittedTerm]:
    """Terms that are there at some time, with the values that they have first.

    Args:
        catalogue: All terms.
        seen: Terms as the network takes them, at several times.
    """
    found: dict[str, FittedTerm] = {}
    for terms in seen:
        for fitted in fitted_terms(catalogue, CoilNetworkParameters({}, terms)):
            found.setdefault(fitted.term.identifier, fitted)
    return [found[t.identifier] for t in catalogue if t.identifier in found]


def as_in(
    every: Sequence[FittedTerm], catalogue: Sequence[CandidateTerm], there: Mapping[str, Mapping[str, float | Array]]
) -> list[FittedTerm]:
    """All of the terms, those that are there with their values, the others with the strength 0."""
    known = {f.term.identifier: f for f in fitted_terms(catalogue, CoilNetworkParameters({}, there))}
    found = []
    for one in every:
        name = one.term.amplitude.name
        off = FittedTerm(one.term, {**one.values, name: np.zeros_like(one.values[name])})
        found.append(known.get(one.term.identifier, off))
    return found


def _factors(nominal: CoilNetworkParameters, fitted: CoilNetworkParameters) -> dict[str, Array]:
    factors = {}
    for name, value in fitted.base.items():
        before, after = (np.asarray(v, dtype=np.float64) for v in (nominal.base.get(name, 0.0), value))
        if name in (*QUANTITY_FIELDS, *OFFSETS) or np.array_equal(before, after):
            continue
        if np.any(before == 0.0):
            raise CannotAmend(f"{name} was 0 in the scenario and is not any more")
        ratio = np.asarray(after / before)
        factors[name] = ratio.reshape(-1)[0] * np.ones(()) if np.ptp(ratio) <= SAME else ratio
    return factors


def fitted_terms(terms: Sequence[CandidateTerm], parameters: CoilNetworkParameters) -> list[FittedTerm]:
    """Terms that are switched on, with the values that the network takes where none is given."""
    found = []
    for term in terms:
        given = parameters.terms.get(term.identifier)
        if given is None or not np.any(np.asarray(given.get(term.amplitude.name, 0.0))):
            continue
        size = np.asarray(given[term.amplitude.name]).size
        defaults = {p.name: 0.0 if p.is_amplitude else p.starts[0] for p in term.parameters}
        values = {
            p.name: np.broadcast_to(np.asarray(given.get(p.name, defaults[p.name]), dtype=np.float64), (size,))
            for p in term.parameters
        }
        found.append(FittedTerm(term, values))
    return found
