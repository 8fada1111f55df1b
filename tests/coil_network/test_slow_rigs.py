"""Rigs with time constants of many minutes: steps as long as the readings are apart, with the answers of short ones."""

import numpy as np
import pytest

from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import places
from diagnosis.models.coil_network.kernel.probes import Probe, probe_sensitivities
from diagnosis.models.coil_network.kernel.steps import SHARE, USUAL, choose_step, longest
from tests.coil_network.rigs import ROOM, full_network

STOP = 5100.0  # s, 85 minutes
TIMES = {"temperature": np.arange(0.0, STOP + 1.0, 10.0)}
NOISE = {"temperature": 0.1}
POWER = Programme(
    np.array([0.0, 60.0, 600.0, 2400.0, 3000.0, 4000.0]),
    np.array([[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.1, 0.3], [0.1, 0.05], [0.3, 0.05]]),
)
DRIVE = Drive(Programme.constant(ROOM), power=POWER)
#: 1333 s, as a heater on a finned sink.
SLOW = CoilNetworkParameters({"conductance": 0.012, "capacity": 16.0, "use_regressed_cooling_rate": 0.0})
HEATERS = CoilNetworkLayout(2)


def test_a_slow_rig_that_is_read_every_ten_seconds_needs_no_more_than_two_steps_for_a_reading():
    network = full_network(HEATERS)
    choice = choose_step(network, SLOW, DRIVE, 0.0, TIMES, NOISE)
    assert len(choice.inputs.time) < 2 * len(TIMES["temperature"])
    fine = DRIVE.on_grid(grid(0.0, STOP, 0.1, DRIVE.switches()))
    away = (
        network.simulate(SLOW, choice.inputs, TIMES)["temperature"] - network.simulate(SLOW, fine, TIMES)["temperature"]
    )
    assert np.abs(away).max() < 2.0 * SHARE * NOISE["temperature"]  # K


def test_a_fast_rig_that_is_read_as_seldom_keeps_short_steps():
    fast = SLOW.with_base(capacity=0.06, resistance_temperature_coefficient=0.0)  # 5 s
    choice = choose_step(full_network(HEATERS), fast, DRIVE, 0.0, TIMES, NOISE)
    assert choice.step <= USUAL
    assert choice.error < SHARE


def test_long_steps_hold_for_the_fastest_rig_that_the_fit_may_come_to():
    fastest = SLOW.with_base(capacity=1.0)  # 83 s
    alone = choose_step(full_network(HEATERS), SLOW, DRIVE, 0.0, TIMES, NOISE)
    safe = choose_step(full_network(HEATERS), SLOW, DRIVE, 0.0, TIMES, NOISE, fastest)
    assert safe.step < alone.step
    assert safe.error < SHARE


@pytest.mark.parametrize(
    ("interval", "expected"), [(0.1, 0.4), (0.5, 0.4), (0.79, 0.4), (0.8, 0.8), (1.0, 0.8), (10.0, 6.4)]
)
def test_the_longest_step_is_within_the_interval_of_the_densest_readings(interval, expected):
    times = {"temperature": np.arange(0.0, 500.0, 60.0), "current": np.arange(0.0, 500.0, interval)}
    assert longest(times) == pytest.approx(expected)


def noisy(interval, size=0.02):
    """Heaters at noisy powers recorded at an interval, with one switch at 2000 s."""
    points = np.arange(0.0, STOP, interval)
    noise = 1.0 + size * np.random.default_rng(1).standard_normal((len(points), 2))
    power = np.where(points[:, None] < 2000.0, [0.3, 0.2], [0.1, 0.4]) * noise
    return Drive(Programme.constant(ROOM), power=Programme(points, power))


@pytest.mark.parametrize("interval", [1.0, 0.1])
def test_a_noisy_course_is_taken_together_as_far_as_the_readings_allow(interval):
    drive = noisy(interval)
    choice = choose_step(full_network(HEATERS), SLOW, drive, 0.0, TIMES, NOISE)
    assert len(choice.inputs.time) < 2.5 * len(TIMES["temperature"])
    assert 2000.0 in choice.inputs.time
    whole = drive.on_grid(grid(0.0, STOP, 0.1, drive.switches()))
    network = full_network(HEATERS)
    away = (
        network.simulate(SLOW, choice.inputs, TIMES)["temperature"]
        - network.simulate(SLOW, whole, TIMES)["temperature"]
    )
    assert np.abs(away).max() < 2.0 * SHARE * NOISE["temperature"]  # K


def test_a_course_that_switches_keeps_every_point():
    points = np.arange(0.0, STOP, 1.0)
    pulses = np.where(points % 2.0 < 1.0, 0.6, 0.0)[:, None] * np.ones(2)
    drive = Drive(Programme.constant(ROOM), power=Programme(points, pulses))
    assert drive.thinned(10.0).switches() == drive.switches()


def test_a_voltage_that_is_taken_together_heats_as_much():
    points = np.arange(0.0, 100.0, 1.0)
    volts = 5.0 + 0.1 * np.random.default_rng(1).standard_normal(len(points))
    thin = Drive(Programme.constant(ROOM), Programme(points, volts)).thinned(11.0).voltage
    assert len(thin.times) == 10
    assert thin.values[:-1] == pytest.approx([np.sqrt(np.mean(part**2)) for part in np.split(volts[:99], 9)])


def test_what_every_law_would_change_is_the_same_with_long_steps():
    network = full_network(HEATERS)
    choice = choose_step(network, SLOW, DRIVE, 0.0, TIMES, NOISE)
    fine = DRIVE.on_grid(grid(0.0, STOP, USUAL, DRIVE.switches()))
    away = {}
    for term in network.terms:
        found = [p for p in places(term, HEATERS, ["temperature"]) if p.kind != "swap"][:1]
        if not found or any(p.is_fixed for p in term.parameters):
            continue
        probe = Probe(term, {}, found, 0.02 * term.amplitude.starts[0])
        coarse, exact = (
            probe_sensitivities(network, SLOW, i, TIMES, probe)[1]["temperature"][0] for i in (choice.inputs, fine)
        )
        size = float(np.linalg.norm(exact))
        if size * abs(probe.step) > 1e-6:  # K; below lies rounding
            away[term.identifier] = float(np.linalg.norm(coarse - exact)) / size
    assert len(away) > 40
    assert max(away.values()) < 0.02, max(away, key=lambda k: away[k])
