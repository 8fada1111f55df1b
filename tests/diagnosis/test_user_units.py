"""Values in the units that the user wrote, and what a recalibration moved."""

import io
import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from rich.console import Console

from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.judge.diagnosis import Adequacy, Estimate, Left, Physical, Verdict
from diagnosis.judge.headline import what_stays
from diagnosis.judge.location import Remainder
from diagnosis.judge.plausibility import implausible
from diagnosis.judge.remainder import remainders
from diagnosis.judge.standing import unidentified
from diagnosis.models.coil_network.term_at import physical
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, load_recording
from diagnosis.report.display import moved, parameter_words, user_interval, user_unit, user_value
from diagnosis.report.json_file import write_json
from diagnosis.report.page import write_html
from diagnosis.report.summary import print_summary
from diagnosis.report.undecided import remainder
from diagnosis.report.user_units import Units, units_of, written_units
from diagnosis.search.problem import Layout, Term, TermParameter
from tests.diagnosis.report_examples import CONTACT, diagnosis, fit


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


MINE = Units(("degC", "mA", "mm", "min"))


@pytest.mark.parametrize(
    ("estimate", "told"),
    [
        (Estimate("gap", "m", 3.1e-4, 2.8e-4, 3.4e-4), "0.310 mm (0.280 to 0.340)"),
        (Estimate("limit", "A", 0.25, 0.24, 0.26), "250 mA (240 to 260)"),
        (Estimate("tau", "s", 90.0, 60.0, 120.0), "1.50 min (1.00 to 2.00)"),
        (Estimate("step_size", "K", 2.0, 1.0, 3.0), "2.00 K (1.00 to 3.00)"),
        (Estimate("onset", "K", 300.15, 299.15, 301.15, is_reading=True), "27.0 °C (26.0 to 28.0)"),
        (Estimate("bias", "1", 0.05, 0.04, 0.06, physical=Physical("K", 0.5, 0.4, 0.6)), "0.500 K (0.400 to 0.600)"),
        (Estimate("rise", "ohm/A^2", 5.0, 4.0, 6.0), "5.00 ohm/A^2 (4.00 to 6.00)"),  # 0.000005 ohm/mA^2
    ],
)
def test_parameters_are_shown_in_the_units_of_the_recording(estimate, told):
    assert MINE.estimate(estimate) == told


def test_reasons_are_told_in_the_units_of_the_recording():
    gap = TermParameter("gap", "m", 0.0, 0.005, (1e-4,), plausible=0.002, plausible_reason="it hangs loose")
    term = Term("backlash", "coil[1,1]", "mechanical", (gap,))
    fit = SimpleNamespace(point=SimpleNamespace(terms={term: (0.005,)}))
    (bound,) = unidentified(term, fit, (Estimate("gap", "m", 0.005, 0.0049, 0.005),), MINE)
    assert bound == "gap = 5.00 mm (4.90 to 5.00) lies at its bound, 5.00 mm"
    (size,) = implausible(term, (0.005,), MINE)
    assert size == "gap would have to be 5 mm; 2 mm is the most that is believed (it hangs loose)"
    bias = TermParameter("bias", "1", -5.0, 5.0, (0.1,), plausible=1.0, plausible_reason="x", physical=(1e-3, 0.0, "m"))
    told = Estimate("bias", "1", 5.0, 4.0, 5.0, physical=Physical("m", 5e-3, 4e-3, 5e-3))
    off = Term("sensor_bias", "coil[1,1].extension", "measurement", (bias,))
    fit = SimpleNamespace(point=SimpleNamespace(terms={off: (5.0,)}))
    assert unidentified(off, fit, (told,), MINE) == ("bias = 5.00 mm (4.00 to 5.00) lies at its bound, 5.00 mm",)
    assert implausible(off, (5.0,), MINE)[0].startswith("bias would have to be 5 mm; 1 mm is the most")


def test_what_is_left_is_told_in_the_units_of_the_recording():
    left = Remainder("string[1].current", 60.0, 90.0, 7.7, 4.9, "A", -0.0123)
    assert remainder(left, MINE) == (
        "string[1].current, 1.00 to 1.50 min: -12.3 mA on average, standardised sum of residuals at least 7.70; white "
        "noise alone stays below 4.90 in 99 of 100 recordings"
    )
    plain = Remainder("every temperature", 60.0, 90.0, 7.7, 4.9)
    assert remainder(plain).startswith(
        "every temperature, 60.0 to 90.0 s: standardised sum of residuals at least 7.70;"
    )


