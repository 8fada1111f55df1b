"""Derivatives against Richardson's extrapolation; grouped simulations against single ones."""

import numpy as np
import pytest

from diagnosis.candidates.registry import candidate
from diagnosis.models.coil_network.kernel.independence import Independence
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.sensitivities import Direction, sensitivities
from tests.coil_network.rigs import LOADED, NETWORK, STOP, full_network, heater, network_inputs

TIMES = np.arange(0.3, STOP, 0.7)
QUANTITIES = {
    "temperature": TIMES,
    "current": TIMES,
    "extension": TIMES,
    "supply_current": np.arange(0.0, STOP, 1.1),
}
WARM = LOADED.with_base(resistance_temperature_coefficient=2e-3)
EYE = np.eye(12)


def logarithmic(name, mask, step=1e-4):
    return Direction(name, COIL_FIELDS[name][0] * mask, step)


def smooth(network, parameters, name, h):
    """Central difference of the temperature with respect to ln(parameter) of coil 2."""
    both = []
    for sign in (1.0, -1.0):
        values = COIL_FIELDS[name][0] * (1.0 + sign * h * EYE[2])
        both.append(
            network.simulate(parameters.with_base(**{name: values}), network_inputs(), QUANTITIES)["temperature"]
        )
    return (both[0] - both[1]) / (2.0 * h)


@pytest.mark.parametrize("name", ["conductance", "capacity", "reference_resistance"])
def test_derivatives_agree_with_richardson(name):
    network = full_network(NETWORK)
    _, found = sensitivities(network, WARM, network_inputs(), QUANTITIES, [logarithmic(name, EYE[2])])
    exact = (4.0 * smooth(network, WARM, name, 5e-3) - smooth(network, WARM, name, 1e-2)) / 3.0
    scale = np.abs(exact).max()
    assert scale > 1.0
    assert np.abs(found["temperature"][0] - exact).max() < 1e-5 * scale  # rounding 1e-13 / 1e-4, h^4 of Richardson


@pytest.mark.parametrize("parameters", [LOADED, WARM], ids=["coils apart", "strings apart"])
def test_grouped_derivatives_are_those_of_single_simulations(parameters, monkeypatch):
    network = full_network(NETWORK)
    size = NETWORK.size("channel")
    parameters = parameters.with_term("sensor_lag", lag_time=np.linspace(0.1, 0.4, size))
    parameters = parameters.with_term("sensor_clock_offset", delay=np.linspace(0.0, 0.3, size))
    parameters = parameters.with_term("sensor_gain", gain=np.linspace(0.01, 0.1, size), pivot=0.0)
    names = ("reference_resistance", "conductance", "capacity")
    directions = [logarithmic(name, EYE[i]) for name in names for i in range(12)]
    directions += [logarithmic("heating_b", np.ones(12)), Direction("string_resistance", np.array([0.0, 1.0]), 1e-4)]
    simulated = []
    run = type(network).run
    monkeypatch.setattr(type(network), "run", lambda *a, **k: simulated.append(len(a[3])) or run(*a, **k))
    _, grouped = sensitivities(network, parameters, network_inputs(), QUANTITIES, directions)
    monkeypatch.setattr(Independence, "part", lambda *_: ("all", -1))
    _, single = sensitivities(network, parameters, network_inputs(), QUANTITIES, directions)
    assert simulated[0] < simulated[1] / 1.8
    for quantity, values in single.items():
        # differences of 1e-4 leave rounding of 1e-16 * value / 1e-4
        assert np.allclose(grouped[quantity], values, rtol=0.0, atol=1e-9 * max(1.0, np.abs(values).max())), quantity


