"""The sampled loop of a coil and its closed form."""

from __future__ import annotations

import math

import numpy as np

from cosim.run import run
from tests.control.files import CAPACITY, CONDUCTANCE, loop


def largest_error() -> float:
    """Largest difference of 300 samples of the loop from its closed form [K].

    x = (T - T_room, I): one step is x' = A x + b, so after k steps x = s + A^k (x_0 - s) with s = A s + b.
    """
    gain, integral_time, step = 0.004, 4.0, 0.1
    law = {"controller.law": {"kind": "pi", "gain": f"{gain} W/K", "integral_time": f"{integral_time} s"}}
    found = run(loop({**law, "controller.setpoint": "60 degC"}, 30.0))
    decay = math.exp(-CONDUCTANCE / CAPACITY * step)
    heat = (1.0 - decay) / CONDUCTANCE
    matrix = np.array([[decay - heat * gain, heat], [-gain * step / integral_time, 1.0]])
    reference = 60.0 - 22.0
    settled = np.linalg.solve(np.eye(2) - matrix, np.array([heat * gain, gain * step / integral_time]) * reference)
    wanted = [settled + np.linalg.matrix_power(matrix, k) @ (np.zeros(2) - settled) for k in range(301)]
    power = found["controller.command"].values[1:, 0]
    assert power.min() > 0.0
    assert power.max() < 2.0  # no limit was touched, so the loop is linear
    assert abs(settled[0] - reference) < 1e-9
    temperature = found["actuator.temperature"].values[:, 0] - 295.15
    return float(np.abs(temperature - np.array(wanted)[:, 0]).max())
