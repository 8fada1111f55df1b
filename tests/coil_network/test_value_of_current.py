"""A sensor that reads part of the current in its coil: closed forms, derivatives, and what it needs to be read."""

import numpy as np
import pytest

from diagnosis.candidates.registry import candidate
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import places
from diagnosis.models.coil_network.kernel.sensitivities import Direction, sensitivities
from tests.coil_network.rigs import LOADED, NETWORK, ROOM, STOP, VOLTAGE, full_network, heater, network_inputs

TERM = "unnamed_value_linear_amperes"
SCALE, TYPICAL = 10.0, 0.4  # K, A: as the law has them
COIL = 7  # of string 2
#: String 2 takes less current than string 1, so that the wrong string would be seen.
RESISTANCE = np.repeat([2.2, 2.6], 6)
UNEQUAL = LOADED.with_base(reference_resistance=RESISTANCE)
WARM = UNEQUAL.with_base(resistance_temperature_coefficient=2e-3)
#: Steps are 0.1 s: coarser, finer and never on their ends.
SAMPLES = {"slow": np.arange(0.37, STOP, 0.7), "fast": np.arange(0.013, STOP, 0.031)}
EYE = np.eye(NETWORK.size("channel"))
CHANNEL = NETWORK.channel("temperature") + COIL


def picked_up(parameters, a, **sensor):
    on = parameters.with_term(TERM, a=a * EYE[CHANNEL], scale=SCALE)
    for name, values in sensor.items():
        on = on.with_term(name, **values)
    return on


def ohm(times, string=1):
    """Current of a string with constant resistances [A]: the supply over its coils' sum."""
    volts = VOLTAGE.values[np.searchsorted(VOLTAGE.times, times, side="right") - 1]
    return np.where(times < 0.0, 0.0, volts) / RESISTANCE[6 * string : 6 * string + 6].sum()


@pytest.mark.parametrize("times", [pytest.param(t, id=name) for name, t in SAMPLES.items()])
@pytest.mark.parametrize(
    ("delay", "lag"), [(0.0, 0.0), (0.13, 0.0), (0.13, 0.5)], ids=["plain", "late clock", "late and slow"]
)
def test_it_adds_ohms_current_at_the_time_of_the_sample_and_no_lag_of_the_sensor(times, delay, lag):
    """Nothing but temperatures is recorded; a clock that is `delay` late shows what was `delay` ago."""
    network, wanted = full_network(NETWORK), {"temperature": times}
    sensors = {"sensor_clock_offset": {"delay": delay}, "sensor_lag": {"lag_time": lag}}
    without = network.simulate(picked_up(UNEQUAL, 0.0, **sensors), network_inputs(), wanted)["temperature"]
    found = network.simulate(picked_up(UNEQUAL, 0.2, **sensors), network_inputs(), wanted)["temperature"]
    expected = 0.2 * SCALE * ohm(times - delay) / TYPICAL
    assert expected.max() > 2.0
    first = times >= delay  # before the start the flow of the first step stands
    assert np.abs(found - without)[first, COIL] == pytest.approx(expected[first], abs=1e-12)  # rounding of 300 K: 1e-13
    others = np.arange(12) != COIL
    # other channels go through the same sensors: their values are multiplied and added to in the same way
    assert np.array_equal(found[:, others], without[:, others])


@pytest.mark.parametrize("times", [pytest.param(t, id=name) for name, t in SAMPLES.items()])
def test_it_adds_the_current_that_the_network_would_record_at_the_same_times(times):
    """Resistances follow the temperature: the current changes within a level of the supply."""
    network, wanted = full_network(NETWORK), {"temperature": times, "current": times}
    without = network.simulate(WARM, network_inputs(), wanted)
    found = network.simulate(picked_up(WARM, -0.2), network_inputs(), wanted)
    expected = -0.2 * SCALE * without["current"][:, 1] / TYPICAL
    change = (found["temperature"] - without["temperature"])[:, COIL]
    assert change == pytest.approx(expected, abs=1e-12)  # rounding of 300 K
    assert np.array_equal(found["current"], without["current"])


def test_a_channel_that_shows_another_coil_reads_the_current_there():
    network, times = full_network(NETWORK), SAMPLES["slow"]
    first = NETWORK.channel("temperature")
    swap = {"wrong_identity": {"exchange": EYE[CHANNEL] + EYE[first], "other": COIL * EYE[first]}}
    found, without = (
        network.simulate(picked_up(UNEQUAL, a, **swap), network_inputs(), {"temperature": times})["temperature"]
        for a in (0.2, 0.0)
    )
    expected = 0.2 * SCALE * ohm(times, string=0) / TYPICAL
    assert (found - without)[:, COIL] == pytest.approx(expected, abs=1e-12)  # rounding of 300 K


