"""Probes of a candidate at all its places against one simulation for each place."""

import numpy as np
import pytest

from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import places
from diagnosis.models.coil_network.kernel.probes import Probe, probe_sensitivities
from tests.coil_network.rigs import LOADED, NETWORK, STOP, full_network, network_inputs

TIMES = np.arange(0.3, STOP, 1.3)
QUANTITIES = {"temperature": TIMES, "current": TIMES, "extension": TIMES, "supply_current": TIMES}
UNEQUAL = CoilNetworkParameters({"load": 0.981, "reference_resistance": np.linspace(2.0, 2.4, 12)})
#: One of every kind of law, and all that join coils.
SOME = (
    "second_mass",
    "latent_heat",
    "contact_resistance",
    "loose_contact",
    "supply_source_resistance",
    "neighbour_heat",
    "touching_coils",
    "shared_mass",
    "uneven_cooling",
    "phase_dependent_resistance",
    "fatigue",
    "viscous_damping",
    "creep",
    "sensor_lag",
    "sensor_gain",
    "sensor_bias",
    "wrong_identity",
    "unnamed_heat_delayed_phase",
    "unnamed_length_linear_rate",
    "unnamed_value_linear_amperes",
)


@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in catalogue() if t.identifier in SOME])
def test_a_probe_is_one_simulation_for_each_place_and_costs_fewer(term, monkeypatch):
    network = full_network(NETWORK)
    found = places(term, NETWORK, tuple(QUANTITIES))
    shape = {p.name: p.starts[-1] for p in term.parameters[1:] if not p.is_fixed}
    step = 0.02 * term.amplitude.starts[0] if term.identifier != "wrong_identity" else 1.0
    simulated = []
    run = type(network).run
    monkeypatch.setattr(type(network), "run", lambda *a, **k: simulated.append(len(a[3])) or run(*a, **k))
    base, slopes = probe_sensitivities(network, UNEQUAL, network_inputs(), QUANTITIES, Probe(term, shape, found, step))
    count = simulated[0]
    for n, place in enumerate(found):
        on = UNEQUAL.with_term(term.identifier, **place.values(term, {term.amplitude.name: step, **shape}))
        alone = network.simulate(on, network_inputs(), QUANTITIES)
        for quantity in QUANTITIES:
            exact = (alone[quantity] - base[quantity]) / step
            scale = max(np.abs(exact).max(), 1e-12)
            # rounding of the difference; a clock or lag of 0 in the base joins currents a hair otherwise
            assert np.abs(slopes[quantity][n] - exact).max() < 1e-6 * scale + 1e-11 / abs(step), (place.label, quantity)
    alone = sum(np.count_nonzero(place.mask) == 1 and place.kind != "pair" for place in found)
    if alone > 8:  # places that touch each other cannot share one, and coils that touch join the whole
        assert count < 0.7 * len(found)


def test_a_probe_leaves_the_candidate_where_it_is_already_on():
    network = full_network(NETWORK)
    term = next(t for t in catalogue() if t.identifier == "second_mass")
    found = [p for p in places(term, NETWORK) if p.kind == "coil"][5:7]
    on = LOADED.with_term("second_mass", g=np.eye(12)[0] * 4e-3, C2=0.3)
    base, _ = probe_sensitivities(network, on, network_inputs(), QUANTITIES, Probe(term, {"C2": 0.02}, found, 1e-4))
    alone = network.simulate(on, network_inputs(), QUANTITIES)
    assert np.allclose(base["temperature"], alone["temperature"], rtol=1e-14)
