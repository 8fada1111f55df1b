"""Generic terms whose law is that of a named one: the same numbers, and never both in one search."""

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS
from diagnosis.models.coil_network.model import CoilNetworkModel
from tests.coil_network.rigs import LOADED, NETWORK, STOP, full_network, network_inputs
from tests.locate import rig

TIMES = np.linspace(0.0, STOP, 121)
TWICE = [t for t in catalogue() if t.same_as]
QUANTITIES = ("temperature", "current", "extension", "stiffness")
#: Strength of the generic term for one of the named term, where they count in other units.
FACTORS = {
    "backlash": 0.5,
    "draught": 30.0 * COIL_FIELDS["conductance"][0],
    "thermal_contraction": -30.0,
    "temperature_dependent_resistance": 30.0,
}

#: What shapes a law, in both: an instant [s], and a limit [A] below what the network draws.
SHAPES = {"instant": 0.4 * STOP, "limit": 1.0, "reach": 0.002}


@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in TWICE])
def test_a_generic_term_with_the_law_of_a_named_one_says_the_same(term):
    named = candidate(term.same_as)
    strength = named.amplitude.starts[min(1, len(named.amplitude.starts) - 1)]
    shape = {p.name: SHAPES[p.name] for p in named.parameters if p.name in SHAPES}
    plain = LOADED.with_base(use_regressed_cooling_rate=0.0)  # one conductance, on or off
    network, inputs = full_network(NETWORK), network_inputs()
    wanted = network.simulate(
        plain.with_term(named.identifier, **{named.amplitude.name: strength}, **shape), inputs, TIMES
    )
    generic = FACTORS.get(named.identifier, 1.0) * strength
    found = network.simulate(plain.with_term(term.identifier, a=generic, **shape), inputs, TIMES)
    without = network.simulate(plain, inputs, TIMES)
    for quantity in QUANTITIES:  # rounding of formulas that are written in another way
        assert found[quantity] == pytest.approx(wanted[quantity], rel=1e-9), quantity
    assert any(np.abs(found[q] / wanted[q].max() - without[q] / wanted[q].max()).max() > 1e-4 for q in QUANTITIES)


def as_second_mass(name, conductance):
    """A cascade of two masses as a second mass beside another h A: (h A, g, C2), all with the same poles and zero."""
    if name == "lossy_second_mass":
        g, capacity, loss = 0.006, 0.1, 0.01
        coupled = g**2 / (g + loss)
        return {"g": g, "C2": capacity, "loss": loss}, (
            conductance + g - coupled,
            coupled,
            capacity * coupled / (g + loss),
        )
    share, g, capacity = 0.7, 0.03, 0.1
    coupled = share * g**2 / (g + conductance)
    return {"share": share, "g": g, "C2": capacity}, (
        (1.0 - share) * conductance + share * g - coupled,
        coupled,
        capacity * coupled / (g + conductance),
    )


@pytest.mark.parametrize("name", ["lossy_second_mass", "sheath"])
def test_two_masses_in_any_cascade_are_a_second_mass_beside_another_conductance(name):
    """So the three are one class, and are hidden together in the proving ground (`evaluation.proving.cases.EQUAL`)."""
    conductance = COIL_FIELDS["conductance"][0]
    plain = LOADED.with_base(use_regressed_cooling_rate=0.0)
    values, (other, g, capacity) = as_second_mass(name, conductance)
    network, inputs = full_network(NETWORK), network_inputs(step=0.02)
    wanted = network.simulate(plain.with_term(name, **values), inputs, TIMES)["temperature"]
    found = network.simulate(
        plain.with_base(conductance=other).with_term("second_mass", g=g, C2=capacity), inputs, TIMES
    )["temperature"]
    without = network.simulate(plain.with_base(conductance=other), inputs, TIMES)["temperature"]
    assert np.abs(found - without).max() > 2.0
    assert np.abs(found - wanted).max() < 0.02  # [K]; of a step of 20 ms


def test_play_holds_what_a_contraction_has_made_of_the_extension():
    """Were the contraction added to what the play holds, it would be added in every step anew."""
    gap, contraction = 7e-4, 3e-5
    network, inputs = full_network(NETWORK), network_inputs()
    shrunk = LOADED.with_term("thermal_contraction", contraction=contraction)
    free = network.simulate(shrunk, inputs, TIMES)["extension"]
    held = network.simulate(shrunk.with_term("backlash", gap=gap), inputs, TIMES)["extension"]
    assert np.abs(held - free).max() < 0.5 * gap + 1e-9
    assert np.abs(held - free).max() > 0.4 * gap


def test_a_generic_term_is_tried_only_where_the_named_one_is_not_in_the_catalogue():
    assert len(TWICE) == 14
    assert all(candidate(t.same_as).is_named for t in TWICE)
    tried = {t.identifier for t in rig.perfect_model().terms()}
    assert tried.isdisjoint(t.identifier for t in TWICE)
    hidden = [t for t in catalogue() if t.identifier != "loose_contact"]
    scenario = load_scenario(rig.SCENARIO)
    assert "unnamed_series_step" in {t.identifier for t in CoilNetworkModel(scenario, [rig.blank(0)], hidden).terms()}
