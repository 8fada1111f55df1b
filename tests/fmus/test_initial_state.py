"""Every coil has its own start: temperature, place in the hysteresis loop, charge; a single value holds for all."""

import numpy as np
import pytest
import thermal_twin
from fmu_runs import STEP, advance

from cosim.unit.protocol import UnitError, seconds

CELSIUS, ROOM = 273.15, 295.15
STARTS = np.array([55.0, 48.0]) + CELSIUS
PLAIN = {"use_regressed_cooling_rate": False}
#: h A / (rho V c_p) of the paper's coil, and G / C of the default bundle of nylon [1/s].
RATES = {"thermal_stiffness": 90 * 97.85e-6 / (6450 * 7.328e-9 * 837), "tcp_muscle": 3.6e-3 / 0.0222}


def started(make_unit, model, version=3, coils=2, **parameters):
    unit = make_unit(model, version=version, coils=coils, parameters=parameters)
    unit.initialise(0)
    unit.exit_initialisation()
    return unit


@pytest.mark.parametrize("version", [3, 2])
@pytest.mark.parametrize("model", sorted(RATES))
def test_coils_that_start_apart_cool_as_their_own_exponentials(make_unit, model, version):
    own = PLAIN if model == "thermal_stiffness" else {}
    unit = started(make_unit, model, version, initial_temperature=STARTS.tolist(), **own)
    np.testing.assert_array_equal(unit.get("temperature"), STARTS)
    run = advance(unit, np.zeros((1000, 2)), ("temperature", "stored_energy", "convected_energy"))
    time = seconds(STEP) * np.arange(1, 1001)
    exact = ROOM + (STARTS - ROOM) * np.exp(-RATES[model] * time)[:, None]
    np.testing.assert_allclose(run[:, 0], exact, rtol=0.0, atol=1e-10)
    assert np.abs(run[:, 1] + run[:, 2]).max() < 1e-12  # nothing came in
    assert run[-1, 2, 0] > run[-1, 2, 1] > 0.1


@pytest.mark.parametrize("version", [3, 2])
@pytest.mark.parametrize("model", ["niti_kinetics", "tcp_muscle", "thermal_stiffness"])
def test_one_start_for_all_coils_is_that_of_every_coil(make_unit, model, version):
    outputs = ("temperature", "stiffness", "stored_energy", "convected_energy")
    powers = np.tile([0.6, 0.1], (200, 1))
    one, each = (
        advance(started(make_unit, model, version, initial_temperature=given), powers, outputs)
        for given in (330.0, [330.0, 330.0])
    )
    np.testing.assert_array_equal(one, each)


def test_coils_with_phases_start_apart_too(make_unit):
    unit = started(make_unit, "niti_kinetics", initial_temperature=STARTS.tolist())
    np.testing.assert_allclose(unit.get("temperature"), STARTS, rtol=1e-13)
    np.testing.assert_array_equal(unit.get("stored_energy"), 0.0)


def test_a_coil_starts_where_it_stood_in_its_loop(make_unit):
    place = [0.0, 0.25, 1.0]
    unit = started(
        make_unit, "thermal_stiffness", coils=3, initial_temperature=50.0 + CELSIUS, initial_loop_position=place
    )
    heating, cooling = float(thermal_twin.heating(50.0)), float(thermal_twin.cooling(50.0))
    assert cooling - heating > 50.0
    expected = heating + np.array(place) * (cooling - heating)
    np.testing.assert_allclose(unit.get("stiffness"), expected, rtol=1e-14)


def test_phases_start_where_they_stood_in_their_loop(make_unit):
    reduced = 305.0  # between both starts and finishes: 297.42 to 320.37 K rising, 278.34 to 310.37 K falling
    unit = started(
        make_unit, "niti_kinetics", coils=3, initial_temperature=reduced, initial_loop_position=[0.0, 0.5, 1.0]
    )
    heating = 0.5 - 0.5 * np.cos(np.pi * (reduced - 297.42) / (320.37 - 297.42))
    cooling = 0.5 - 0.5 * np.cos(np.pi * (reduced - 278.34) / (310.37 - 278.34))
    expected = 1.0 - np.array([heating, 0.5 * (heating + cooling), cooling])
    np.testing.assert_allclose(unit.get("martensite_fraction"), expected, rtol=1e-12)
    np.testing.assert_allclose(unit.get("temperature"), reduced, rtol=1e-13)


@pytest.mark.parametrize("model", ["niti_kinetics", "thermal_stiffness"])
def test_no_place_lies_beyond_the_loop(make_unit, model):
    with pytest.raises(UnitError, match=r"initial_loop_position\[2\] = 1.5: it must lie between 0"):
        started(make_unit, model, initial_loop_position=[0.5, 1.5])


def test_films_start_at_rest_at_their_own_voltage(make_unit):
    volts = np.array([0.0, 0.8])
    unit = started(make_unit, "polypyrrole_film", initial_voltage=volts.tolist())
    first = unit.get("rest_length").copy()
    assert first[0] - first[1] == pytest.approx(16.1 * 0.03 * 1e-10 * 8e7 * 0.8, rel=1e-12)
    held = advance(unit, np.tile(volts, (100, 1)), ("rest_length", "stored_energy", "film_current"))
    np.testing.assert_allclose(held[:, 0], np.tile(first, (100, 1)), rtol=1e-13)
    np.testing.assert_allclose(held[:, 1:], 0.0, atol=1e-11)
    shorted = advance(unit, np.zeros((100, 2)), ("stored_energy", "convected_energy"), size=10**9, begin=10**9)
    # all that was stored has left as heat: C V^2 / 2
    whole = 0.5 * 8e7 * 22.5e-6 * 0.03 * volts**2
    np.testing.assert_allclose(shorted[-1, 0], -whole, atol=1e-6)
    shunt = volts**2 / 0.12  # over the one second before
    np.testing.assert_allclose(shorted[-1, 1], shunt + whole, atol=1e-6)
