"""A clock that is early by less than a row of a recorded input is no clock with a name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import parse_scenario
from diagnosis.judge.diagnosis import Estimate, Standing
from diagnosis.judge.within_rows import longest_row, within_rows
from diagnosis.recording.recording import Input, Recording
from tests.diagnosis.report_examples import CONTACT

SCENARIO = """
title: Two programmes
time: {start: 0 s, stop: 100 s, macro_step: 1 s, output_step: 1 s}
components:
  drive:
    kind: programme
    outputs:
      held: {unit: V, constant: 0 V}
      joined: {unit: V, points: [[0 s, 0 V], [100 s, 1 V]], interpolation: linear}
connections: []
"""
ROW = 5.0


def recording(output="held", times=None, values=None):
    times = np.arange(0.0, 100.0, ROW) if times is None else np.asarray(times)
    values = np.arange(len(times)) % 3.0 if values is None else np.asarray(values)
    recorded = Input("drive", output, "V", times, values)
    return Recording(
        path=Path("r"), title="first", channels={}, inputs=(recorded,), overrides={}, end=100.0, switch_margin=0.0
    )


@pytest.fixture(scope="module")
def scenario():
    return parse_scenario(SCENARIO, Path("two.yaml"))


def clock(offset, effect="sensor_clock_offset"):
    return replace(
        CONTACT,
        unit="measurement",
        place="tank.level",
        effect=effect,
        statement="clock of a sensor, tank.level",
        parameters=(Estimate("offset", "s", offset, offset - 0.1, offset + 0.1),),
        standing=Standing.NAMED,
    )


def test_readings_that_come_early_by_less_than_a_row_have_no_name(scenario):
    (found,) = within_rows([clock(-3.0)], scenario, [recording()])
    assert found.standing is Standing.UNNAMED
    assert not found.is_named
    assert found.statement == "an effect without a name (described as: clock of a sensor), tank.level"
    assert "rows of drive.held in first are 5 s apart" in found.doubts[-1]


@pytest.mark.parametrize(
    ("found", "own"),
    [
        (clock(3.0), recording()),  # a response that comes late is not made by rows
        (clock(-5.5), recording()),  # earlier than a row
        (clock(-3.0, "sensor_lag"), recording()),
        (clock(-3.0), recording("joined")),  # straight lines join its rows
        (clock(-3.0), recording(values=np.ones(20))),  # it does not change
        (clock(-3.0), recording(times=[0.0, 20.0, 60.0], values=[0.0, 1.0, 0.0])),  # instants of switches, no samples
        (clock(-3.0), recording(times=np.cumsum([1.0, 9, 2, 30, 1, 12, 4, 20, 3, 8, 1, 6]))),  # the same, many
    ],
)
def test_what_rows_do_not_make_keeps_its_name(scenario, found, own):
    assert within_rows([found], scenario, [own]) == (found,)


def test_the_longest_rows_count_and_an_effect_without_a_name_gets_the_doubt_alone(scenario):
    fine = recording(times=np.arange(0.0, 100.0, 1.0))
    row = longest_row(scenario, [fine, recording()])
    assert row is not None
    assert row.length == ROW
    nameless = replace(clock(-3.0), standing=Standing.UNNAMED, statement="something")
    (found,) = within_rows([nameless], scenario, [fine, recording()])
    assert found.statement == "something"
    assert len(found.doubts) == len(nameless.doubts) + 1
