"""Generic terms whose law is that of a named one: the same numbers, and never both in one search."""

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.bank.layout import COIL_FIELDS
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.simulator.bank_model import BankModel
from tests.diagnosis_bank.rigs import LOADED, NETWORK, STOP, full_bank, network_inputs
from tests.locate import rig

TIMES = np.linspace(0.0, STOP, 121)
TWICE = [t for t in catalogue() if t.same_as]
QUANTITIES = ("temperature", "current", "extension", "stiffness")
#: Strength of the generic term for one of the named term, where they count in other units.
FACTORS = {
    "backlash": 0.5, "draught": 30.0 * COIL_FIELDS["conductance"][0], "thermal_contraction": -30.0,
    "temperature_dependent_resistance": 30.0,
}  # fmt: skip

#: What shapes a law, in both: an instant [s], and a limit [A] below what the network draws.
SHAPES = {"instant": 0.4 * STOP, "limit": 1.0, "reach": 0.002}


@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in TWICE])
def test_a_generic_term_with_the_law_of_a_named_one_says_the_same(term):
    named = candidate(term.same_as)
    strength = named.amplitude.starts[min(1, len(named.amplitude.starts) - 1)]
    shape = {p.name: SHAPES[p.name] for p in named.parameters if p.name in SHAPES}
    plain = LOADED.with_base(use_regressed_cooling_rate=0.0)  # one conductance, on or off
    bank, inputs = full_bank(NETWORK), network_inputs()
    wanted = bank.simulate(
        plain.with_term(named.identifier, **{named.amplitude.name: strength}, **shape), inputs, TIMES
    )
    generic = FACTORS.get(named.identifier, 1.0) * strength
    found = bank.simulate(plain.with_term(term.identifier, a=generic, **shape), inputs, TIMES)
    without = bank.simulate(plain, inputs, TIMES)
    for quantity in QUANTITIES:  # rounding of formulas that are written in another way
        assert found[quantity] == pytest.approx(wanted[quantity], rel=1e-9), quantity
    assert any(np.abs(found[q] / wanted[q].max() - without[q] / wanted[q].max()).max() > 1e-4 for q in QUANTITIES)


def test_a_generic_term_is_tried_only_where_the_named_one_is_not_in_the_catalogue():
    assert len(TWICE) == 14
    assert all(candidate(t.same_as).is_named for t in TWICE)
    tried = {t.identifier for t in rig.perfect_model().terms()}
    assert tried.isdisjoint(t.identifier for t in TWICE)
    hidden = [t for t in catalogue() if t.identifier != "loose_contact"]
    scenario = load_scenario(rig.SCENARIO)
    assert "unnamed_series_step" in {t.identifier for t in BankModel(scenario, [rig.blank(0)], hidden).terms()}
