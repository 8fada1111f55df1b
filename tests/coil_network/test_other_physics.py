"""Electrical, stiffness, mechanical and measurement candidates against closed forms."""

import numpy as np
import pytest

from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from tests.coil_network.rigs import LOADED, NETWORK, ROOM, STOP, full_network, heater, network_inputs

COIL = CoilNetworkLayout(1)
HOT = 360.0


def driven(courses, stop, step=0.05):
    """One coil whose temperature [K] is given: (times, values), linear between."""
    temperature = Programme(
        np.asarray(courses[0], dtype=float), np.asarray(courses[1], dtype=float)[:, None], is_linear=True
    )
    return heater(0.0, stop, step, temperature=temperature)


def mechanical(parameters, inputs, quantity="extension"):
    return full_network(COIL).simulate(parameters, inputs, {quantity: inputs.time})[quantity][:, 0]


def electrical(parameters, volts=6.0, layout=NETWORK, quantities=("current", "supply_current", "power")):
    inputs = Drive(Programme.constant(ROOM), Programme.constant(volts)).on_grid(grid(0.0, 5.0, 0.1))
    result = full_network(layout).simulate(parameters, inputs, dict.fromkeys(quantities, np.array([0.5, 4.9])))
    return {q: v[-1] for q, v in result.items()}


def test_a_contact_resistance_is_in_series_with_its_string():
    found = electrical(CoilNetworkParameters().with_term("contact_resistance", R_contact=np.array([1.5, 0.0])))
    assert found["current"] == pytest.approx([6.0 / (6 * 2.2 + 1.5), 6.0 / 13.2], rel=1e-14)


def test_a_source_resistance_is_shared_by_all_strings():
    found = electrical(CoilNetworkParameters().with_term("supply_source_resistance", R_source=0.7))
    assert found["supply_current"][0] == pytest.approx(6.0 / (0.7 + 13.2 / 2), rel=1e-14)


def test_a_current_limit_holds_the_supply_at_its_limit_and_leaves_smaller_currents():
    limited = CoilNetworkParameters().with_term("supply_current_limit", share=1.0, limit=0.5)
    assert electrical(limited)["supply_current"][0] == pytest.approx(0.5, rel=1e-14)
    assert electrical(limited, 3.0)["supply_current"][0] == pytest.approx(6.0 / 13.2, rel=1e-14)


def test_leads_that_warm_up_solve_their_own_loop():
    current = electrical(CoilNetworkParameters().with_term("self_heating_lead", rise=2.0))["current"][0]
    assert current * (13.2 + 2.0 * current**2) == pytest.approx(6.0, rel=1e-9)  # twelve turns of a fixed point


@pytest.mark.parametrize(("name", "parameter"), [("open_coil", "openness"), ("shorted_coil", "bridged")])
def test_a_coil_breaks_or_is_bridged_at_its_instant(name, parameter):
    inputs = Drive(Programme.constant(ROOM), Programme.constant(6.0)).on_grid(grid(0.0, 10.0, 0.1))
    mask = np.eye(12)[8]
    parameters = CoilNetworkParameters().with_term(name, **{parameter: mask, "instant": 4.0})
    current = full_network(NETWORK).simulate(parameters, inputs, {"current": np.array([3.9, 4.15])})["current"]
    after = {"open_coil": 0.0, "shorted_coil": 6.0 / 11.0}[name]
    assert current[0] == pytest.approx([6.0 / 13.2] * 2, rel=1e-12)
    assert current[1] == pytest.approx([6.0 / 13.2, after], abs=1e-9)  # 1e-12 of the conductance is left


def test_an_instant_within_a_step_acts_on_its_part_of_the_step():
    """So that the fit of an instant has a derivative."""
    inputs = Drive(Programme.constant(ROOM), Programme.constant(6.0)).on_grid(grid(0.0, 10.0, 0.5))
    network = full_network(NETWORK)

    def energy(instant):
        parameters = CoilNetworkParameters().with_term("shorted_coil", bridged=np.eye(12)[0], instant=instant)
        return network.simulate(parameters, inputs, {"temperature": np.array([10.0])})["temperature"][0, 1]

    ends = [energy(t) for t in (4.0, 4.1, 4.2, 4.3, 4.4, 4.5)]
    assert np.all(np.diff(ends) < -0.01)  # K; later means less heat, at every tenth of the step