def test_its_derivative_by_the_strength_is_the_current_and_belongs_to_its_channel():
    network, times = full_network(NETWORK), SAMPLES["slow"]
    name = f"{TERM}.a"
    others = [NETWORK.channel("temperature") + 2, NETWORK.channel("extension") + 3]
    directions = [Direction(name, EYE[c], 1e-3) for c in (CHANNEL, *others)]
    base, slopes = sensitivities(
        network,
        picked_up(WARM, 0.05),
        network_inputs(),
        dict.fromkeys(("temperature", "extension", "current"), times),
        directions,
    )
    per_ampere = SCALE / TYPICAL
    for n, (quantity, coil, string) in enumerate(
        (("temperature", COIL, 1), ("temperature", 2, 0), ("extension", 3, 0))
    ):
        expected = per_ampere * base["current"][:, string]
        assert slopes[quantity][n, :, coil] == pytest.approx(expected, abs=1e-9)  # rounding 1e-13 / 1e-3
        rest = slopes[quantity][n].copy()
        rest[:, coil] = 0.0
        assert not rest.any()
        assert not slopes["current"][n].any()


@pytest.mark.parametrize("parameters", [UNEQUAL, WARM], ids=["constant resistance", "resistance follows heat"])
def test_derivatives_of_the_base_with_it_are_differences_of_single_simulations(parameters):
    """Coils and strings are perturbed together where they may be; each alone must say the same."""
    network, times = full_network(NETWORK), dict.fromkeys(("temperature", "current", "supply_current"), SAMPLES["slow"])
    on = picked_up(parameters, 0.2)
    directions, h = [], 1e-4
    for name in ("reference_resistance", "conductance"):
        directions += [Direction(name, COIL_FIELDS[name][0] * np.eye(12)[i], h) for i in range(12)]
    _, slopes = sensitivities(network, on, network_inputs(), times, directions)
    for n, direction in enumerate(directions):
        value = np.asarray(on.base.get(direction.parameter, COIL_FIELDS[direction.parameter][0]))
        high, low = (
            network.simulate(
                on.with_base(**{direction.parameter: value + sign * h * direction.mask}), network_inputs(), times
            )
            for sign in (1.0, -1.0)
        )
        for quantity in times:
            expected = (high[quantity] - low[quantity]) / (2.0 * h)
            assert np.abs(slopes[quantity][n] - expected).max() < 1e-8, (direction, quantity)  # rounding 1e-13 / 1e-4
    own = slopes["temperature"][:12, :, COIL]
    assert np.abs(own[6:]).max() > 1.0  # K: its own string's resistances change what it picks up
    if parameters is UNEQUAL:
        assert not own[:6].any()  # those of the other string do not


def test_channels_of_no_coil_pick_up_nothing_to_the_last_bit():
    """So that the score, which drops what has no slope, never tries the term there."""
    network, times = full_network(NETWORK), SAMPLES["slow"]
    everywhere = UNEQUAL.with_term(TERM, a=0.2, scale=SCALE)
    found, without = (network.simulate(p, network_inputs(), times) for p in (everywhere, UNEQUAL))
    for quantity in ("current", "supply_current"):
        assert np.array_equal(found[quantity], without[quantity]), quantity
    assert np.abs(found["temperature"] - without["temperature"]).max() > 2.0


def test_where_the_currents_are_unknown_it_is_refused():
    """A network whose power is given in place of its circuit has no currents; 0 A would be a lie."""
    drive = Drive(Programme.constant(ROOM), power=Programme.constant(np.full(12, 0.3)))
    inputs = drive.on_grid(grid(0.0, 5.0, 0.1))
    network = full_network(NETWORK)
    with pytest.raises(ValueError, match="currents of the strings are unknown"):
        network.simulate(picked_up(UNEQUAL, 0.2), inputs, {"temperature": np.array([1.0, 2.0])})
    network.simulate(UNEQUAL, inputs, {"temperature": np.array([1.0, 2.0])})


def test_heaters_without_a_circuit_have_no_current_to_pick_up():
    """To the last bit, as above."""
    network, times = full_network(CoilNetworkLayout(2)), {"temperature": np.array([1.0, 4.0])}
    inputs = heater(0.3, 5.0, coils=2)
    found = network.simulate(CoilNetworkParameters().with_term(TERM, a=0.2, scale=SCALE), inputs, times)
    without = network.simulate(CoilNetworkParameters(), inputs, times)
    assert np.array_equal(found["temperature"], without["temperature"])


def test_it_is_offered_for_channels_of_coils_with_a_circuit_alone():
    term, measured = candidate(TERM), ("temperature", "current", "supply_current", "extension")
    found = places(term, NETWORK, measured)
    assert len(found) == 2 * (12 + 1)
    assert {p.label.split(".")[-1].split()[-1] for p in found} == {"temperature", "extension"}
    assert {p.label: p.fixed for p in found}["every extension"] == {"scale": 1e-3}
    assert places(term, CoilNetworkLayout(2), ("temperature",)) == []
