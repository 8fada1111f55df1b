"""Accuracy of the network's own numerics: exp, order in the step, sampling, batches, refusals."""

import ctypes

import numpy as np
import pytest

from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork, CoilNetworkError
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.steps import SHARE, choose_step
from tests.coil_network.rigs import LOADED, NETWORK, ROOM, STOP, VOLTAGE, full_network, heater, network_inputs

TIMES = np.arange(0.0, STOP, 0.4)
WARM = LOADED.with_base(resistance_temperature_coefficient=2e-3)


def test_the_vector_exp_is_right_to_a_few_units_in_the_last_place():
    x = np.concatenate([np.linspace(-699.0, 699.0, 100_001), np.linspace(-1.0, 1.0, 10_001)])
    y = np.empty_like(x)
    library = full_network(NETWORK)._library
    library.network_exponentials(ctypes.c_int64(x.size), ctypes.c_void_p(x.ctypes.data), ctypes.c_void_p(y.ctypes.data))
    assert np.abs(y / np.exp(x) - 1.0).max() < 1e-15


def test_the_vector_exp_is_monotone_at_its_ends_and_never_infinite():
    x = np.array([-1e300, -800.0, 0.0, 800.0, 1e300])
    y = np.empty_like(x)
    library = full_network(NETWORK)._library
    library.network_exponentials(ctypes.c_int64(x.size), ctypes.c_void_p(x.ctypes.data), ctypes.c_void_p(y.ctypes.data))
    assert np.isfinite(y).all()
    assert y[2] == 1.0
    assert 0.0 < y[0] < 1e-300
    assert y[4] > 1e300


@pytest.mark.parametrize(("is_midpoint", "least"), [(True, 3.0), (False, 1.7)])
def test_the_network_is_of_second_order_at_the_middle_and_of_first_at_the_begin_of_a_step(is_midpoint, least):
    """Resistance that depends on the temperature couples circuit and heat."""
    network = full_network(NETWORK, is_midpoint)
    reference = full_network(NETWORK).simulate(WARM, network_inputs(0.005), {"temperature": TIMES})["temperature"]
    errors = []
    for step in (0.2, 0.1):
        found = network.simulate(WARM, network_inputs(step), {"temperature": TIMES})["temperature"]
        errors.append(np.abs(found - reference)[TIMES % 0.4 < 1e-9].max())
    assert errors[0] / errors[1] > least
    assert errors[1] < (5e-3 if is_midpoint else 0.2)  # K at a step of 0.1 s


def test_a_current_is_never_joined_across_a_switch():
    times = np.array([0.99, 1.0, 1.01, 14.99, 15.01])
    current = full_network(NETWORK).simulate(LOADED, network_inputs(0.2), {"current": times})["current"][:, 0]
    assert current == pytest.approx([0.0, 0.0, 6.5 / 13.2, 6.5 / 13.2, 0.0], abs=1e-12)


def test_samples_between_steps_are_joined_linearly_and_exact_at_their_ends():
    inputs = heater(0.4, 4.0, 0.5)
    times = np.array([1.0, 1.2, 1.5])
    network = full_network(CoilNetworkLayout(1))
    ends = network.simulate(LOADED, inputs, {"temperature": np.array([1.0, 1.5])})["temperature"][:, 0]
    found = network.simulate(LOADED, inputs, {"temperature": times})["temperature"][:, 0]
    assert found == pytest.approx([ends[0], 0.6 * ends[0] + 0.4 * ends[1], ends[1]], rel=1e-14)


def test_each_quantity_has_sample_times_of_its_own():
    times = {"temperature": np.array([3.0, 9.0]), "current": np.array([5.0]), "power": np.array([])}
    result = full_network(NETWORK).simulate(LOADED, network_inputs(), times)
    assert {q: v.shape for q, v in result.items()} == {"temperature": (2, 12), "current": (1, 2)}


def test_a_batch_is_its_single_runs_for_any_number_of_threads():
    network = full_network(NETWORK)
    sets = [
        LOADED,
        LOADED.with_base(conductance=0.01),
        WARM.with_term("radiation", emissivity_area=1e-4),
        LOADED.with_term("sensor_lag", lag_time=0.5),
        LOADED.with_term("second_mass", g=np.eye(12)[3] * 4e-3, C2=0.1),
    ]
    batch = network.simulate_batch(sets, network_inputs(), TIMES)
    threaded = network.simulate_batch(sets, network_inputs(), TIMES, threads=3)
    for number, one in enumerate(sets):
        single = network.simulate(one, network_inputs(), TIMES)
        for quantity, values in single.items():
            # with all terms of the batch switched on, zero strengths add exact zeros; a lag of 0 takes another path
            assert np.allclose(batch[quantity][number], values, rtol=1e-13), quantity
            assert np.array_equal(batch[quantity], threaded[quantity])