ELECTRICAL = [t for t in catalogue() if t.unit == "electrical" and t.is_named]


@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in ELECTRICAL])
def test_no_electrical_candidate_gives_more_power_than_the_supply(term):
    network = full_network(NETWORK)
    times = np.arange(1.05, STOP, 0.1)
    for pick in (lambda p: p.lower, lambda p: p.upper, lambda p: p.starts[0], lambda p: p.starts[-1]):
        values = {p.name: 8.0 if p.is_instant else pick(p) for p in term.parameters}
        if term.identifier == "shorted_coil":  # one coil: a string that is shorted whole has no finite current
            values["bridged"] = values["bridged"] * np.eye(12)[3]
        inputs = network_inputs()
        found = network.simulate(LOADED.with_term(term.identifier, **values), inputs, times)
        voltage = inputs.voltage[np.searchsorted(inputs.time, times) - 1, 0]
        supplied = voltage * found["supply_current"][:, 0]
        # 1e-3: power and current are joined in a straight line from step to step
        assert np.all(found["power"].sum(axis=1) <= supplied * (1.0 + 1e-3) + 1e-9), values
        assert np.all(found["power"] >= -1e-12)


def test_resistance_follows_temperature_and_phase():
    inputs = driven(([0.0, 20.0, 40.0], [ROOM, HOT, ROOM]), 40.0)
    warm = mechanical(
        CoilNetworkParameters().with_term("temperature_dependent_resistance", alpha=2e-3), inputs, "resistance"
    )
    temperature = np.interp(inputs.time, [0.0, 20.0, 40.0], [ROOM, HOT, ROOM])
    assert np.allclose(warm, 2.2 * (1.0 + 2e-3 * (temperature - ROOM)), rtol=1e-14)
    phase = mechanical(
        CoilNetworkParameters().with_term("phase_dependent_resistance", delta=-0.13), inputs, "resistance"
    )
    assert phase[0] == pytest.approx(2.2)
    assert phase.min() == pytest.approx(2.2 * 0.87, rel=5e-3)  # nearly all austenite at 360 K
    up, down = phase[np.searchsorted(inputs.time, [10.0, 30.0])]
    assert down < up - 0.05  # same temperature on the way down: still austenite


def test_stress_shifts_both_branches_by_slope_times_tension():
    inputs = driven(([0.0, 20.0, 40.0], [ROOM, HOT, ROOM]), 40.0)
    shifted = mechanical(LOADED.with_term("stress_dependent_transformation", slope=4.0), inputs, "stiffness")
    offset = mechanical(LOADED.with_term("transformation_shift", offset=4.0 * 0.981), inputs, "stiffness")
    plain = mechanical(LOADED, inputs, "stiffness")
    assert np.allclose(shifted, offset, rtol=1e-13)
    later = np.interp(inputs.time - 4.0 * 0.981 / ((HOT - ROOM) / 20.0), inputs.time, plain)
    rising = inputs.time < 20.0
    assert np.abs(shifted - later)[rising].max() < 0.2  # N/m; interpolation between samples


def test_fatigue_counts_one_cycle_for_up_and_down():
    cycles = 5
    times = np.arange(2 * cycles + 1) * 20.0
    inputs = driven((times, np.where(np.arange(2 * cycles + 1) % 2, HOT, ROOM)), times[-1])
    loss = 0.05
    stiffness = mechanical(LOADED.with_term("fatigue", loss=loss), inputs, "stiffness")
    tops = stiffness[np.searchsorted(inputs.time, times[1::2])] - COIL_FIELDS["heating_d"][0]
    # half a cycle was made on the way to the first top; 2 %: the loop does not quite reach 0 and 1
    assert tops / tops[0] == pytest.approx([(1 - loss * (0.5 + n)) / (1 - loss * 0.5) for n in range(cycles)], rel=0.02)


def test_a_coil_that_is_hot_at_the_start_has_made_no_cycle():
    inputs = driven(([0.0, 5.0], [HOT, HOT]), 5.0)
    tired = mechanical(LOADED.with_term("fatigue", loss=0.3), inputs, "stiffness")
    assert np.array_equal(tired, mechanical(LOADED, inputs, "stiffness"))
    assert tired[0] > 380.0


