"""State, time, step and input events against closed forms, in both versions and interfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cosim.unit.protocol import NANOSECONDS, StepStatus, UnitError

both_versions = pytest.mark.parametrize("version", [2, 3])
kinds = pytest.mark.parametrize(("version", "interface"), [(2, "cs"), (2, "me"), (3, "cs"), (3, "me")])
GRAVITY, RESTITUTION = 9.81, 0.5
FIRST_IMPACT = math.sqrt(2.0 / GRAVITY)
#: CVODE at rtol 1e-8; an impact that comes late by dt shifts the height by (1 + e) v dt.
INTEGRATED = 1e-6


def run(unit, steps, size):
    for index in range(steps):
        assert unit.do_step(index * size, size).status is StepStatus.OK


def ball(time):
    """Height [m] and velocity [m/s] in closed form, and the number of impacts."""
    begin, velocity, impacts, height = 0.0, 0.0, 0, 1.0
    while True:
        flight = (velocity + math.sqrt(velocity**2 + 2 * GRAVITY * height)) / GRAVITY
        if begin + flight > time:
            t = time - begin
            return height + velocity * t - 0.5 * GRAVITY * t * t, velocity - GRAVITY * t, impacts
        velocity = RESTITUTION * (GRAVITY * flight - velocity)
        begin, height, impacts = begin + flight, 0.0, impacts + 1


@kinds
def test_the_ball_bounces_as_in_closed_form(started, version, interface):
    unit = started("ball", version, interface)
    run(unit, 12, NANOSECONDS // 10)
    height, velocity, impacts = ball(1.2)
    assert impacts == 3
    assert unit.get("impacts") == impacts
    # Co-Simulation uses the closed form itself: rounding of the times alone.
    tolerance = 1e-12 if interface == "cs" else INTEGRATED
    assert abs(unit.get("height") - height) < tolerance
    assert abs(unit.get("velocity") - velocity) < 10 * tolerance


@pytest.mark.parametrize(("version", "interface"), [(3, "cs"), (2, "me"), (3, "me")])
def test_an_event_is_reported_where_that_is_asked_for(started, version, interface):
    unit = started("ball", version, interface, report_early_return=True)
    outcome = unit.do_step(0, NANOSECONDS)
    assert outcome.status is StepStatus.EARLY_RETURN
    assert abs(outcome.time - FIRST_IMPACT * NANOSECONDS) < 100  # [ns]: CVODE's root, rounded up
    assert unit.get("velocity") > 0.0  # the event is handled
    rest = unit.do_step(outcome.time, NANOSECONDS - outcome.time)
    assert rest.status is StepStatus.EARLY_RETURN  # the second impact, at 0.903 s
    again = unit.do_step(rest.time, NANOSECONDS - rest.time)
    assert again.status is StepStatus.OK
    assert abs(unit.get("height") - ball(1.0)[0]) < INTEGRATED


def test_a_step_to_the_reported_event_ends_there(started):
    unit = started("ball", 3, "me", report_early_return=True)
    saved = unit.save()
    event = unit.do_step(0, NANOSECONDS).time
    unit.restore(saved, 0)
    assert unit.do_step(0, event).status is StepStatus.OK
    assert unit.get("impacts") == 1
    unit.release(saved)


@kinds
def test_time_events_come_exactly(started, version, interface):
    unit = started("stair", version, interface, record=["latest"])
    run(unit, 4, NANOSECONDS // 4)
    assert unit.get("count") == 3
    assert unit.get("latest") == 3 * 0.3  # to the last bit
    # 0.3 s each on stairs 0, 1, 2 and 0.1 s on stair 3; rtol 1e-8 of CVODE, which integrates constants exactly.
    assert abs(unit.get("area") - (0.3 * 1 + 0.3 * 2 + 0.1 * 3)) < 1e-9


@kinds
def test_a_time_event_at_the_end_of_a_step_is_seen_there(started, version, interface):
    unit = started("stair", version, interface, parameters={"period": 0.5})
    unit.do_step(0, NANOSECONDS)
    assert unit.get("count") == 2


@both_versions
def test_a_relay_switches_between_its_bounds(started, version):
    unit = started("relay", version, "me")
    run(unit, 20, NANOSECONDS // 10)
    # Up to 0.6 in 0.6 s, then 0.2 s each way: switched on at 0, off at 0.6, on at 0.8, ..., off at 1.8 s.
    assert unit.get("switchings") == 8
    assert not unit.get("is_on")
    assert abs(unit.get("level") - 0.4) < INTEGRATED + 1e-8


@both_versions
def test_bounds_that_practically_meet_chatter_and_that_is_said(started, version):
    unit = started("relay", version, "me", parameters={"lower": 0.5, "upper": 0.5 + 1e-11})
    with pytest.raises(UnitError, match=r"events follow each other at 0.5.* s: it chatters") as caught:
        unit.do_step(0, NANOSECONDS)
    assert abs(caught.value.time - 0.5 * NANOSECONDS) < 100


@both_versions
def test_an_input_that_jumps_is_an_event(started, version):
    unit = started("relay", version, "me")
    for index, drive in enumerate((0.0, 2.0, 2.0, 0.0, 3.0)):
        unit.set("drive", np.array(drive))
        unit.do_step(index * NANOSECONDS // 100, NANOSECONDS // 100)
    assert unit.get("crossings") == 2


@both_versions
def test_a_discrete_input_is_set_in_event_mode(started, version):
    unit = started("relay", version, "me")
    unit.do_step(0, NANOSECONDS // 10)
    unit.set("enabled", np.array(False))
    unit.do_step(NANOSECONDS // 10, NANOSECONDS // 10)
    assert abs(unit.get("level")) < INTEGRATED  # 0.1 up, 0.1 down


@both_versions
def test_a_completed_step_can_ask_for_an_event(started, version):
    unit = started("relay", version, "me", parameters={"reports": 0.25})
    run(unit, 5, NANOSECONDS // 10)
    assert unit.get("step_events") == 1
    assert abs(unit.get("level") - 0.5) < INTEGRATED


def test_the_tolerance_reaches_the_integrator(started):
    errors = []
    for tolerance in (1e-4, 1e-9):
        unit = started("ball", 2, "me", tolerance=tolerance, start={"height": 100.0})
        unit.set("push", np.array(3.0))
        run(unit, 3, NANOSECONDS)
        errors.append(abs(unit.get("height") - (100.0 - 0.5 * (GRAVITY - 3.0) * 9.0)))
    assert errors[1] < 1e-6  # 100 m at 1e-9, a few steps
    assert 1e-4 < errors[0] < 1e-1  # 100 m at 1e-4, a few steps
