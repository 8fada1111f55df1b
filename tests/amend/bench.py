"""A 2 x 2 network, the network that simulates it, and terms at typical strengths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.scenario import Scenario, load_scenario
from diagnosis.amend.changes import Changes, fitted_terms
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.layout import Array, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.translate import Translation, translate

#: Within a step and, elsewhere, on the end of one: both must be right.
INSTANT = 4.02
#: Variable of the results that holds a quantity of the network.
VARIABLES = {
    "temperature": "actuator.temperature",
    "stiffness": "actuator.stiffness",
    "extension": "load.extension",
    "length": "load.length",
    "current": "circuit.string_current",
    "supply_current": "circuit.supply_current",
    "power": "circuit.power",
}


def scenario() -> Scenario:
    """The scenario of this folder."""
    return load_scenario(Path(__file__).with_name("two_by_two.yaml"))


def model_terms() -> list[CandidateTerm]:
    """Every candidate that is no sensor's."""
    return [t for t in catalogue() if t.axis != "channel"]


def strengths(term: CandidateTerm, layout: CoilNetworkLayout) -> dict[str, Array]:
    """Second start value of each parameter; a local term acts at every other element, a pattern has both signs."""
    values = {p.name: np.full(layout.size(term.axis), p.starts[min(1, len(p.starts) - 1)]) for p in term.parameters}
    if "instant" in values:
        values["instant"] = np.full_like(values["instant"], INSTANT)
    amplitude = values[term.amplitude.name]
    if {"coil", "string", "pair"} & set(term.places):
        amplitude[1::2] = 0.0
    elif any(place.endswith("gradient") for place in term.places):
        amplitude *= np.linspace(1.0, -1.0, amplitude.size)
    return values


def parameters(translation: Translation, terms: Sequence[CandidateTerm]) -> CoilNetworkParameters:
    """The scenario's values with terms switched on."""
    return CoilNetworkParameters(
        translation.parameters.base, {t.identifier: strengths(t, translation.layout) for t in terms}
    )


def changes(given: Scenario, terms: Sequence[CandidateTerm]) -> Changes:
    """Terms as a fit would hand them over."""
    translation = translate(given)
    return Changes(translation, {}, fitted_terms(terms, parameters(translation, terms)), {})


@cache
def _network(layout: CoilNetworkLayout) -> CoilNetwork:
    """One network with all terms, compiled once."""
    return CoilNetwork(layout, model_terms(), is_midpoint=False)


def by_network(given: Scenario, terms: Sequence[CandidateTerm]) -> dict[str, Array]:
    """What the network gives at the ends of macro-steps, in steps of the co-simulation: everything at its begin."""
    translation = translate(given)
    ends = np.round(np.arange(0.0, 15.0001, 0.05), 9)
    return _network(translation.layout).simulate(parameters(translation, terms), translation.drive.on_grid(ends), ends)


def difference(results: xr.Dataset, expected: Mapping[str, Array]) -> tuple[float, str]:
    """Largest difference of any quantity after the start, relative to its largest value, and that quantity."""
    worst = 0.0, ""
    for quantity, variable in VARIABLES.items():
        values = results[variable].values.reshape(len(results["time"]), -1)[1:]
        own = expected[quantity][1:]
        worst = max(worst, (float(np.abs(values - own).max() / np.abs(own).max()), quantity))
    return worst
