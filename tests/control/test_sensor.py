"""Sensors: the same laws as recordings have, and what delay, exposure and faults do."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.components import nanoseconds
from cosim.control.sensor import Fault, SensorDesign, SensorUnit
from cosim.unit.quantity import PhysicalValue
from diagnosis.recording.sensor import Sensor, read_with
from diagnosis.recording.series import Series

STEP = nanoseconds(PhysicalValue(20.0, "ms"))


def _readings(design: SensorDesign, values: np.ndarray) -> np.ndarray:
    """Reading after every step, of a quantity given at every communication point."""
    unit = SensorUnit("sensor", design)
    unit.set("quantity", np.full(design.size, values[0]))
    unit.initialise(0)
    found = []
    for index, value in enumerate(values):
        unit.set("quantity", np.full(design.size, value))
        unit.do_step(index * STEP, STEP)
        found.append(unit.get("reading").copy())
    return np.array(found)


def _course() -> np.ndarray:
    time = 0.02 * np.arange(201)
    return 300.0 + 20.0 * np.sin(2.0 * time) + np.where(time > 2.0, 15.0, 0.0)


def test_the_laws_are_those_of_recordings():
    """Lag, gain, bias, drift, clipping and rounding, reading by reading."""
    numbers = {
        "lag": "0.3 s",
        "gain": 1.02,
        "bias": "0.4 K",
        "drift": "0.05 K/s",
        "minimum": "290 K",
        "maximum": "330 K",
        "quantum": "0.25 K",
        "rate": "10 Hz",
        "unit": "K",
    }
    values = _course()
    series = Series(0.02 * np.arange(201), values, False, "K")
    wanted = read_with(Sensor.model_validate(numbers), series, np.random.default_rng(0))
    design = SensorDesign(
        1,
        "K",
        5 * STEP,
        lag=0.3,
        gain=np.array([1.02]),
        bias=np.array([0.4]),
        drift=0.05,
        minimum=290.0,
        maximum=330.0,
        quantum=0.25,
    )
    found = _readings(design, values)[::5, 0]
    np.testing.assert_allclose(found, wanted.values, atol=1e-9)


def test_a_delay_shifts_readings_by_itself():
    values = _course()
    plain = _readings(SensorDesign(1, "K", 5 * STEP), values)
    late = _readings(SensorDesign(1, "K", 5 * STEP, delay=8 * STEP), values)
    np.testing.assert_array_equal(late[8:], plain[:-8])
    np.testing.assert_array_equal(late[:8], np.full((8, 1), values[0]))


def test_an_exposure_reads_the_mean_up_to_its_instant():
    """Of a ramp the mean over the exposure is the value at its middle."""
    ramp = 300.0 + 0.5 * np.arange(101)
    found = _readings(SensorDesign(1, "K", 5 * STEP, exposure=3 * STEP), ramp)
    np.testing.assert_allclose(found[5::5, 0], ramp[5::5] - 0.5 * 1.5, atol=1e-9)


def test_noise_has_its_deviation_and_is_of_its_own_for_every_element():
    found = _readings(SensorDesign(50, "K", STEP, noise=0.3, seed=4), np.full(200, 300.0))
    assert abs(found.std() - 0.3) < 0.01  # 10,000 numbers: the error of a deviation is 0.7 %
    assert abs(np.corrcoef(found[:, 0], found[:, 1])[0, 1]) < 0.25
    assert len(np.unique(found)) == found.size


def test_a_frozen_sensor_keeps_its_last_reading_and_others_do_not():
    values = 300.0 + np.arange(100.0)
    design = SensorDesign(2, "K", STEP, faults=(Fault(1, 50 * STEP, None),))
    found = _readings(design, values)
    np.testing.assert_array_equal(found[:, 0], values)
    np.testing.assert_array_equal(found[50:, 1], np.full(50, values[49]))


@pytest.mark.parametrize("depth", [0, 3])
def test_a_restored_sensor_replays_exactly(depth):
    design = SensorDesign(3, "K", 2 * STEP, lag=0.1, exposure=STEP, delay=depth * STEP, noise=0.2)
    unit = SensorUnit("sensor", design)
    unit.set("quantity", np.full(3, 300.0))
    unit.initialise(0)
    course = _course()

    def steps(first: int, last: int) -> list[np.ndarray]:
        found = []
        for index in range(first, last):
            unit.set("quantity", np.full(3, course[index]))
            unit.do_step(index * STEP, STEP)
            found.append(unit.get("reading").copy())
        return found

    steps(0, 20)
    saved = unit.save()
    one = steps(20, 60)
    unit.restore(saved, 20 * STEP)
    np.testing.assert_array_equal(steps(20, 60), one)
