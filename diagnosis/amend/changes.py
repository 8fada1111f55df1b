"""What a fitted point changes in a scenario: factors of its parameters, terms, sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.scenario import Scenario
from diagnosis.amend.parts import Part, part_of
from diagnosis.bank.layout import QUANTITY_FIELDS, Array
from diagnosis.bank.parameters import BankParameters
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.search.problem import Point
from diagnosis.simulator.bank_model import BankModel
from diagnosis.simulator.translate import Translation, translate

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


@dataclass(frozen=True)
class Changes:
    """What a point changes.

    Args:
        translation: The scenario as a bank.
        factors: Base parameter of the bank to the factor that the fit found, a number or one per element.
        terms: Terms in the order of the catalogue.
        sensors: Base parameters of the sensors (how late the clock of every quantity is) with their values.
    """

    translation: Translation
    factors: Mapping[str, Array]
    terms: Sequence[FittedTerm]
    sensors: Mapping[str, Array]

    def of(self, part: Part) -> list[FittedTerm]:
        """The terms of a part."""
        return [t for t in self.terms if t.part is part]

    def value(self, field: str) -> Array:
        """Recalibrated value of a base parameter of the bank, SI."""
        nominal = np.asarray(self.translation.parameters.base[field], dtype=np.float64)
        return np.asarray(nominal * self.factors.get(field, np.ones(())))


def changes_of(scenario: Scenario, model: BankModel, point: Point) -> Changes:
    """What a fitted point changes in a scenario.

    What belongs to a day alone (its ambient, its first temperature, a fault with begin and end) is left as the scenario
    has it.

    Raises:
        CannotAmend: A parameter of the scenario was changed that no scenario can say.
    """
    lasting = np.array(
        [0.0 if " of recording " in p.name else z for p, z in zip(model.parameters, point.base)], dtype=np.float64
    )
    nominal = model.bank_parameters(Point(np.zeros(len(lasting))), 0)
    fitted = model.bank_parameters(Point(lasting, point.lasting.terms), 0)
    sensors = {name: np.asarray(fitted.base[name], dtype=np.float64) for name in QUANTITY_FIELDS if name in fitted.base}
    terms = fitted_terms(model.bank.terms, fitted)
    return Changes(translate(scenario), _factors(nominal, fitted), terms, sensors)


def _factors(nominal: BankParameters, fitted: BankParameters) -> dict[str, Array]:
    factors = {}
    for name, value in fitted.base.items():
        before, after = (np.asarray(v, dtype=np.float64) for v in (nominal.base.get(name, 0.0), value))
        if name in QUANTITY_FIELDS or np.array_equal(before, after):
            continue
        if np.any(before == 0.0):
            raise CannotAmend(f"{name} was 0 in the scenario and is not any more")
        ratio = np.asarray(after / before)
        factors[name] = ratio.reshape(-1)[0] * np.ones(()) if np.ptp(ratio) <= SAME else ratio
    return factors


def fitted_terms(terms: Sequence[CandidateTerm], parameters: BankParameters) -> list[FittedTerm]:
    """Terms that are switched on, with the values that the bank takes where none is given."""
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
