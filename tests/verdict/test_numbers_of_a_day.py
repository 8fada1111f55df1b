"""What is reported of a day is how far its number is from what was written down, whoever learned which part of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.adequacy import met, moved_day
from diagnosis.judge.unfitted import HeldOutReadings
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Own, Parameter, Point
from diagnosis.search.shares import own_label
from tests.search.line_model import TIME
from tests.verdict.lines import NOISE, Lines

#: Deviation of what all recordings share of the room, and of what each has of its own.
SHARED, OWN = 0.4, 0.3


class Rooms(Lines):
    """A line above a room that is not known: signal = room + own part + slope t."""

    def __init__(self, truth: Array, seed: int = 0) -> None:
        super().__init__(truth, seed)
        alone = Own("room", 0)
        names = (("room", SHARED, None), ("slope", 1.0, None), (own_label(alone), OWN, alone))
        self.parameters = [Parameter(n, "K", 0.0, d, False, own=own) for n, d, own in names]

    def signal(self, point: Point) -> Array:
        shared, slope, own = point.base
        return np.asarray(SHARED * shared + slope * TIME + OWN * own)

    def base_jacobian(self, point: Point) -> Array:
        return -np.stack([SHARED + 0.0 * TIME, TIME, OWN + 0.0 * TIME], axis=1) / NOISE


@pytest.mark.parametrize("room", [0.8, 0.35, -0.5])
def test_the_whole_of_it_is_told(room: float) -> None:
    flat = np.zeros_like(TIME)
    judge = Rooms(flat + room)
    readings = HeldOutReadings(judge, Rooms(flat), [Recording(Path("tuesday"), "tuesday", {}, (), {}, 1.0, 0.0)])
    # other recordings have taught that the room is 0.3 K warmer than written down
    predicted = readings.predict(Point(np.array([0.3 / SHARED, 0.0, 0.0])))
    (told,) = moved_day(predicted, judge.parameters, ["tuesday"])
    assert told.name == "room of recording tuesday"
    assert told.amount == pytest.approx(room, abs=0.02)
    assert told.deviations == pytest.approx(told.amount / np.hypot(SHARED, OWN))
    assert predicted.prior == pytest.approx(((told.amount - 0.3) / OWN) ** 2)  # its price is that of its own part


def test_every_reading_counts_in_how_a_channel_is_met() -> None:
    flat = np.zeros_like(TIME)
    judge = Rooms(flat)
    judge.measured[[50, 150, 250]] += 40.0 * NOISE
    readings = HeldOutReadings(judge, Rooms(flat), [Recording(Path("tuesday"), "tuesday", {}, (), {}, 1.0, 0.0)])
    predicted = readings.predict(Point(np.zeros(3)))
    (found,) = met(predicted, readings.readings)
    assert readings.readings.is_wild.sum() == 3
    assert (found.recording, found.channel, found.samples) == ("tuesday", "signal", len(TIME))
    assert found.rmse == pytest.approx(NOISE * np.sqrt(np.mean(predicted.residuals**2)))
    assert found.rmse > 3.0 * NOISE
