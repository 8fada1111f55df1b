"""Readings of an output that jumps with an input, by a jump of another size at each change."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.check.feedthrough import settled
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel
from diagnosis.recording.series import Series

STEP, COUNT = 0.2, 600


def valve(seed: int) -> tuple[Array, Array]:
    """Instants and openings: a pulse each 8 s or so, as a controller opens a valve."""
    rng = np.random.default_rng(seed)
    instants = np.concatenate([[0.0], STEP * np.cumsum(rng.integers(15, 40, 20))])
    return instants, np.where(np.arange(21) % 2 == 1, rng.uniform(0.2, 0.9, 21), 0.0)


def opening(instants: Array, values: Array) -> Array:
    """What holds just before each output, shape (outputs,)."""
    times = STEP * np.arange(COUNT)
    return values[np.maximum(np.searchsorted(instants, times - 1e-9, side="right") - 1, 0)]


def flow_and_pressure(opened: Array) -> tuple[Array, Array]:
    """Flow through a valve into a vessel that leaks: the flow jumps by opening times what the pressure leaves."""
    pressure, flows, pressures = 0.0, [], []
    for now in opened:
        pressure += STEP * (0.1 * now * (6.0 - pressure) - 0.02 * pressure)
        flows.append(now * (6.0 - pressure))
        pressures.append(pressure)
    return np.array(flows), np.array(pressures)


def readings(values: Array, deviation: float) -> Channel:
    times = STEP * np.arange(COUNT)
    target = Target("line", (), "signal")
    return Channel("signal", target, times, values, deviation, True, is_clipped=np.zeros(COUNT, dtype=bool))


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_readings_at_jumps_of_any_size_are_left_out(seed: int) -> None:
    """One reading for each change inside the recording: nobody knows on which side of the change it was taken."""
    instants, values = valve(seed)
    flow, pressure = flow_and_pressure(opening(instants, values))
    times = STEP * np.arange(COUNT)
    found = settled(readings(flow, 0.02), Series(times, flow, False, "1"), [(instants, values)])
    inside = int(np.sum((instants > 0.0) & (instants < times[-1])))
    assert inside <= found.dropped["at a switch"] <= inside + 1
    kept = settled(readings(pressure, 0.02), Series(times, pressure, False, "1"), [(instants, values)])
    assert "at a switch" not in kept.dropped  # the pressure follows the flow, and jumps nowhere


def test_a_slow_answer_and_a_jump_within_the_noise_are_no_jumps() -> None:
    instants, values = valve(5)
    opened, times = opening(instants, values), STEP * np.arange(COUNT)
    lagged, level = [], 0.0
    for now in opened:
        level += (1.0 - np.exp(-0.5)) * (now - level)  # a time constant of two output steps
        lagged.append(level)
    slow = np.array(lagged)
    assert (
        "at a switch"
        not in settled(readings(slow, 0.01), Series(times, slow, False, "1"), [(instants, values)]).dropped
    )
    flow, _ = flow_and_pressure(opened)
    rough = readings(flow, 10.0)
    assert "at a switch" not in settled(rough, Series(times, flow, False, "1"), [(instants, values)]).dropped
