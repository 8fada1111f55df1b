"""Elements that a scenario states of its circuit and that are no constant resistance: laws that act in every run.

Each is the law of the catalogue by which such an element is found, under an identifier of its own: the search may find
the same law once more, at the same string or source.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from cosim.components import CircuitComponent, ContactElement, SourceResistanceElement
from cosim.unit.protocol import Array
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.registry import candidate

#: Before the identifier of a law of the catalogue: the same law, stated.
_PREFIX = "stated_"
#: Where a string or a source has no such element: an instant and a limit that say nothing beside a strength of 0.
_NOWHERE = {"instant": 0.0, "limit": 1e3}
#: Laws whose strengths add where a string has several such elements.
_ADDING = ("self_heating_lead", "unnamed_series_constant")

#: Kind of an element to its law, and to the values of the law's parameters, the strength first.
_LAWS: Mapping[str, tuple[str, Callable[[Any], dict[str, float]]]] = {
    "contact": ("loose_contact", lambda e: {"R_contact": e.resistance.to("ohm"), "instant": e.instant.to("s")}),
    "lead": ("self_heating_lead", lambda e: {"rise": e.rise.to("ohm/A^2")}),
    "drop": ("unnamed_series_constant", lambda e: {"a": e.voltage.to("V")}),
    "current_limit": ("supply_current_limit", lambda e: {"share": e.share, "limit": e.limit.to("A")}),
    "slow_source": ("unnamed_supply_delayed", lambda e: {"a": e.delay.to("s")}),
}


def is_constant(element: object, start: float) -> bool:
    """Whether an element is a resistance that is there from the begin of a run on [s]."""
    if isinstance(element, ContactElement):
        return element.instant is None or element.instant.to("s") <= start
    return isinstance(element, SourceResistanceElement)


def stated_terms(circuit: CircuitComponent, start: float) -> dict[str, dict[str, float | Array]]:
    """Laws that elements of a circuit state, with their values at every string or source.

    Args:
        circuit: The circuit.
        start: Begin of the run [s].

    Raises:
        ValueError: A string or source has two elements of a kind whose strengths do not add.
    """
    sizes = {"string": len(circuit.strings), "supply": 1 if circuit.supply == "common" else len(circuit.strings)}
    found: dict[str, dict[str, Array]] = {}
    for element in circuit.elements:
        if is_constant(element, start):
            continue
        law, values_of = _LAWS[element.kind]
        place = "string" if hasattr(element, "string") else "supply"
        at, values = getattr(element, place) - 1, values_of(element)
        strength = next(iter(values))
        empty = {name: np.full(sizes[place], _NOWHERE.get(name, 0.0)) for name in values}
        own = found.setdefault(_PREFIX + law, empty)
        if own[strength][at] != 0.0 and law not in _ADDING:
            raise ValueError(f"a network has no two elements of kind {element.kind} at {place} {at + 1}")
        for name, value in values.items():
            own[name][at] = own[name][at] + value if name == strength else value
    return {law: dict(values) for law, values in found.items()}


def stated_candidates(laws: Iterable[str]) -> list[CandidateTerm]:
    """The laws of `stated_terms`, to be compiled into a network, in order and each once."""
    return [replace(candidate(law.removeprefix(_PREFIX)), identifier=law) for law in sorted(set(laws))]
