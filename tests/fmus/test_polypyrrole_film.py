"""Physics of polypyrrole_film: charging, diffusion, strain, and what the circuit sees."""

import numpy as np
import polypyrrole_twin as twin
import pytest
from fmu_runs import STEP, advance

from cosim.unit.protocol import seconds


def started(make_unit, **given):
    unit = make_unit("polypyrrole_film", **given)
    unit.initialise(0)
    return unit


def charge(rest_length):
    """Charge [C] that a length without load [m] tells."""
    return (twin.REST_LENGTH - rest_length) * twin.SECTION / (twin.LEVER * twin.STRAIN_TO_CHARGE)


@pytest.mark.parametrize("version", [3, 2])
def test_charging_follows_the_diffusion_equation(make_unit, version):
    unit = started(make_unit, version=version)
    run = advance(unit, np.ones((6000, 36)), ("rest_length",))[:, 0, 3]
    time = seconds(STEP) * np.arange(1, 6001)
    exact = twin.diffusion_charge(time, 1.0)
    # Five layers instead of a continuum: 0.4 % of the whole charge at most, after a second.
    np.testing.assert_allclose(charge(run), exact, rtol=0.0, atol=0.005 * twin.CAPACITANCE)
    assert exact[-1] == pytest.approx(twin.CAPACITANCE, rel=0.005)


def test_more_voltage_strains_in_proportion_and_the_other_sign_expands(make_unit):
    unit = started(make_unit)
    volts = np.linspace(-1.0, 1.0, 36)
    rest = advance(unit, volts[None], ("rest_length",), size=1000 * 10**9)[0, 0]
    strain = twin.STRAIN_TO_CHARGE * twin.VOLUMETRIC_CAPACITANCE * volts
    assert strain[-1] == pytest.approx(0.008)  # 0.8 % at 1 V
    np.testing.assert_allclose(rest, twin.REST_LENGTH - twin.LEVER * twin.LENGTH * strain, rtol=1e-12)


def test_the_current_ebbs_away_and_comes_back_when_shorted(make_unit):
    unit = started(make_unit)
    names = ("film_current", "rest_length")
    first = advance(unit, np.ones((1, 36)), names, size=10**6)[0, :, 0]
    assert first[0] == pytest.approx(1.0 / (twin.RESISTANCE + 0.1 * twin.FILM_RESISTANCE), rel=1e-3)
    full = advance(unit, np.ones((1, 36)), names, size=500 * 10**9, begin=10**6)[0, :, 0]
    assert abs(full[0]) < 1e-9
    back = advance(unit, np.zeros((1, 36)), names, size=10**6, begin=500 * 10**9 + 10**6)[0, :, 0]
    assert back[0] == pytest.approx(-first[0], rel=1e-3)
    empty = advance(unit, np.zeros((1, 36)), names, size=500 * 10**9, begin=500 * 10**9 + 2 * 10**6)[0, :, 0]
    assert empty[1] == pytest.approx(twin.REST_LENGTH, rel=1e-12)


def test_stiffness_is_that_of_the_films_behind_the_lever(make_unit):
    unit = started(make_unit)
    stiffness = unit.get("stiffness")[0]
    assert stiffness == pytest.approx(twin.MODULUS * twin.SECTION / twin.LENGTH / twin.LEVER**2, rel=1e-14)
    stress = 5.6 * twin.LEVER / twin.SECTION
    assert stress == pytest.approx(4.0e6, rel=0.01)  # the films stay in the measured range of load


def test_the_circuit_sees_a_constant_resistance_at_the_temperature_of_the_room(make_unit):
    resistances = np.linspace(0.1, 0.2, 36)
    unit = started(make_unit, parameters={"reference_resistance": resistances})
    unit.set("ambient_temperature", 301.0)
    run = advance(unit, np.random.default_rng(2).uniform(0.0, 1.0, (50, 36)), ("resistance", "temperature"))
    np.testing.assert_array_equal(run[:, 0], np.broadcast_to(resistances, (50, 36)))
    np.testing.assert_array_equal(run[:, 1], 301.0)


@pytest.mark.parametrize("version", [3, 2])
@pytest.mark.parametrize("interface", ["co_simulation", "model_exchange"])
def test_what_the_circuit_gives_is_stored_or_turned_into_heat(make_unit, version, interface):
    unit = started(make_unit, version=version, interface=interface)
    volts = np.random.default_rng(3).uniform(-1.0, 1.0, (200, 36))
    energy = advance(unit, volts, ("stored_energy", "convected_energy"), size=10 * STEP).sum(axis=1)
    supplied = np.cumsum(volts**2, axis=0) / twin.RESISTANCE * seconds(10 * STEP)
    # Rounding of 50 J; stored energy is a square of the charges, so CVODE's tolerance of 1e-8 enters, of some 10 C.
    tolerance = 1e-11 if interface == "co_simulation" else 2e-5
    np.testing.assert_allclose(energy, supplied, rtol=0.0, atol=tolerance)


def test_one_long_step_equals_many_short_ones(make_unit):
    volts, runs = np.linspace(-1.0, 1.0, 36), []
    for steps in (1, 1000):
        unit = started(make_unit)
        run = advance(
            unit,
            np.tile(volts, (steps, 1)),
            ("rest_length", "stored_energy", "convected_energy"),
            size=20 * 10**9 // steps,
        )
        runs.append(run[-1])
    # A thousand roundings of some ten joules.
    np.testing.assert_allclose(runs[0], runs[1], rtol=1e-12, atol=1e-11)
