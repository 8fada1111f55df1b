"""What a fault seen by the check, and faults of many sensors at once, mean for findings."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diagnosis.judge.diagnosis import ChannelFit, Doubt
from diagnosis.judge.doubts import (
    MANY,
    doubted,
    is_of_another_experiment,
    of_another_experiment,
    without_consequences,
    without_what_fits,
)
from tests.diagnosis.report_examples import CONTACT, LAG

STEP = Doubt(
    "monday", "coil[1,2].temperature", "sensor", "The readings step by 2 K.", "was it moved?", True, 0.0, 9.0, 50.0
)
FAULT = replace(
    LAG,
    effect="sensor_offset_in_interval",
    place="coil[1,2].temperature (monday)",
    recording="monday",
    channels=("coil[1,2].temperature (monday)",),
)


def test_physics_is_suggested_alone_beside_a_fault_that_nothing_explains() -> None:
    (told,) = doubted([CONTACT], [STEP])
    assert not told.is_accepted
    assert (
        told.doubts[0] == "first the fault has to be cleared: monday, coil[1,2].temperature: The readings step by 2 K"
    )


def test_physics_stands_beside_a_fault_that_was_found_too() -> None:
    fault, physics = doubted([FAULT, CONTACT], [STEP])
    assert fault.is_accepted
    assert physics.is_accepted
    other = replace(STEP, recording="tuesday")
    assert [f.is_accepted for f in doubted([FAULT, CONTACT], [other])] == [True, False]


@pytest.mark.parametrize("kind", ["odd one out", "clock"])
def test_a_recording_that_the_final_model_meets_does_not_stand_out(kind: str) -> None:
    """What it is compared with before the search are numbers that it did not help to determine."""
    doubt = replace(STEP, kind=kind, is_serious=False)
    by_after = {"before": 90.0, "recalibrated": 1.0}
    fits = [ChannelFit("monday", True, "coil[1,2].temperature", "K", {}, by_after | {"after": 1.0}, {}, samples=100)]
    assert without_what_fits([doubt], fits, []) == ()
    assert without_what_fits([replace(doubt, is_serious=True)], fits, []) != ()
    assert without_what_fits([doubt], fits, [FAULT]) == (doubt,)  # what acts there may be what stands out
    assert without_what_fits([doubt], fits, [replace(FAULT, recording="tuesday")]) == ()
    missed = [replace(fits[0], chi_square=by_after | {"after": 2.0})]
    assert without_what_fits([doubt], missed, []) == (doubt,)


def test_a_note_changes_nothing() -> None:
    assert doubted([CONTACT], [replace(STEP, is_serious=False)]) == (CONTACT,)


@pytest.mark.parametrize(("count", "is_accepted"), [(MANY - 1, True), (MANY, False)])
def test_many_faults_of_one_recording_have_one_cause(count: int, is_accepted: bool) -> None:
    many = [replace(FAULT, place=f"coil[1,{n}].temperature (monday)") for n in range(count)]
    elsewhere = replace(FAULT, recording="tuesday")
    *told, other = doubted([*many, elsewhere], [])
    assert [f.is_accepted for f in told] == [is_accepted] * count
    assert other.is_accepted


def test_suggested_faults_of_other_sensors_of_the_recording_count_too() -> None:
    """What the pump did not deliver was a balance and a heater that were off, and, not accepted, a gauge."""
    places = [f"coil[1,{n}].temperature (monday)" for n in range(MANY)]
    told = doubted([replace(FAULT, place=p, is_accepted=n > 0) for n, p in enumerate(places)], [])
    assert not any(f.is_accepted for f in told)
    again = [replace(FAULT, is_accepted=True), replace(FAULT, place=f"{FAULT.place}, again", is_accepted=False)]
    told = doubted([*again, replace(FAULT, place=places[0], is_accepted=False)], [])
    assert told[0].is_accepted  # two sensors, one of them twice


@pytest.mark.parametrize(
    ("interval", "place", "recording", "is_accepted"),
    [
        ((2.0, 7.0), "coil[1,2].temperature (monday), again", "monday", False),
        ((4.0, 6.0), "coil[1,2].temperature (monday), again", "monday", False),
        ((7.0, 9.0), "coil[1,2].temperature (monday), again", "monday", True),
        ((6.5, 9.0), "coil[1,2].temperature (monday), again", "monday", True),
        ((2.0, 7.0), "coil[1,1].temperature (monday)", "monday", True),
        ((2.0, 7.0), "coil[1,2].temperature (tuesday)", "tuesday", True),
    ],
)
def test_faults_of_one_sensor_at_the_same_time_are_pieces_of_one_course(
    interval: tuple[float, float], place: str, recording: str, is_accepted: bool
) -> None:
    """Ice grew on the blades in one recording: their speed was two drifts and a gain of its sensor."""
    first = replace(FAULT, intervals=((3.0, 7.0),))
    second = replace(FAULT, effect="sensor_drift_in_interval", place=place, recording=recording, intervals=(interval,))
    told = doubted([first, second, CONTACT], [])
    assert [f.is_accepted for f in told] == [is_accepted, is_accepted, True]
    assert any("pieces of one course" in d for d in told[0].doubts) is not is_accepted


@pytest.mark.parametrize(("count", "is_accepted"), [(MANY - 1, True), (MANY, False)])
def test_many_faults_of_one_sensor_are_pieces_of_one_course(count: int, is_accepted: bool) -> None:
    """A probe that came loose showed a share of the air from then on: a drift, an offset and a share for a while."""
    first = replace(FAULT, intervals=((7.0, 9.0),))
    others = [
        replace(FAULT, effect=f"sensor_{n}_in_interval", intervals=((float(n), n + 1.0),), is_accepted=False)
        for n in range(count - 1)
    ]
    told = doubted([first, *others], [])
    assert told[0].is_accepted is is_accepted


def test_a_sensor_that_stood_still_explains_changes_beside_the_programme() -> None:
    beside = replace(STEP, kind="programme", subject="bath.temperature")
    assert of_another_experiment(without_consequences([beside])) == [beside]
    assert of_another_experiment(without_consequences([STEP, beside])) == []
    unit = replace(STEP, kind="unit")
    assert of_another_experiment(without_consequences([STEP, beside, unit])) == [unit]


@pytest.mark.parametrize(
    ("kind", "is_other"), [("programme", True), ("unit", True), ("swapped", True), ("sensor", False), ("input", False)]
)
def test_a_fault_of_a_stretch_is_no_other_experiment(kind: str, is_other: bool) -> None:
    assert is_of_another_experiment(replace(STEP, kind=kind)) is is_other
    assert not is_of_another_experiment(replace(STEP, kind=kind, is_serious=False))


def test_a_recording_that_is_not_explained_has_no_clock_that_can_be_told() -> None:
    odd = replace(STEP, subject="all channels", kind="odd one out")
    clock = replace(STEP, subject="time", kind="clock", is_serious=False)
    assert without_consequences([odd, clock]) == [odd]
    part = replace(odd, is_serious=False)  # met in part: its clock may be what is wrong
    assert without_consequences([part, clock]) == [part, clock]
    serious, elsewhere = replace(clock, is_serious=True), replace(clock, recording="tuesday")
    assert without_consequences([odd, serious, elsewhere]) == [odd, serious, elsewhere]