def test_incomplete_transformation_scales_the_rise():
    inputs = driven(([0.0, 20.0], [ROOM, HOT]), 20.0)
    d = COIL_FIELDS["heating_d"][0]
    whole = mechanical(LOADED, inputs, "stiffness") - d
    part = mechanical(LOADED.with_term("incomplete_transformation", retained=0.3), inputs, "stiffness") - d
    assert np.allclose(part, 0.7 * whole, atol=1e-10)


def test_minor_loops_move_at_once_after_a_reversal_and_stay_within_the_branches():
    inputs = driven(([0.0, 10.0, 14.0, 18.0], [ROOM, 333.0, 325.0, 333.0]), 18.0)
    plain = mechanical(LOADED, inputs, "stiffness")
    sloped = mechanical(LOADED.with_term("minor_loop_memory", slope=0.3), inputs, "stiffness")
    turn, after = np.searchsorted(inputs.time, [10.0, 12.0])
    assert plain[after] == plain[turn]  # the play operator stands still
    assert sloped[after] < sloped[turn] - 1.0
    assert np.allclose(sloped[:turn], plain[:turn], rtol=1e-13)  # on the outer branch nothing changes


def test_friction_holds_the_slide_until_the_force_exceeds_it():
    friction = 0.1
    inputs = driven(([0.0, 20.0, 40.0], [ROOM, HOT, ROOM]), 40.0)
    parameters = LOADED.with_term("slide_friction", friction=friction)
    extension = mechanical(parameters, inputs)
    stiffness = mechanical(parameters, inputs, "stiffness")
    assert np.all(np.abs(0.981 - stiffness * extension) <= friction * (1.0 + 1e-12))
    rising = np.searchsorted(inputs.time, 19.0)
    assert stiffness[rising] * extension[rising] == pytest.approx(0.981 + friction, rel=1e-12)  # sliding up
    assert np.diff(extension).max() > 0.0


def test_backlash_loses_half_the_gap_on_either_side():
    gap = 4e-4
    inputs = driven(([0.0, 20.0, 40.0], [ROOM, HOT, ROOM]), 40.0)
    lost = mechanical(LOADED.with_term("backlash", gap=gap), inputs) - mechanical(LOADED, inputs)
    assert np.abs(lost).max() == pytest.approx(gap / 2, rel=1e-10)
    assert lost[np.searchsorted(inputs.time, 19.0)] == pytest.approx(gap / 2, rel=1e-10)


def test_viscous_damping_relaxes_with_damping_over_stiffness():
    damping, k = 300.0, COIL_FIELDS["heating_d"][0]
    inputs = driven(([0.0, 10.0], [ROOM, ROOM]), 10.0)
    start = CoilNetworkParameters({"load": 1.0})
    still = mechanical(start.with_term("viscous_damping", damping=damping), inputs)
    assert np.allclose(still, 1.0 / mechanical(start, inputs, "stiffness"), rtol=1e-13)  # it begins at rest
    jump = driven(([0.0, 1.0, 1.05, 12.0], [ROOM, ROOM, HOT, HOT]), 12.0)
    k = mechanical(start, jump, "stiffness")[-1]
    found = mechanical(start.with_term("viscous_damping", damping=damping), jump)
    late = jump.time > 1.2
    excess = found[late] - 1.0 / k
    assert np.allclose(np.diff(np.log(excess)), -k / damping * 0.05, rtol=1e-6)


def test_wires_share_the_load_as_springs_in_parallel():
    inputs = driven(([0.0, 20.0], [ROOM, HOT]), 20.0)
    parameters = LOADED.with_term("supply_wire_stiffness", wire=20.0, reach=0.002)
    extension, k = mechanical(parameters, inputs), mechanical(parameters, inputs, "stiffness")
    assert np.allclose(k * extension + 20.0 * (extension - 0.002), 0.981, rtol=1e-12)


