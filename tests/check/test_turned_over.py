"""Readings that fall where the simulation rises, of a rig that nothing drives."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.beside import compare
from diagnosis.check.scale import sign_doubts
from diagnosis.judge.diagnosis import Verdict
from diagnosis.judge.headline import headline
from tests.diagnosis.test_pendulum_batch import made


@pytest.mark.parametrize("cause", ["column or start", "clock"])
def test_a_swing_that_nothing_drives_is_turned_over_by_three_causes(cause: str, tmp_path: Path) -> None:
    """A table and a start of the opposite sign are one in the readings, and nearly so half a swing of the clock."""
    swing = made(tmp_path / "swing", 1)
    channel = swing.channels["arm.angle"]
    values = -channel.values
    if cause == "clock":
        about = channel.values - np.mean(channel.values)
        half = int(np.diff(np.flatnonzero(np.diff(np.sign(about)))[:2])[0])
        values = np.concatenate([channel.values[half:], channel.values[-half:]])
    turned = replace(swing, channels={"arm.angle": replace(channel, values=values)})
    (found,) = sign_doubts(compare(load_scenario("pendulum"), turned))
    assert (found.kind, found.subject, found.is_serious) == ("turned", "arm.angle", True)
    assert "a start on the other side does that too, or a clock that is off by half a swing" in found.statement
    said = headline(Verdict.RECORDING_FAULT, [], None, doubts=[found])
    assert said.startswith("Sign, start or clock of a recording are not what it says: in ")
    assert "arm.angle: the readings fall where the simulation rises" in said
