"""Temperatures against the closed forms of the paper, and the conservation of energy."""

import numpy as np
import pytest
from fmu_runs import STEP, advance
from thermal_twin import CELSIUS

from chainmail.equations import Coil
from cosim.unit.protocol import seconds

COIL = Coil()
POWER = 1.0 / COIL.resistance  # 1 V on each coil
#: The step is exact; what remains are rounding errors of some thousand steps, 1e-13 each.
EXACT = 1e-10

both_versions = pytest.mark.parametrize("version", [3, 2])


def temperatures(unit, powers, size=STEP, begin=0):
    return advance(unit, powers, ("temperature",), size, begin)[:, 0] - CELSIUS


@both_versions
def test_heating_follows_equation_3(make_unit, version):
    unit = make_unit(version=version)
    unit.initialise(0)
    run = temperatures(unit, np.full((3000, 36), POWER))
    time = seconds(STEP) * np.arange(1, 3001)
    np.testing.assert_allclose(run[:, 17], COIL.heating(time, 1.0), rtol=EXACT)
    assert np.ptp(run, axis=1).max() == 0.0  # equal coils, equal numbers


@both_versions
@pytest.mark.parametrize("voltage", [0.25, 0.5, 1.0, 2.0])
def test_long_heating_ends_at_the_temperature_of_equation_4(make_unit, version, voltage):
    unit = make_unit(version=version)
    unit.initialise(0)
    end = temperatures(unit, np.full((1, 36), voltage**2 / COIL.resistance), size=1000 * 10**9)
    np.testing.assert_allclose(end, COIL.terminal_temperature(voltage), rtol=EXACT)


@both_versions
def test_cooling_follows_equation_5(make_unit, version):
    unit = make_unit(version=version)
    unit.initialise(0)
    hot = 1000 * 10**9
    advance(unit, np.full((1, 36), POWER), (), size=hot)
    run = temperatures(unit, np.zeros((3000, 36)), begin=hot)
    time = seconds(STEP) * np.arange(1, 3001)
    np.testing.assert_allclose(run[:, 3], COIL.cooling(time, COIL.terminal_temperature(1.0)), rtol=EXACT)


def test_cooling_without_the_regressed_rate_goes_as_fast_as_heating(make_unit):
    unit = make_unit(parameters={"use_regressed_cooling_rate": False})
    unit.initialise(0)
    hot = 1000 * 10**9
    advance(unit, np.full((1, 36), POWER), (), size=hot)
    run = temperatures(unit, np.zeros((1000, 36)), begin=hot)[:, 0]
    rate = -np.diff(np.log(run - COIL.ambient)) / seconds(STEP)
    np.testing.assert_allclose(rate, COIL.heating_rate, rtol=1e-8)  # differences of logarithms lose digits
    assert round(COIL.heating_rate, 4) == 0.2226


def test_a_coil_with_negligible_power_counts_as_switched_off(make_unit):
    unit = make_unit()
    unit.initialise(0)
    hot = 1000 * 10**9
    advance(unit, np.full((1, 36), POWER), (), size=hot)
    leaking = np.where(np.arange(36) < 18, 1e-9, 1.1e-9)[None]
    end = temperatures(unit, leaking, size=10**9, begin=hot)[0]
    rise = COIL.terminal_temperature(1.0) - COIL.ambient
    rate = -np.log((end - COIL.ambient) / rise)
    np.testing.assert_allclose(rate[:18], COIL.cooling_rate, rtol=1e-6)  # 1e-9 W itself warms by 2e-7 K
    np.testing.assert_allclose(rate[18:], COIL.heating_rate, rtol=1e-6)


def test_one_long_step_equals_many_short_ones(make_unit):
    long, short = make_unit(), make_unit()
    outputs = ("temperature", "stiffness", "convected_energy", "stored_energy")
    power = np.linspace(0.1, 0.6, 36)
    for unit in (long, short):
        unit.initialise(0)
    once = advance(long, power[None], outputs, size=1000 * STEP)[-1]
    often = advance(short, np.tile(power, (1000, 1)), outputs)[-1]
    np.testing.assert_allclose(once, often, rtol=EXACT)


def test_without_convection_all_heat_is_stored(make_unit):
    unit = make_unit(parameters={"heat_transfer_coefficient": 0.0})
    unit.initialise(0)
    run = advance(unit, np.full((10, 36), POWER), ("temperature", "convected_energy"), size=10**9)[-1]
    np.testing.assert_allclose(run[0] - CELSIUS, 22.0 + 10.0 * POWER / COIL.heat_capacity, rtol=EXACT)
    np.testing.assert_allclose(run[1], 0.0, atol=1e-13)  # rounding of 4.5 J


@both_versions
@pytest.mark.parametrize("interface", ["co_simulation", "model_exchange"])
def test_electrical_energy_is_stored_or_convected(make_unit, version, interface):
    unit = make_unit(version=version, interface=interface)
    unit.initialise(0)
    chance = np.random.default_rng(1)
    powers = chance.uniform(0.0, 1.0, (200, 36)) * (chance.random((200, 36)) < 0.7)
    energy = advance(unit, powers, ("stored_energy", "convected_energy")).sum(axis=1)
    supplied = np.cumsum(powers, axis=0) * seconds(STEP)
    # CVODE keeps the sum of the two states, which is linear in them, to rounding of its own error weights.
    tolerance = 1e-12 if interface == "co_simulation" else 1e-8
    np.testing.assert_allclose(energy, supplied, rtol=0.0, atol=tolerance)


def test_every_coil_has_its_own_constants(make_unit):
    volume = np.linspace(5e-9, 9e-9, 36)
    coefficient = np.linspace(60.0, 120.0, 36)
    resistance = np.linspace(2.0, 2.4, 36)
    given = {"volume": volume, "heat_transfer_coefficient": coefficient, "reference_resistance": resistance}
    for version in (3, 2):
        unit = make_unit(version=version, parameters=given)
        unit.initialise(0)
        run = advance(unit, np.full((100, 36), POWER), ("temperature", "resistance"))[-1]
        expected = [
            Coil(resistance=r, heat_transfer_coefficient=h, volume=v).heating(1.0, np.sqrt(POWER * r))
            for v, h, r in zip(volume, coefficient, resistance, strict=True)
        ]
        np.testing.assert_allclose(run[0] - CELSIUS, expected, rtol=EXACT)
        np.testing.assert_array_equal(run[1], resistance)


def test_resistance_rises_with_temperature_where_a_coefficient_is_given(make_unit):
    unit = make_unit(parameters={"resistance_temperature_coefficient": 1e-3, "reference_temperature": 300.0})
    unit.initialise(0)
    temperature, resistance = advance(unit, np.full((100, 36), POWER), ("temperature", "resistance"))[-1]
    np.testing.assert_allclose(resistance, 2.2 * (1.0 + 1e-3 * (temperature - 300.0)), rtol=1e-15)