def test_terminal_and_page_show_the_units_of_the_recording_and_the_file_stays_in_si(tmp_path):
    play = Estimate("gap", "m", 3.1e-4, 2.8e-4, 3.4e-4, "play of the pin, from end to end")
    found = replace(diagnosis(Verdict.MISSING_PHYSICS), units=MINE.written)
    found = replace(found, findings=(replace(CONTACT, parameters=(play,)),))
    stream = io.StringIO()
    print_summary(found, Console(file=stream, width=160))
    assert "gap = 0.310 mm (0.280 to 0.340), play of the pin, from end to end" in stream.getvalue()
    assert "5.00 to 42.5 s" not in stream.getvalue()
    assert "0.708 min" in stream.getvalue()
    write_html(found, [], tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "0.310 mm (0.280 to 0.340)" in page
    assert "play of the pin, from end to end" in page
    write_json(found, tmp_path / "diagnosis.json")
    (kept,) = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))["findings"][0]["parameters"]
    assert (kept["value"], kept["unit"]) == (3.1e-4, "m")


def test_a_recording_knows_the_units_that_were_written():
    monday = load_recording(Path("docs/examples/rig/monday"))
    assert written_units([monday]).written == ("degC", "mm", "mA", "s")


def test_what_is_left_has_the_unit_of_its_channel():
    times = np.arange(40.0)
    target = parse_quantity("string[1].current")
    channel = Channel("string[1].current", target, times, np.zeros(40), 2e-3, True)
    residuals = np.random.default_rng(3).standard_normal(40) * 0.1
    residuals[10:22] += 5.0  # 5 deviations of 2 mA for 12 readings
    layout = Layout(np.zeros(40), times, ("string[1].current",), ("electrical",))
    (left,) = remainders(residuals, layout, {}, [channel])
    assert (left.unit, left.begin, left.end) == ("A", 10.0, 21.0)
    assert left.mean == pytest.approx(0.01, abs=2e-4)


def test_the_bias_of_a_sensor_is_a_quantity_of_its_channel():
    bias, drift = (next(p for p in candidate(n).parameters if p.name == n[7:]) for n in ("sensor_bias", "sensor_drift"))
    own = [SimpleNamespace(quantity="temperature", channel=SimpleNamespace(unit="K"))]
    assert physical(bias, own) == (10.0, 0.0, "K")
    assert physical(drift, own) == (pytest.approx(1.0 / 6.0), 0.0, "K/s")
    ceiling = next(p for p in candidate("sensor_clipping").parameters if p.name == "ceiling")
    assert physical(ceiling, own) == (10.0, 295.15, "K")
    assert physical(bias, []) is None
    assert physical(candidate("open_coil").amplitude, own) is None


def test_every_number_of_a_law_says_what_it_is():
    numbers = [(law.identifier, p) for law in catalogue() for p in law.parameters if not p.is_fixed]
    assert len(numbers) > 600
    for law, parameter in numbers:
        assert parameter.meaning, f"{law}.{parameter.name}"
        if parameter.unit == "1":  # 0.8 may be what is left, what is lost, or what is added
            assert any(kind in parameter.meaning for kind in ("share", "factor", "change")), f"{law}.{parameter.name}"


def test_two_channels_of_one_kind_are_each_shown_in_their_own_unit(tmp_path: Path) -> None:
    """A motor in rpm and a gyro in deg/s are both rad/s: errors, noise and axes of each are in what its column has."""
    fits = tuple(fit(name, "rad/s", 2.0, True) for name in ("joint.motor", "joint.arm"))
    told = replace(
        diagnosis(Verdict.MISSING_PHYSICS),
        fit=fits,
        units=("rpm", "deg/s", "s"),
        channel_units={"joint.motor": "rpm", "joint.arm": "deg/s"},
    )
    units = units_of(told)
    assert units.of("joint.arm (second)").text(1.0, "rad/s") == "57.3 deg/s"
    assert units.of("joint.motor").text(1.0, "rad/s") == "9.55 rpm"
    assert units.of("joint.elsewhere").text(1.0, "rad/s") == "9.55 rpm"  # no channel: the first that was written
    write_html(told, [], tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "joint.arm [deg/s]" in page
    assert "joint.motor [rpm]" in page
    assert "joint.arm [rpm]" not in page
    console = Console(record=True, width=200, file=io.StringIO())
    print_summary(told, console, "report.html")
    shown = console.export_text()
    assert re.search(r"joint arm: RMSE .* deg/s", shown)
    assert re.search(r"joint motor: RMSE .* rpm", shown)


def test_what_stays_is_in_the_unit_of_its_channel() -> None:
    worst = Left("third", "joint.arm", "rad/s", 0.02, 0.01, 4.0, 1.2)
    chi = {"before": 5.0, "recalibrated": 4.0, "after": 4.0}
    right = Adequacy("held-out recordings", True, chi, 1.2, 0.1, 0.1, worst, (1, 1), (), 0, True, True, True, False)
    units = Units(("rpm", "deg/s"), (("joint.motor", "rpm"), ("joint.arm", "deg/s")))
    assert what_stays(right, units).startswith("1.1 deg/s of joint.arm stays")
