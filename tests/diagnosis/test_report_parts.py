"""Parts of the report: what a network marks, how fits are grouped, how numbers read."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from diagnosis.judge.diagnosis import Verdict
from diagnosis.report.display import axis, interval, number, percent
from diagnosis.report.figures import thinned
from diagnosis.report.fits import rows, worst_first
from diagnosis.report.network import Concerned, concerned, inferred
from tests.diagnosis.report_examples import CONTACT, LAG, MASS, UNNAMED, diagnosis, fit, series


def test_a_network_is_inferred_from_names_and_findings_mark_their_place() -> None:
    told = diagnosis(Verdict.MISSING_PHYSICS)
    network = inferred(told)
    assert network.strings == (6,) * 6
    assert concerned(CONTACT, network) == Concerned(strings=frozenset({3}))
    assert concerned(MASS, network) == Concerned(coils=frozenset({(2, 5)}))
    assert concerned(LAG, network) == Concerned(coils=frozenset({(1, 2)}))
    swapped = replace(LAG, place="coil[1,2].temperature and coil[4,6].temperature")
    assert concerned(swapped, network).coils == {(1, 2), (4, 6)}
    assert concerned(replace(CONTACT, place="supply"), network) == Concerned(supply=True)
    # A place that is no element: its elements are marked; elements outside the network are not.
    assert concerned(UNNAMED, network).coils == {(s, c) for s in range(1, 7) for c in range(1, 7)}  # `all coils`
    assert not concerned(replace(MASS, place="coil[7,1]", elements=()), network)


def test_fits_are_grouped_by_recording_and_quantity() -> None:
    fits = [
        fit("coil[1,1].temperature", "K", 0.3, False),
        fit("coil[1,2].temperature", "K", 0.4, False),
        fit("coil[1,1].temperature", "K", 0.5, True),
    ]
    held_out, training = rows(fits)
    assert (held_out.is_held_out, held_out.channels, training.channels) == (True, 1, 2)
    assert training.rmse["after"] == pytest.approx(math.sqrt((0.3**2 + 0.4**2) / 2), rel=1e-12)
    assert training.spread == (0.3, 0.4)
    assert training.chi_square["recalibrated"] == pytest.approx(16.0, rel=1e-12)
    bad = replace(fits[0], chi_square={"recalibrated": 50.0})
    assert worst_first([*fits[1:], bad]) == [fits[2], bad, fits[1]]


def test_temperatures_are_shown_in_degrees_and_small_currents_in_milliamperes() -> None:
    # Exact but for the rounding of one subtraction or multiplication.
    assert axis(np.array([300.0]), "K")(np.array([300.0, np.nan]))[0] == pytest.approx(26.85, abs=1e-12)
    assert axis(np.array([0.4, np.nan]), "A").unit == "mA"
    assert axis(np.array([4.0]), "A").unit == "A"
    assert axis(np.array([0.4]), "A")(np.array([0.4]))[0] == pytest.approx(400.0, rel=1e-12)


@pytest.mark.parametrize(
    ("shown", "expected"),
    [
        (number(0.99951), "1.00"),
        (number(123456.0), "123000"),
        (number(2.0e-7), "2.00e-07"),
        (number(-math.inf), "-∞"),
        (number(math.nan), "–"),
        (interval(295.15, 295.02, 295.28, "K"), "295.15 K (295.02 to 295.28)"),
        (interval(2.1e-5, 1.9e-5, 2.3e-5, "W/K"), "2.10e-05 W/K (1.90e-05 to 2.30e-05)"),
        (interval(0.0, 0.0, 12.5, "1"), "0.0 (0.0 to 12.5)"),
        (interval(3.0, 3.0, math.inf, "s"), "3.000 s (3.000 to ∞)"),
        (percent(0.99999), "> 99.9 %"),
        (percent(0.005), "0.5 %"),
    ],
)
def test_numbers_read_well(shown: str, expected: str) -> None:
    assert shown == expected


def test_thinning_keeps_the_peaks_of_a_long_channel() -> None:
    values = np.zeros(50_000)
    values[31_234], values[777] = 5.0, -3.0
    values[100] = np.nan
    kept = thinned(values, 1000)
    assert len(kept) <= 1000
    assert {31_234, 777} <= set(kept.tolist())
    assert np.all(np.diff(kept) > 0)


def test_a_series_with_other_shapes_is_refused() -> None:
    with pytest.raises(ValueError, match="after has shape"):
        replace(series(), after=np.zeros(3))


def test_curves_that_say_the_same_are_drawn_once() -> None:
    one = series()
    assert list(replace(one, after=one.recalibrated).curves) == ["before", "recalibrated"]
    assert list(one.curves) == ["before", "recalibrated", "after"]
