"""FMI 2.0 against 3.0, Co-Simulation against Model Exchange under CVODE, and all against a scipy twin."""

import numpy as np
import pytest
from fmu_runs import STEP, advance
from thermal_twin import simulate

from cosim.unit import seconds

OUTPUTS = ("temperature", "stiffness", "convected_energy")
ALL_OUTPUTS = ("temperature", "stiffness", "rest_length", "resistance", "stored_energy", "convected_energy")


def programme(steps, coils, seed=2):
    """Power of every coil [W], shape (steps, coils): constant for 50 steps at a time, often off."""
    chance = np.random.default_rng(seed)
    blocks = (steps + 49) // 50
    power = chance.uniform(0.2, 1.2, (blocks, coils)) * (chance.random((blocks, coils)) < 0.6)
    return np.repeat(power, 50, axis=0)[:steps]


@pytest.mark.parametrize("model", ["thermal_stiffness", "instant_stiffness"])
@pytest.mark.parametrize("interface", ["co_simulation", "model_exchange"])
@pytest.mark.parametrize("coils", [1, 6, 36, 288])
def test_fmi_2_and_fmi_3_agree_to_the_last_bit(make_unit, model, interface, coils):
    runs = []
    for version in (2, 3):
        unit = make_unit(model, version, interface, coils)
        unit.initialise(0)
        assert unit.variables["power"].shape == (coils,)
        runs.append(advance(unit, programme(60, coils), ALL_OUTPUTS, size=5 * STEP))
        unit.terminate()
    assert runs[0].shape == (60, 6, coils)
    np.testing.assert_array_equal(runs[0], runs[1])


@pytest.mark.parametrize("regressed", [True, False])
def test_co_simulation_agrees_with_scipy(make_unit, regressed):
    powers = programme(400, 6)
    unit = make_unit(coils=6, parameters={"use_regressed_cooling_rate": regressed})
    unit.initialise(0)
    run = advance(unit, powers, OUTPUTS, size=5 * STEP)
    twin = simulate(powers, seconds(5 * STEP), regressed=regressed)
    # DOP853 at rtol 1e-12 drifts by 1e-11 of 60 degC over 400 steps; the stiffness changes by up to 14 N/(m K).
    np.testing.assert_allclose(run[:, 0], twin[:, 0], rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(run[:, 1], twin[:, 1], rtol=0.0, atol=2e-7)
    np.testing.assert_allclose(run[:, 2], twin[:, 2], rtol=0.0, atol=1e-9)
    assert np.ptp(twin[:, 1]) > 150.0  # the programme drives the coils through the loop


@pytest.mark.parametrize("version", [3, 2])
def test_model_exchange_under_cvode_agrees_with_co_simulation(make_unit, version):
    powers = programme(400, 36)
    runs = []
    for interface in ("co_simulation", "model_exchange"):
        unit = make_unit(version=version, interface=interface)
        unit.initialise(0)
        runs.append(advance(unit, powers, OUTPUTS, size=5 * STEP))
    difference = np.abs(runs[0] - runs[1]).max(axis=(0, 2))
    # CVODE at rtol 1e-8 errs by some 1e-6 K in a step (of 300 K); errors add up over the time constant of 7 s, 140
    # steps: 1e-3 K at most. Stiffness: times 14 N/(m K). Energy: times the heat capacity of 0.04 J/K.
    assert difference[0] < 1e-3
    assert difference[1] < 1.4e-2
    assert difference[2] < 4e-5


def test_a_tighter_tolerance_brings_cvode_closer(make_unit):
    powers = programme(200, 6)
    exact = make_unit(coils=6)
    exact.initialise(0)
    reference = advance(exact, powers, OUTPUTS)
    errors = []
    for tolerance in (1e-6, 1e-8, 1e-10):
        unit = make_unit(
            interface="model_exchange", coils=6, relative_tolerance=tolerance, absolute_tolerance=1e-2 * tolerance
        )
        unit.initialise(0)
        errors.append(np.abs(advance(unit, powers, OUTPUTS) - reference)[:, 0].max())
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-5


def test_the_instant_model_switches_with_the_power(make_unit):
    power = np.zeros((2, 36))
    power[0, 4], power[1, 7] = 0.45, 0.3
    for interface in ("co_simulation", "model_exchange"):
        unit = make_unit("instant_stiffness", interface=interface)
        unit.initialise(0)
        run = advance(unit, power, ALL_OUTPUTS)
        np.testing.assert_array_equal(run[:, 1], np.where(power > 0.0, 356.05951795685417, 157.1))
        np.testing.assert_array_equal(run[:, 0], 295.15)
        np.testing.assert_array_equal(run[:, 3], 2.2)
        np.testing.assert_array_equal(run[:, 4], 0.0)
        # Sums of 0.01 s times the power; CVODE's is right to its tolerance.
        np.testing.assert_allclose(run[-1, 5], power.sum(axis=0) * seconds(STEP), rtol=1e-7, atol=1e-15)


def test_both_models_can_take_each_others_place(make_unit):
    thermal, instant = make_unit("thermal_stiffness"), make_unit("instant_stiffness")
    assert set(thermal.variables) == set(instant.variables)
    for name, variable in thermal.variables.items():
        other = instant.variables[name]
        assert (variable.causality, variable.shape, variable.unit) == (other.causality, other.shape, other.unit)


def test_the_maximum_of_the_instant_model_is_equation_2_at_70_degrees():
    from thermal_twin import heating

    assert float(heating(70.0)) == pytest.approx(356.05951795685417, rel=1e-14)
