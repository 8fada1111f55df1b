"""Two faults of one input at the same time are one course that it had, and neither is reported as what happened."""

from dataclasses import replace

from diagnosis.faults.law import HELD, INPUT, OFFSET
from diagnosis.judge.diagnosis import Finding
from diagnosis.judge.findings import one_course


def finding(effect, name, place="pump.valve (second)", recording="second", interval=(10.0, 40.0)):
    return Finding(
        "measurement",
        place,
        (place,),
        (interval,),
        ("a",),
        effect,
        True,
        f"{name}, {place}",
        "",
        (),
        100.0,
        1.0,
        recording=recording,
    )


STAYED = finding(HELD.identifier, HELD.name)
SHARE = finding(INPUT.identifier, INPUT.name, interval=(20.0, 30.0))


def test_what_overlaps_is_told_as_another_input() -> None:
    one, other = (one_course(f, [STAYED, SHARE]) for f in (STAYED, SHARE))
    assert one.statement == "input that was another than stated for a while, pump.valve (second)"
    assert other.statement == one.statement
    assert "a course of its own" in one.doubts[-1]
    assert "a course of its own" in other.doubts[-1]
    assert one.is_named


def test_what_is_of_other_times_inputs_or_recordings_keeps_its_name() -> None:
    later = replace(SHARE, intervals=((50.0, 60.0),))
    elsewhere = replace(SHARE, place="pump.speed (second)")
    other_day = replace(SHARE, recording="first")
    sensor = finding(OFFSET.identifier, OFFSET.name)
    for beside in (later, elsewhere, other_day, sensor):
        assert one_course(STAYED, [STAYED, beside]) == STAYED
    assert one_course(sensor, [STAYED, sensor]) == sensor
