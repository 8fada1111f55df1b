"""A gain that is the factor between two units raises a question, and any other gain does not."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from diagnosis.judge.diagnosis import Estimate, Finding
from diagnosis.judge.unit_factors import FACTORS
from diagnosis.report.finding_section import finding_section
from diagnosis.report.unit_factor import unit_factor
from tests.diagnosis.report_examples import CONTACT


def gain(factor: float, share: float = 0.002, effect: str = "input_gain") -> Finding:
    """A gain with an interval of so many times the factor to either side."""
    estimate = Estimate("gain", "1", factor - 1.0, factor * (1.0 - share) - 1.0, factor * (1.0 + share) - 1.0)
    return replace(CONTACT, effect=effect, parameters=(estimate,))


@pytest.mark.parametrize(
    ("factor", "told"),
    [
        (3.784, "The factor is 3.784, and 1 US gallon is 3.785 l"),
        (0.2642, "The factor is 1/3.785, and 1 US gallon is 3.785 l"),
        (1.6093, "1 mile is 1.609 km"),
        (0.9145, "The factor is 0.9145, and 1 yd is 0.9144 m"),
        (0.1047, "1 rad/s is 9.549 rpm"),
        (1000.4, "prefixes of units differ by 1000"),
    ],
)
def test_a_gain_that_is_a_factor_between_units_is_told(factor: float, told: str) -> None:
    assert told in unit_factor(gain(factor))
    assert unit_factor(gain(factor)).endswith("?")
    assert told.split(",")[0] in str(finding_section(0, gain(factor)))


def test_other_gains_other_laws_and_wide_intervals_raise_no_question() -> None:
    assert unit_factor(gain(1.05)) == ""
    assert unit_factor(gain(3.9)) == ""
    assert unit_factor(gain(3.785, share=0.1)) == ""  # so wide that it holds the imperial gallon nearly too
    assert unit_factor(gain(3.785, effect="contact_resistance")) == ""
    assert unit_factor(gain(-3.785)) == ""
    none = gain(3.785)
    (estimate,) = none.parameters
    assert unit_factor(replace(none, parameters=(replace(estimate, lower=-math.inf, upper=math.inf),))) == ""


def test_factors_are_those_of_the_units() -> None:
    """Facts that a person knows, in numbers of their own: a litre, a mile, a pound, an hour, a degree."""
    assert FACTORS["1 US gallon is 3.785 l"] == pytest.approx(231 * 2.54**3 / 1000)
    assert FACTORS["1 mile is 1.609 km"] == pytest.approx(5280 * 12 * 25.4e-6)
    assert FACTORS["1 pound-force is 4.448 N"] == pytest.approx(0.45359237 * 9.80665)
    assert FACTORS["1 psi is 6.895 kPa"] == pytest.approx(0.45359237 * 9.80665 / 0.0254**2 / 1000)
    assert FACTORS["1 rad/s is 9.549 rpm"] == pytest.approx(30 / math.pi)
    assert FACTORS["1 kPa is 7.501 mmHg"] == pytest.approx(760 / 101.325, rel=1e-6)  # an atmosphere is 760 mm
    assert FACTORS["1 inHg is 3.386 kPa"] == pytest.approx(25.4 * 101.325 / 760, rel=1e-6)
    assert FACTORS["1 inch of water is 249.1 Pa"] == pytest.approx(0.0254 * 1000.0 * 9.80665, rel=1e-4)
    assert FACTORS["1 oz is 28.35 g"] == pytest.approx(453.59237 / 16)
    assert FACTORS["1 yd is 0.9144 m"] == pytest.approx(3 * 0.3048)
    assert FACTORS["1 knot is 0.5144 m/s"] == pytest.approx(1852 / 3600)
    assert FACTORS["1 nautical mile is 1.852 km"] == pytest.approx(1.852)
    assert FACTORS["1 cubic foot per minute is 1.699 m^3/h"] == pytest.approx(0.3048**3 * 60)
    assert FACTORS["1 Torr is 133.3 Pa"] == pytest.approx(101325 / 760)
    assert FACTORS["1 hp is 745.7 W"] == pytest.approx(550 * 0.3048 * 0.45359237 * 9.80665)
    for told, factor in FACTORS.items():  # the last number in the words is that factor
        number = [float(w) for w in told.split() if w.replace(".", "").isdigit()][-1]
        assert number == pytest.approx(factor, rel=5e-4), told
