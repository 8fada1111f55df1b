"""Noise of readings that nobody stated, with what a simulation explains of them taken off."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.check.feedthrough import quieter
from diagnosis.recording.noise import estimate_noise
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel
from diagnosis.recording.series import Series

TIMES = np.arange(200.0)
NOISE = 0.3


def test_readings_at_the_end_of_the_range_are_no_small_noise_where_the_simulation_goes_on_beyond_it() -> None:
    course = 20.0 * np.sin(TIMES / 30.0)
    readings = np.minimum(course + NOISE * np.random.default_rng(1).standard_normal(200), 10.0)
    channel = Channel("coil[1].temperature", parse_quantity("coil[1].temperature"), TIMES, readings, NOISE, False)
    assert np.mean(readings == 10.0) > 0.2
    found = quieter(channel, Series(TIMES, course, False, "K"))
    # without the mask of the readings themselves: 9e-6, and each reading rejects every model
    assert found == pytest.approx(NOISE, rel=0.2)


def test_a_sensor_that_is_mostly_off_has_the_noise_of_the_readings_while_it_is_on() -> None:
    readings = np.zeros(200)
    readings[50:62] = 5.0 + 0.1 * np.random.default_rng(1).standard_normal(12)
    assert 0.03 < estimate_noise(TIMES, readings) < 0.3  # 5e-6 with the 188 zeros
