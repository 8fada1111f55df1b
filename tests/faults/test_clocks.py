"""Clocks beside a recalibrated coil network, which compares the last readings of each channel alone."""

from __future__ import annotations

from dataclasses import replace

from diagnosis.check.beside import compare
from diagnosis.clocks import clocks_once_recalibrated
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.refitted import Refitted
from tests.faults.rig import NAMES, laws, recorded, scenario


def test_a_late_clock_is_told_also_where_the_first_readings_are_not_compared(tmp_path):
    made = scenario(tmp_path)
    first, second = recorded(made, 4)
    third = replace(first, title="third")
    every = [compare(made, r) for r in (first, second, third)]
    model, judge = CoilNetworkModel(made, [first, second], laws()), CoilNetworkModel(made, [third], laws())
    assert clocks_once_recalibrated(Refitted(model, judge, every)) == []
    late = third.channels[NAMES[0]]
    shifted = replace(third, channels={**third.channels, NAMES[0]: replace(late, times=late.times + 15.0)})
    every[2] = compare(made, shifted)
    judge = CoilNetworkModel(made, [shifted], laws())
    (told,) = clocks_once_recalibrated(Refitted(model, judge, every))
    assert (told.recording, told.subject) == ("third", NAMES[0])
    assert "15" in told.statement
    assert "ahead" in told.statement
