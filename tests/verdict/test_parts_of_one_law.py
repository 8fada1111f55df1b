"""Several laws without a name in one FMU may describe one law, and each says so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diagnosis.faults.law import HELD
from diagnosis.judge.diagnosis import Finding, Standing
from diagnosis.judge.findings import in_parts
from diagnosis.judge.reservations import INSIDE, PARTS


def law(place: str, effect: str = "port_linear_of_nitrate", unit: str = "thermal") -> Finding:
    return Finding(
        unit,
        place,
        (place,),
        ((0.0, 40.0),),
        ("a",),
        effect,
        False,
        f"an effect without a name, {place}",
        "",
        (),
        100.0,
        1.0,
        standing=Standing.UNNAMED,
        is_accepted=True,
    )


WARMTH, LIGHT = law("tank.warmth"), law("tank.light", "input_gain", "signal")


def test_laws_without_a_name_at_two_places_of_an_fmu_may_be_one() -> None:
    for one in (WARMTH, LIGHT):
        assert in_parts(one, [WARMTH, LIGHT], ()).doubts == (PARTS,)


@pytest.mark.parametrize(
    "beside",
    [
        law("lamp.power"),
        law("tank.warmth", "port_squared_of_nitrate"),
        replace(LIGHT, standing=Standing.NAMED, is_named=True),
        law("tank.oxygen", "sensor_drift", "measurement"),
        law("tank.light (second)", HELD.identifier, "signal"),
    ],
)
def test_what_is_elsewhere_at_the_same_place_named_or_a_fault_is_no_part(beside: Finding) -> None:
    assert in_parts(WARMTH, [WARMTH, beside], ()) == WARMTH


def test_laws_of_a_network_of_coils_are_told_as_before() -> None:
    first, second = law("coil[1,2]"), law("coil[2,3]")
    assert in_parts(first, [first, second], ()) == first


def test_at_an_fmu_that_hides_its_states_a_law_without_a_name_may_be_one_inside() -> None:
    told = in_parts(WARMTH, [WARMTH], ("tank",))
    assert told.doubts == (INSIDE,)
    assert told.statement == "an effect without a name, in tank or at tank.warmth"
    assert in_parts(WARMTH, [WARMTH, LIGHT], ("tank",)).doubts == (PARTS, INSIDE)
    named = replace(LIGHT, standing=Standing.NAMED, is_named=True)
    sensor, fault = law("tank.oxygen", "sensor_drift", "measurement"), law("tank.light", HELD.identifier, "signal")
    for other in (named, sensor, fault):
        assert in_parts(other, [other], ("tank",)) == other
    assert in_parts(WARMTH, [WARMTH], ("lamp",)) == WARMTH
