"""Wires against closed forms, their orders of convergence, and the balance of energy."""

from dataclasses import replace

import numpy as np
import pytest

from evaluation.proving.programme import Programme, staircase
from evaluation.proving.rig import ROOM, DataSheet, drawn_rig, ideal_rig
from evaluation.proving.truth import Truth
from evaluation.proving.wire import WireError, Wires

ONE = DataSheet(strings=(1,))


def pulse(volts, stop=30.0):
    return Programme(np.array([0.0]), np.array([volts]), stop)


def test_one_piece_without_end_losses_heats_as_a_capacitor_charges():
    trace = Truth(ideal_rig(ONE), cells=1).run(pulse(1.0), step=0.05)
    final, rate = 1.0 / (2.2 * ONE.conductance), ONE.conductance / ONE.capacity
    exact = ROOM + final * (1.0 - np.exp(-rate * trace.time))
    # TR-BDF2 at h / tau = 0.011: local error about 0.04 (h / tau)^3 per step, 1e-4 K in all.
    assert np.abs(trace.states["temperature"][:, 0] - exact).max() < 1e-4


def test_time_steps_converge_with_second_order():
    rate = ONE.conductance / ONE.capacity
    exact = ROOM + 1.0 / (2.2 * ONE.conductance) * (1.0 - np.exp(-rate * 6.0))
    errors = [
        abs(Truth(ideal_rig(ONE), cells=1).run(pulse(1.0, 6.0), step=h).states["temperature"][-1, 0] - exact)
        for h in (0.4, 0.2, 0.1)
    ]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)


def fin(x, rig):
    """Rise above the pins of a wire of length 1 that is heated evenly: L. M. Jiji, Heat Conduction, 3rd ed., 2.3."""
    g, end, k = rig.conductance[0], rig.end[0], rig.sheet.conduction
    m = np.sqrt(g / k)
    power = 1.0 / rig.resistance[0]
    amplitude = power / g * end / (end * np.cosh(0.5 * m) + k * m * np.sinh(0.5 * m))
    return power / g - amplitude * np.cosh(m * (x - 0.5))


def steady_error(cells):
    rig = replace(ideal_rig(ONE), end=np.full(1, 1e-3))
    wires = Wires(rig, cells)
    truth = Truth(rig, cells=cells)
    seen = []
    truth._thermometer = lambda now: seen.append(now.wire.copy()) or now.temperature  # all pieces, not one place
    truth.run(pulse(1.0, 120.0), step=1.0)
    return np.sqrt(wires.weight @ (seen[-1][0] - ROOM - fin(wires.centre, rig)) ** 2)


def test_pieces_of_wire_converge_to_the_fin_with_second_order():
    errors = [steady_error(n) for n in (16, 32, 64)]
    assert errors[-1] < 0.02  # [K], of a rise of 51 K
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2.0, 2.0], abs=0.25)


def test_what_is_put_in_is_stored_or_lost():
    rng = np.random.default_rng(3)
    rig = drawn_rig(DataSheet(strings=(3, 3)), rng)
    programme = staircase(rng, 3.0, 60.0)
    truth = Truth(replace(rig, end=np.full(6, 1e-3)))
    lost_to_pins = np.zeros(6)
    pins = truth.wires.to_pins
    seen = []
    thermometer = truth._thermometer
    truth._thermometer = lambda now: (
        seen.append((pins * (now.wire - now.ambient[:, None])).sum(axis=1)) or thermometer(now)
    )
    trace = truth.run(programme, step=0.05)
    steps = np.diff(trace.time)[:, None]
    power = trace.flows["power"]
    # While the voltage slews, power goes with its square: Simpson's rule through the middle of the roots is exact.
    middle = (0.5 * (np.sqrt(power[:, 0]) + np.sqrt(power[:, 1]))) ** 2
    put_in = (steps * (power[:, 0] + 4.0 * middle + power[:, 1]) / 6.0).sum(axis=0)
    mean = trace.states["mean_temperature"] - trace.ambient[0]
    stored = rig.capacity * (mean[-1] - mean[0])
    convected = rig.conductance * (steps * 0.5 * (mean[1:] + mean[:-1])).sum(axis=0)
    flows = np.array(seen)
    lost_to_pins = (steps * 0.5 * (flows[1:] + flows[:-1])).sum(axis=0)
    # The trapezoid of the losses is second order, as the steps are: 2e-5 at h / tau = 0.011.
    assert put_in == pytest.approx(stored + convected + lost_to_pins, rel=1e-4)
    assert (lost_to_pins / convected).min() > 0.01


def test_an_effect_that_no_step_can_follow_is_refused():
    wires = Wires(ideal_rig(ONE), 4)
    start = np.full((1, 4), 300.0)

    def jump(wire):
        return np.where(wire > 300.0, -1e6, 1e6), np.zeros_like(wire)

    with pytest.raises(WireError, match="did not converge"):
        wires.step(start, 0.1, np.full(1, 300.0), jump, lambda wire: (wires.capacity * wire, wires.capacity))
