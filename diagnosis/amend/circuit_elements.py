"""Terms of the circuit as elements of a component of kind ngspice."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from diagnosis.amend.changes import CannotAmend, FittedTerm

Values = Mapping[str, float]


def quantity(value: float, unit: str) -> str:
    """A number as a scenario says it; ten digits."""
    return f"{value:.10g} {unit}"


def _contact(n: int, v: Values) -> dict[str, Any]:
    return {"kind": "contact", "string": n, "resistance": quantity(v["R_contact"], "ohm")}


def _loose(n: int, v: Values) -> dict[str, Any]:
    """From an instant on; what was there before the run begins has none."""
    since = {"instant": quantity(v["instant"], "s")} if np.isfinite(v["instant"]) else {}
    return {**_contact(n, v), **since}


def _lead(n: int, v: Values) -> dict[str, Any]:
    return {"kind": "lead", "string": n, "rise": quantity(v["rise"], "ohm/A^2")}


def _series_drop(n: int, v: Values) -> dict[str, Any]:
    return {"kind": "drop", "string": n, "voltage": quantity(v["a"], "V")}


def _source(n: int, v: Values) -> dict[str, Any]:
    return {"kind": "source_resistance", "supply": n, "resistance": quantity(v["R_source"], "ohm")}


def _limit(n: int, v: Values) -> dict[str, Any]:
    return {"kind": "current_limit", "supply": n, "limit": quantity(v["limit"], "A"), "share": float(v["share"])}


#: Effect to its element at a string or source (from 1).
_ELEMENTS: Mapping[str, Callable[[int, Values], dict[str, Any]]] = {
    "contact_resistance": _contact,
    "loose_contact": _loose,
    "self_heating_lead": _lead,
    "supply_source_resistance": _source,
    "supply_current_limit": _limit,
    "unnamed_series_constant": _series_drop,
    "unnamed_series_linear": lambda n, v: _contact(n, {"R_contact": v["a"]}),
    "unnamed_series_step": lambda n, v: _loose(n, {"R_contact": v["a"], "instant": v["instant"]}),
    "unnamed_series_cube": lambda n, v: _lead(n, {"rise": v["a"]}),
    "unnamed_supply_linear": lambda n, v: _source(n, {"R_source": v["a"]}),
    "unnamed_supply_delayed": lambda n, v: {
        "kind": "slow_source",
        "supply": n,
        "delay": quantity(v["a"], "s"),
    },
    "unnamed_supply_hinge": lambda n, v: _limit(n, {"limit": v["limit"], "share": v["a"]}),
}


def circuit_elements(terms: Sequence[FittedTerm], start: float = 0.0) -> list[dict[str, Any]]:
    """Elements of `components.<circuit>.elements`.

    Args:
        terms: Of the circuit.
        start: First instant of the run [s]: what has set in before it is there from the start.

    Raises:
        CannotAmend: A term of the circuit has no element.
    """
    found = []
    for fitted in terms:
        make = _ELEMENTS.get(fitted.term.identifier)
        if make is None:
            raise CannotAmend(f"the netlist has no element for {fitted.term.identifier} ({fitted.term.law})")
        amplitude = fitted.values[fitted.term.amplitude.name]
        for n, strength in enumerate(amplitude):
            if strength != 0.0:
                values = {name: float(v[n]) for name, v in fitted.values.items()}
                if values.get("instant", start) < start:
                    values["instant"] = -np.inf
                found.append(make(n + 1, values))
    return found
