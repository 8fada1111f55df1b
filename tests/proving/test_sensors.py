"""Sensors against what their faults mean."""

from dataclasses import replace

import numpy as np
import pytest

from evaluation.proving.effects.effect import Place
from evaluation.proving.effects.measurement import (
    Clipping,
    ClockOffset,
    CurrentPickup,
    Gain,
    Lag,
    WrongIdentity,
    drawn_fault,
)
from evaluation.proving.rig import DataSheet
from evaluation.proving.sensors import KINDS, channel_names, drawn_sensors, read
from evaluation.proving.truth import Trace

SHEET = DataSheet(strings=(1, 1))
TIME = np.linspace(0.0, 60.0, 601)
STEPS = TIME.size - 1


def trace(temperature, current=None):
    """Two coils with given courses."""
    amperes = np.zeros((STEPS, 2, 2)) if current is None else current
    flows = {"current": amperes, "string": amperes, "supply": amperes.sum(axis=2, keepdims=True)}
    return Trace(TIME, {"temperature": temperature, "extension": np.zeros((STEPS + 1, 2))}, flows, np.zeros((STEPS, 2)))


def perfect(kind="temperature"):
    sensors = drawn_sensors(KINDS[kind], SHEET, np.random.default_rng(1))
    for array in (sensors.lag, sensors.gain, sensors.bias, sensors.delay):
        array[:] = 0.0
    sensors.dropouts = sensors.outliers = sensors.jitter = 0.0
    return sensors


RAMP = np.stack([300.0 + 0.5 * TIME, 310.0 - 0.1 * TIME], axis=1)


def place(*channels):
    return Place("channel", (), np.zeros(0), channels)


def test_a_perfect_sensor_adds_its_noise_and_rounds():
    sensors = perfect()
    seen = read(sensors, trace(np.repeat(RAMP[:1], STEPS + 1, axis=0)), 60.0, np.random.default_rng(2))
    assert seen.clean == pytest.approx(np.broadcast_to(RAMP[0], seen.clean.shape), rel=1e-14)
    # 242 readings: the deviation of their deviation is 4.5 %; rounding to 0.1 K adds 0.03 K in squares.
    assert (seen.values - seen.clean).std() == pytest.approx(np.hypot(sensors.noise, 0.1 / np.sqrt(12.0)), rel=0.15)
    assert seen.values / 0.1 == pytest.approx(np.round(seen.values / 0.1), abs=1e-6)


def test_lag_follows_a_ramp_at_its_time_constant():
    sensors = perfect()
    Lag(place("coil[1,1].temperature"), {"lag_time": 2.0}).spoil(sensors)
    clean = read(sensors, trace(RAMP), 60.0, np.random.default_rng(2)).clean
    stamps = np.arange(0.0, 60.25, 0.5)
    assert clean[:, 0] == pytest.approx(RAMP[0, 0] + 0.5 * (stamps - 2.0 * (1.0 - np.exp(-stamps / 2.0))), rel=1e-12)
    assert clean[:, 1] == pytest.approx(RAMP[0, 1] - 0.1 * stamps, rel=1e-12)


def test_lag_of_a_current_that_jumps_is_an_exponential():
    current = np.zeros((STEPS, 2, 2))
    current[100:] = 0.4  # from 10 s on
    sensors = perfect("string")
    sensors.lag[:] = 1.5
    clean = read(sensors, trace(RAMP, current), 60.0, np.random.default_rng(2)).clean
    stamps = np.arange(0.0, 60.1, 0.25)
    exact = 0.4 * (1.0 - np.exp(-np.maximum(stamps - 10.0, 0.0) / 1.5))
    # Between two knots 0.1 s apart the exponential is read off a straight line: (0.1/1.5)^2 / 8 of 0.4 A.
    assert np.abs(clean[:, 0] - exact).max() < 3e-4


def test_a_late_clock_shows_what_was():
    sensors = perfect()
    ClockOffset(place("coil[2,1].temperature"), {"delay": 1.5}).spoil(sensors)
    clean = read(sensors, trace(RAMP), 60.0, np.random.default_rng(2)).clean
    stamps = np.arange(0.0, 60.25, 0.5)
    assert clean[:, 1] == pytest.approx(310.0 - 0.1 * np.maximum(stamps - 1.5, 0.0), rel=1e-12)


def test_gain_turns_about_zero_celsius_and_pickup_follows_the_current():
    sensors = perfect()
    Gain(place("coil[1,1].temperature"), {"gain": 0.1}).spoil(sensors)
    CurrentPickup(place("coil[2,1].temperature"), {"pickup": 8.0}).spoil(sensors)
    clean = read(sensors, trace(RAMP, np.full((STEPS, 2, 2), 0.5)), 60.0, np.random.default_rng(2)).clean
    assert clean[0] == pytest.approx([300.0 + 0.1 * (300.0 - 273.15), 310.0 + 4.0], rel=1e-12)


def test_exchanged_sensors_read_each_other():
    sensors = perfect()
    WrongIdentity(
        Place("swap", (), np.zeros(0), ("coil[1,1].temperature", "coil[2,1].temperature")), {"exchange": 1.0}
    ).spoil(sensors)
    clean = read(sensors, trace(RAMP), 60.0, np.random.default_rng(2)).clean
    assert clean[0] == pytest.approx([310.0, 300.0], rel=1e-14)


def test_clipped_readings_never_pass_the_ceiling():
    sensors = perfect()
    Clipping(place("coil[1,1].temperature"), {"ceiling": 315.0}).spoil(sensors)
    values = read(sensors, trace(RAMP), 60.0, np.random.default_rng(2)).values
    assert values[:, 0].max() == 315.0
    assert (values[-40:, 0] == 315.0).all()


def test_drop_outs_and_outliers_come_as_often_as_drawn():
    sensors = replace(perfect(), dropouts=0.1, outliers=0.05, noise=0.2)
    values = read(sensors, trace(RAMP), 60.0, np.random.default_rng(2)).values
    missing = np.isnan(values).mean()
    assert missing == pytest.approx(0.1, abs=0.06)  # three deviations of 242 draws
    clean = read(sensors, trace(RAMP), 60.0, np.random.default_rng(2)).clean
    # 15 noises wide: two thirds of the wild ones lie beyond 6 noises.
    assert (np.abs(values - clean) > 6 * 0.2).mean() == pytest.approx(0.03, abs=0.03)


def test_names_follow_strings_and_places():
    assert channel_names(KINDS["extension"], DataSheet(strings=(1, 2)))[-1] == "coil[2,2].extension"
    assert channel_names(KINDS["string"], DataSheet(strings=(1, 2)))[-1] == "string[2].current"
    assert channel_names(KINDS["temperature"], DataSheet(strings=(1, 1), is_driven_by_power=True))[-1] == (
        "coil[2].temperature"
    )


def test_faults_are_drawn_on_sensors_that_can_have_them():
    networks = {name: drawn_sensors(kind, SHEET, np.random.default_rng(1)) for name, kind in KINDS.items()}
    rng = np.random.default_rng(3)
    for _ in range(20):
        swap = drawn_fault(WrongIdentity, networks, "medium", rng)
        assert len(set(swap.place.channels)) == 2
        assert len({c.partition(".")[2] for c in swap.place.channels}) == 1
        lag = drawn_fault(Lag, networks, "strong", rng)
        assert all("current" not in c for c in lag.place.channels)
        # Strong is the upper third of 0.6 to 2.5 s on a logarithmic scale: from 0.6 (2.5 / 0.6)^(2/3) on.
        assert 1.55 <= lag.parameters["lag_time"] <= 2.5