def test_contraction_tilt_and_creep_change_the_extension_as_their_laws_say():
    inputs = driven(([0.0, 20.0], [ROOM, HOT]), 20.0)
    plain = mechanical(LOADED, inputs)
    temperature = np.interp(inputs.time, [0.0, 20.0], [ROOM, HOT])
    contracted = mechanical(LOADED.with_term("thermal_contraction", contraction=1e-5), inputs)
    assert np.allclose(plain - contracted, 1e-5 * (temperature - ROOM), atol=1e-15)
    assert np.allclose(mechanical(LOADED.with_term("tilt", loss=0.1), inputs), 0.9 * plain, rtol=1e-13)
    for tau in (7.0, 400.0):  # on either side of where the series takes over from exp
        crept = mechanical(LOADED.with_term("creep", compliance=1e-4, tau=tau), inputs) - plain
        assert np.allclose(crept, 1e-4 * 0.981 * (1.0 - np.exp(-inputs.time / tau)), rtol=1e-11, atol=1e-16)


def sensor(parameters, times, quantity="temperature"):
    return full_network(COIL).simulate(parameters, RAMP, {quantity: times})[quantity][:, 0]


RAMP = driven(([0.0, 5.0, 25.0], [300.0, 300.0, 340.0]), 25.0, 0.1)  # 2 K/s from 5 s on
TIMES = np.arange(6.0, 24.0, 0.37)


def test_a_late_clock_shows_what_was_before():
    found = sensor(CoilNetworkParameters().with_term("sensor_clock_offset", delay=0.8), TIMES)
    assert np.allclose(found, 300.0 + 2.0 * np.maximum(TIMES - 0.8 - 5.0, 0.0), atol=1e-10)


def test_a_lag_answers_a_ramp_with_its_closed_form():
    tau, t = 1.7, TIMES - 5.0
    found = sensor(CoilNetworkParameters().with_term("sensor_lag", lag_time=tau), TIMES)
    exact = 300.0 + 2.0 * (t - tau * (1.0 - np.exp(-t / tau)))
    # exact on the grid; between its points, h = 0.1 s apart, a straight line is off by h^2 / 8 times 2 K/s / tau
    assert np.abs(found - exact).max() < 2.0 * 0.1**2 / 8.0 / tau


def test_gain_bias_drift_and_clipping_are_what_their_laws_say():
    truth = sensor(CoilNetworkParameters(), TIMES)
    first = CoilNetworkParameters()
    assert np.allclose(
        sensor(first.with_term("sensor_gain", gain=0.1, pivot=300.0), TIMES), truth + 0.1 * (truth - 300.0)
    )
    about = sensor(first.with_term("sensor_gain", gain=0.1, zero=-2.0, scale=10.0, pivot=300.0), TIMES)
    assert np.allclose(about, truth + 0.1 * (truth - 280.0))
    assert np.allclose(sensor(first.with_term("sensor_bias", bias=0.2, scale=10.0), TIMES), truth + 2.0)
    assert np.allclose(
        sensor(first.with_term("sensor_drift", drift=0.3, scale=10.0), TIMES), truth + 3.0 * TIMES / 60.0
    )
    clipped = sensor(first.with_term("sensor_clipping", clipped=1.0, ceiling=2.0, scale=10.0, pivot=300.0), TIMES)
    assert np.allclose(clipped, np.minimum(truth, 320.0))


def test_two_channels_that_were_exchanged_show_each_other():
    size, first = NETWORK.size("channel"), NETWORK.channel("temperature")
    exchange, other = np.zeros(size), np.zeros(size)
    exchange[[first, first + 7]] = 1.0
    other[[first, first + 7]] = 7.0, 0.0
    parameters = CoilNetworkParameters({"reference_resistance": np.linspace(2.0, 3.0, 12)})
    times = np.arange(0.0, STOP, 0.5)
    right = full_network(NETWORK).simulate(parameters, network_inputs(), times)["temperature"]
    wrong = full_network(NETWORK).simulate(
        parameters.with_term("wrong_identity", exchange=exchange, other=other), network_inputs(), times
    )["temperature"]
    assert np.abs(right[:, 0] - right[:, 7]).max() > 1.0
    assert np.allclose(wrong[:, [0, 7]], right[:, [7, 0]], rtol=1e-13)
    assert np.allclose(wrong[:, 1:7], right[:, 1:7], rtol=1e-13)
