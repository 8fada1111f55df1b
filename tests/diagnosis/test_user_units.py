"""Values in the units that the user wrote, and what a recalibration moved."""

import pytest

from diagnosis.report.display import moved, parameter_words, user_interval, user_unit, user_value


@pytest.mark.parametrize(
    ("value", "unit", "preferred", "is_difference", "told"),
    [
        (0.0015, "m", "mm", False, "1.50 mm"),
        (295.15, "K", "degC", False, "22.0 °C"),
        (1.6, "K", "degC", True, "1.60 K"),
        (1.0, "K", "degF", True, "1.80 °F"),
        (0.0123, "A", "mA", False, "12.3 mA"),
        (0.1, "kg", "g", False, "100 g"),
        (90.0, "s", "min", False, "1.50 min"),
        (0.37, "1", "", False, "0.370"),
        (0.37, "m/N", "mm/N", False, "370 mm/N"),
        (2.0, "m", "degC", False, "2.00 m"),  # what does not fit is told in SI
        (2.0, "m", "no unit", False, "2.00 m"),
    ],
)
def test_a_value_is_told_in_the_unit_that_was_written(value, unit, preferred, is_difference, told):
    assert user_value(value, unit, preferred, is_difference) == told


def test_an_interval_is_converted_as_a_whole():
    assert user_interval(3.1e-4, 2.8e-4, 3.4e-4, "m", "mm") == "0.310 mm (0.280 to 0.340)"
    assert user_interval(300.15, 299.15, 301.15, "K", "degC") == "27.0 °C (26.0 to 28.0)"
    assert user_interval(2.0, 1.0, 3.0, "K", "degC", is_difference=True) == "2.00 K (1.00 to 3.00)"


@pytest.mark.parametrize(
    ("unit", "written", "wanted"),
    [
        ("K", ["mm", "degC"], "degC"),
        ("m/N", ["mm"], "mm/N"),
        ("K/s", ["degC", "min"], "K/min"),
        ("m^2", ["mm"], "mm^2"),
        ("N*s/m", ["g", "mm"], "N*s/mm"),
        ("W/K", ["mA", "degC"], "W/K"),
        ("1", ["mm", "deg"], "1"),
        ("rad", ["deg"], "deg"),
        ("A", ["mA", "A"], "mA"),  # the first that was written
    ],
)
def test_the_unit_is_chosen_by_what_was_written_elsewhere(unit, written, wanted):
    assert user_unit(unit, written) == wanted


def test_what_was_moved_says_factor_or_change():
    assert moved("capacity", 3.82, True, "J/K") == "heat capacity: 3.82 times the scenario's value"
    assert moved("transformation_shift", 1.6, False, "K") == "transformation temperature: +1.60 K"
    assert moved("coil[2,2].transformation_shift", -0.51, False, "K", "degC") == (
        "transformation temperature of coil[2,2]: -0.510 K"
    )
    assert moved("ambient_offset of recording 2", 0.4, False, "K") == "room temperature of recording 2: +0.400 K"
    assert moved("bias of depth", 2e-4, False, "m", "mm") == "bias of depth: +0.200 mm"


def test_a_lag_is_no_multiple_of_a_value_in_the_scenario():
    assert moved("lag of every temperature", 2.1, True, "s") == "lag of every temperature: 2.10 times what was assumed"


def test_a_name_from_outside_is_told_without_control_characters():
    assert parameter_words("arm.central_inertia\x1b[2J") == "arm.central inertia [2J"
    assert parameter_words("gain of supply.current") == "gain of supply.current"
    assert parameter_words("heater.specific_heat") == "specific heat of heater"