@pytest.mark.parametrize("supply_resistance", [0.0, 0.3])
@pytest.mark.parametrize("quantity", ["voltage", "string_voltage", "terminal_voltage", "supply_power", "tension"])
def test_derivatives_of_derived_quantities_are_those_of_single_simulations(quantity, supply_resistance):
    network, times = full_network(NETWORK), {quantity: TIMES, "temperature": TIMES}
    parameters = WARM.with_base(supply_resistance=supply_resistance, sensor_lag=0.2, clock_offset=0.1)
    directions = [logarithmic(name, EYE[i]) for name in ("reference_resistance", "conductance") for i in (2, 7)]
    directions += [Direction("string_resistance", np.array([0.0, 1.0]), 1e-4), Direction("load", EYE[4], 1e-4)]
    base, found = sensitivities(network, parameters, network_inputs(), times, directions)
    for n, d in enumerate(directions):
        size = 12 if d.parameter in COIL_FIELDS else 2
        start = np.full(size, parameters.base.get(d.parameter, COIL_FIELDS.get(d.parameter, (0.0, ""))[0]))
        both = [
            network.simulate(
                parameters.with_base(**{d.parameter: start + sign * d.step * d.mask}), network_inputs(), times
            )
            for sign in (1.0, -1.0)
        ]
        expected = (both[0][quantity] - both[1][quantity]) / (2.0 * d.step)
        atol = 1e-9 * max(1.0, np.abs(expected).max(), np.abs(base[quantity]).max())  # 1e-16 * value / 1e-4
        np.testing.assert_allclose(found[quantity][n], expected, rtol=0.0, atol=atol)
    if quantity == "terminal_voltage" and supply_resistance == 0.0:
        assert np.abs(found[quantity]).max() < 1e-9  # an ideal supply does not feel its strings
    else:
        assert np.abs(found[quantity]).max() > 1e-3


def test_without_a_circuit_nothing_electrical_is_recorded():
    layout = CoilNetworkLayout(2)
    assert [q for q in ("voltage", "string_voltage", "terminal_voltage", "supply_power") if layout.elements(q)] == []
    network, inputs = full_network(layout), heater(0.1, 5.0, coils=2)
    found = network.simulate(
        CoilNetworkParameters({"load": 0.5}), inputs, {"tension": TIMES[:3], "stiffness": TIMES[:3]}
    )
    np.testing.assert_array_equal(found["tension"], np.full((3, 2), 0.5))
    with pytest.raises(ValueError, match="voltage needs a circuit"):
        network.simulate(CoilNetworkParameters(), inputs, {"voltage": TIMES[:3]})


def test_coils_that_feel_each_other_are_not_grouped():
    plain = CoilNetworkParameters()
    for term in ("neighbour_heat", "shared_mass", "supply_source_resistance", "wrong_identity"):
        apart = Independence(NETWORK, [candidate(term)], plain)
        assert apart.part("conductance", "coil", EYE[0]) == ("all", -1) or term == "supply_source_resistance"
        assert apart.part("reference_resistance", "coil", EYE[0]) == ("all", -1)
    resistive = Independence(NETWORK, [], plain.with_base(supply_resistance=0.1))
    assert resistive.part("reference_resistance", "coil", EYE[0]) == ("all", -1)
    assert Independence(NETWORK, [], WARM).part("conductance", "coil", EYE[7]) == ("string", 1)
    assert Independence(NETWORK, [], LOADED).part("conductance", "coil", EYE[7]) == ("coil", 7)
    assert Independence(NETWORK, [], LOADED).part("conductance", "coil", EYE[7] + EYE[1]) == ("all", -1)


def test_a_candidate_at_zero_has_its_one_sided_derivative():
    network = full_network(NETWORK)
    direction = Direction("radiation.emissivity_area", np.ones(12), 1e-7, is_central=False)
    base, found = sensitivities(network, LOADED, network_inputs(), {"temperature": TIMES}, [direction])
    small = network.simulate(
        LOADED.with_term("radiation", emissivity_area=2e-7), network_inputs(), {"temperature": TIMES}
    )
    slope = (small["temperature"] - base["temperature"]) / 2e-7
    assert np.abs(found["temperature"][0] - slope).max() < 2e-2 * np.abs(slope).max()  # curvature over 2e-7 m^2
    assert found["temperature"].min() < -1e4  # K per m^2: it cools


def test_lumped_heaters_share_one_simulation():
    layout = CoilNetworkLayout(3)
    directions = [Direction("capacity", np.eye(3)[i] * 0.04, 1e-4) for i in range(3)]
    network = full_network(layout)
    inputs = heater([0.1, 0.2, 0.3], 10.0, coils=3)
    _, found = sensitivities(network, CoilNetworkParameters(), inputs, {"temperature": np.array([2.0])}, directions)
    slopes = found["temperature"][:, 0]
    assert np.all(np.diag(slopes) < -1.0)
    assert np.all(slopes[~np.eye(3, dtype=bool)] == 0.0)
