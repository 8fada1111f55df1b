"""Physics of tcp_muscle: the linear model of Yip and Niemeyer, without hysteresis."""

import numpy as np
import pytest
from fmu_runs import STEP, advance
from tcp_twin import AMBIENT, CAPACITY, CONDUCTANCE, CONTRACTION, LENGTH, MUSCLES, STIFFNESS

from cosim.unit.protocol import seconds

#: The step is exact; what remains are rounding errors of some thousand steps, 1e-13 each.
EXACT = 1e-10
POWER = 1.0 / 1.15  # 1 V on each bundle


def started(make_unit, **given):
    unit = make_unit("tcp_muscle", **given)
    unit.initialise(0)
    return unit


@pytest.mark.parametrize("version", [3, 2])
def test_heating_is_the_exponential_of_a_first_order_system(make_unit, version):
    run = advance(started(make_unit, version=version), np.full((3000, 36), POWER), ("temperature",))[:, 0]
    time = seconds(STEP) * np.arange(1, 3001)
    rise = POWER / (MUSCLES * CONDUCTANCE) * -np.expm1(-time * CONDUCTANCE / CAPACITY)
    np.testing.assert_allclose(run[:, 8] - AMBIENT, rise, rtol=EXACT)
    end = POWER / (MUSCLES * CONDUCTANCE)
    assert end == pytest.approx(80.5, abs=0.05)


def test_the_force_is_that_of_yip_and_niemeyer(make_unit):
    """F = k (x - x0) + c (T - T0) for each muscle, c = k times contraction coefficient times length."""
    unit = started(make_unit)
    run = advance(unit, np.full((500, 36), POWER), ("stiffness", "rest_length", "temperature"))[:, :, 0]
    stiffness, rest, temperature = run.T
    length = 0.033
    thermal = STIFFNESS * CONTRACTION * LENGTH
    expected = MUSCLES * (STIFFNESS * (length - LENGTH) + thermal * (temperature - AMBIENT))
    np.testing.assert_allclose(stiffness * (length - rest), expected, rtol=1e-12)
    assert thermal == pytest.approx(0.0432, abs=1e-4)  # N/K


def test_there_is_no_hysteresis(make_unit):
    """The same length at the same temperature, on the way up and on the way down, in random runs."""
    unit = started(make_unit)
    powers = np.random.default_rng(5).uniform(0.0, 1.5, (300, 36)) * (np.arange(300)[:, None] % 60 < 30)
    temperature, rest = advance(unit, powers, ("temperature", "rest_length")).swapaxes(0, 1)
    np.testing.assert_allclose(rest, LENGTH * (1.0 - CONTRACTION * (temperature - AMBIENT)), rtol=1e-14)
    assert np.ptp(rest) > 0.1 * LENGTH * CONTRACTION * 80.0


def test_contraction_ends_where_turns_touch(make_unit):
    unit = started(make_unit, parameters={"contraction_limit": 0.1})
    rest = advance(unit, np.full((100, 36), POWER), ("rest_length",), size=10**9)[:, 0, 0]
    assert rest[-1] == pytest.approx(0.9 * LENGTH, rel=1e-14)
    assert rest[0] > rest[-1]


@pytest.mark.parametrize("version", [3, 2])
@pytest.mark.parametrize("interface", ["co_simulation", "model_exchange"])
def test_energy_is_stored_or_convected(make_unit, version, interface):
    unit = started(make_unit, version=version, interface=interface)
    powers = np.random.default_rng(1).uniform(0.0, 1.0, (200, 36))
    energy = advance(unit, powers, ("stored_energy", "convected_energy")).sum(axis=1)
    # CVODE keeps the sum of the two states, which is linear in them, to rounding of its own error weights.
    tolerance = 1e-12 if interface == "co_simulation" else 1e-8
    np.testing.assert_allclose(energy, np.cumsum(powers, axis=0) * seconds(STEP), rtol=0.0, atol=tolerance)


def test_every_bundle_has_its_own_losses_and_resistance(make_unit):
    losses, resistances = np.linspace(2e-3, 5e-3, 36), np.linspace(1.0, 1.3, 36)
    unit = started(make_unit, parameters={"muscle_conductance": losses, "reference_resistance": resistances})
    end, resistance = advance(unit, np.full((1, 36), POWER), ("temperature", "resistance"), size=1000 * 10**9)[0]
    np.testing.assert_allclose(end - AMBIENT, POWER / (MUSCLES * losses), rtol=EXACT)
    np.testing.assert_array_equal(resistance, resistances)