def test_calls_leave_no_trace():
    network = full_network(NETWORK)
    first = network.simulate(WARM, network_inputs(), TIMES)
    network.simulate(WARM.with_term("fatigue", loss=0.2), network_inputs(), TIMES)
    again = network.simulate(WARM, network_inputs(), TIMES)
    assert all(np.array_equal(first[q], again[q]) for q in first)


def test_given_temperatures_replace_the_heat_balance():
    """A unit driven alone by what was recorded: stiffness and current follow the given course."""
    whole = full_network(NETWORK).simulate(WARM, network_inputs(), network_inputs().time)
    course = Programme(network_inputs().time, whole["temperature"], is_linear=True)
    drive = Drive(Programme.constant(ROOM), VOLTAGE, temperature=course)
    alone = full_network(NETWORK).simulate(
        WARM.with_base(conductance=1.0, capacity=9.0), drive.on_grid(network_inputs().time), network_inputs().time
    )
    assert np.allclose(alone["temperature"], whole["temperature"], rtol=1e-13)
    assert np.allclose(alone["stiffness"], whole["stiffness"], rtol=1e-11)
    assert np.abs(alone["current"] - whole["current"]).max() < 2e-3  # A; middles of steps are extrapolated otherwise


def test_the_step_is_as_long_as_the_noise_allows():
    drive = Drive(Programme.constant(ROOM), VOLTAGE)
    times = {"temperature": TIMES, "current": TIMES}
    network = full_network(NETWORK)
    rough = choose_step(network, WARM, drive, 0.0, times, {"temperature": 1.0, "current": 0.01})
    fine = choose_step(network, WARM, drive, 0.0, times, {"temperature": 0.02, "current": 1e-3})
    assert rough.error < SHARE
    assert fine.error < SHARE
    assert fine.step < rough.step
    reference = network.simulate(WARM, network_inputs(0.005), times)["temperature"]
    found = network.simulate(WARM, fine.inputs, times)["temperature"]
    assert np.abs(found - reference).max() < 2.0 * SHARE * 0.02  # K; twice, for the error left in the halved step


def test_a_grid_meets_every_switch():
    time = grid(0.0, 10.0, 0.3, [1.0, 4.05])
    assert {1.0, 4.05, 10.0} <= set(time.tolist())
    assert np.diff(time).max() <= 0.3 + 1e-12
    assert np.diff(time).min() > 0.0


def test_values_that_run_away_are_reported_with_their_time_and_set():
    network = full_network(NETWORK)
    bad = LOADED.with_term("unnamed_heat_cube_excess", a=1e3)
    with pytest.raises(CoilNetworkError, match="stopped being finite") as caught:
        network.simulate_batch([LOADED, bad], network_inputs(), TIMES)
    assert caught.value.parameter_set == 1
    assert 1.0 < caught.value.time < 20.0


@pytest.mark.parametrize(
    ("parameters", "error", "text"),
    [
        (CoilNetworkParameters({"conductivity": 1.0}), KeyError, "no parameter of the network"),
        (CoilNetworkParameters({"conductance": np.ones(3)}), ValueError, "needs one number or 12"),
        (CoilNetworkParameters({"conductance": np.nan}), ValueError, "not finite"),
        (CoilNetworkParameters(terms={"ghost": {"a": 1.0}}), KeyError, "not in this network"),
        (
            CoilNetworkParameters(terms={"radiation": {"emissivity_area": 1e-4, "colour": 1.0}}),
            KeyError,
            "no parameter colour",
        ),
    ],
)
def test_wrong_parameters_are_refused(parameters, error, text):
    with pytest.raises(error, match=text):
        full_network(NETWORK).simulate(parameters, network_inputs(), TIMES)


def test_wrong_inputs_and_samples_are_refused():
    network = full_network(NETWORK)
    with pytest.raises(ValueError, match="outside the grid"):
        network.simulate(LOADED, network_inputs(), {"temperature": np.array([STOP + 1.0])})
    with pytest.raises(ValueError, match="must not fall"):
        network.simulate(LOADED, network_inputs(), {"temperature": np.array([3.0, 2.0])})
    with pytest.raises(ValueError, match="records no colour"):
        network.simulate(LOADED, network_inputs(), {"colour": np.array([3.0])})
    with pytest.raises(ValueError, match="this network needs"):
        network.simulate(LOADED, heater(0.4, 4.0), {"temperature": np.array([3.0])})
    with pytest.raises(ValueError, match="needs a circuit"):
        full_network(CoilNetworkLayout(1)).simulate(LOADED, heater(0.4, 4.0), {"current": np.array([3.0])})
    with pytest.raises(ValueError, match="at least one coil"):
        CoilNetworkLayout(4, (3,))


def test_two_candidates_of_one_name_are_refused():
    term = full_network(NETWORK).terms[0]
    with pytest.raises(ValueError, match="same identifier"):
        CoilNetwork(NETWORK, [term, term])
