"""Units of columns: what is read as something that nobody means is refused, with what to write instead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from diagnosis.recording.units import WrongUnit, conversion_of_difference, conversion_of_reading
from tests.diagnosis.test_recording import TIMES, folder

TRAPS = [
    ("px", "m", "unit of screens and print", "`unit: mm` with `factor`"),  # pint: 1/96 inch
    ("pixel", "m", "unit of screens and print", "`unit: mm` with `factor`"),
    ("kpx", "m", "unit of screens and print", "`unit: mm` with `factor`"),
    ("point", "m", "unit of screens and print", "`unit: mm` with `factor`"),
    ("C", "K", "`C` is read as coulomb", "write `degC`"),
    ("F", "K", "`F` is read as farad", "write `degF`"),
    ("deg", "K", "`deg` is read as degree", "write `degC`"),
    ("k", "K", "boltzmann", "write `K`"),
    ("R", "K", "molar gas constant", "converts to K"),
    ("oC", "K", "not a unit", "write `degC`"),
    ("Kelvin", "K", "not a unit", "write `kelvin`"),
    ("delta_degC", "K", "a difference of temperatures", "write `degC`"),
    ("m", "s", "`m` is read as meter", "write `min`"),
    ("H", "s", "henry", "write `h`"),
    ("S", "s", "siemens", "write `s`"),
    ("Ms", "s", "megasecond", "write `ms`"),
    ("Mm", "m", "megameter", "write `mm`"),
    ("c", "m", "speed of light", "converts to m"),
    ("Ohm", "ohm", "not a unit", "write `ohm`"),
    ("g", "N", "gram", "write `gf`"),
    ("dBm", "W", "logarithmic", "convert the column to W"),
    ("%", "W", "percent", "with `factor`"),
    ("counts", "V", "count", "with `factor`"),
    ("%", "rad", "no unit of an angle", "rad, deg or turn"),
    ("sr", "rad", "no unit of an angle", "rad, deg or turn"),
    ("Hz", "rad/s", "no unit of an angle per time", "rad/s, deg/s or rpm"),
]


@pytest.mark.parametrize(("unit", "target", "problem", "remedy"), TRAPS, ids=[f"{u}-{t}" for u, t, _, _ in TRAPS])
def test_a_unit_that_is_read_as_something_else_is_refused_with_what_to_write(unit, target, problem, remedy):
    with pytest.raises(WrongUnit) as caught:
        conversion_of_reading(unit, target)
    assert problem in str(caught.value)
    assert remedy in caught.value.remedy


@pytest.mark.parametrize(
    ("unit", "target", "factor", "offset"),
    [
        ("degC", "K", 1.0, 273.15),
        ("degF", "K", 5.0 / 9.0, 255.372222222222),
        ("mK", "K", 1e-3, 0.0),
        ("°C", "K", 1.0, 273.15),
        ("mm", "m", 1e-3, 0.0),
        ("in", "m", 0.0254, 0.0),
        ("min", "s", 60.0, 0.0),
        ("h", "s", 3600.0, 0.0),
        ("deg", "rad", np.pi / 180.0, 0.0),
        ("turn", "rad", 2.0 * np.pi, 0.0),
        ("rpm", "rad/s", np.pi / 30.0, 0.0),
        ("1/s", "rad/s", 1.0, 0.0),
        ("deg/s", "rad/s", np.pi / 180.0, 0.0),
        ("Mohm", "ohm", 1e6, 0.0),
        ("", "1", 1.0, 0.0),
    ],
)
def test_units_that_people_mean_are_taken(unit, target, factor, offset):
    assert conversion_of_reading(unit, target) == pytest.approx((factor, offset), rel=1e-12)


def test_a_unit_that_only_the_fmu_knows_is_taken_as_it_is_written_there():
    assert conversion_of_reading("N.m/rad", "N.m/rad") == (1.0, 0.0)
    with pytest.raises(WrongUnit) as caught:
        conversion_of_reading("mm", "N.m/rad")
    assert caught.value.remedy == "give a unit that converts to N.m/rad"


def test_a_difference_of_temperatures_may_be_written_either_way():
    assert conversion_of_difference("degC", "K") == conversion_of_difference("delta_degC", "K") == 1.0
    with pytest.raises(WrongUnit, match="screens"):
        conversion_of_difference("px", "m")


def test_a_factor_per_channel_scales_the_column_into_its_unit(tmp_path):
    pixels = np.round(100.0 + 10.0 * np.sin(TIMES), 1)
    channels = {
        "coil[1].extension": {
            "column": "T",
            "unit": "mm",
            "factor": -0.12,
            "noise": "0.05 mm",
            "maximum": "-11 mm",
            "invalid": [100.0],
        }
    }
    found = load_recording(folder(tmp_path, {"time": TIMES, "T": pixels}, channels=channels)).channels[
        "coil[1].extension"
    ]
    np.testing.assert_allclose(found.values, -0.12e-3 * pixels[pixels != 100.0], rtol=1e-12)
    assert found.dropped == {"invalid": int(np.sum(pixels == 100.0))}  # as the column has it, not as it is scaled
    assert found.deviation == pytest.approx(5e-5, rel=1e-12)
    np.testing.assert_array_equal(found.is_clipped, -0.12 * pixels[pixels != 100.0] >= -11.0)


@pytest.mark.parametrize(
    ("keys", "key", "text"),
    [
        ({"unit": "px"}, "channels.coil[1].extension.unit", "screens and print"),
        ({"unit": "mm", "noise": "2 px"}, "channels.coil[1].extension.noise.unit", "screens and print"),
        ({"unit": "mm", "maximum": "200 px"}, "channels.coil[1].extension.maximum", "screens and print"),
        ({"unit": "mm", "noise": 0.3}, "channels.coil[1].extension.noise", "0.3 has no unit"),
        ({"unit": "mm", "factor": 0}, "channels.coil[1].extension.factor", "leaves nothing"),
        ({"unit": "mm", "factor": float("inf")}, "channels.coil[1].extension.factor", "leaves nothing"),
        ({"unit": "mm", "minimum": "9 mm", "maximum": "1 mm"}, "channels.coil[1].extension.maximum", "not above"),
    ],
)
def test_a_wrong_unit_anywhere_in_a_channel_is_one_error_that_names_the_key(tmp_path, keys, key, text):
    path = folder(tmp_path, channels={"coil[1].extension": {"column": "T", **keys}})
    with pytest.raises(InputError) as caught:
        load_recording(path)
    assert caught.value.key == key
    assert text in str(caught.value)


@pytest.mark.parametrize(("unit", "text"), [("V", "V cannot be converted to W"), ("px", "screens"), ("%", "percent")])
def test_an_input_in_a_wrong_unit_is_named_by_its_key(tmp_path, unit, text):
    path = folder(tmp_path, inputs={"drive.power_1": {"column": "T", "unit": unit}})
    with pytest.raises(InputError) as caught:
        scenario_of(load_scenario("tclab"), load_recording(path))
    assert caught.value.key == "inputs.drive.power_1.unit"
    assert text in str(caught.value)


def test_an_end_between_two_outputs_says_to_leave_it_out(tmp_path):
    made = load_recording(folder(tmp_path))
    base = load_scenario("tclab")
    step = base.time.output_step.to("s")
    off = replace(made, overrides={"time": {"stop": f"{10.5 * step:g} s"}})
    with pytest.raises(InputError) as caught:
        scenario_of(base, off)
    assert "must be a multiple of output_step" in caught.value.problem
    assert "leave time.stop out" in caught.value.remedy
    ended = scenario_of(base, replace(made, overrides={}, end=10.5 * step))  # as it is told to do
    assert ended.time.stop.to("s") == pytest.approx(base.time.start.to("s") + 11.0 * step)
