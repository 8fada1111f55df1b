"""An independent twin of tcp_muscle: scipy integrates the linear model of Yip and Niemeyer."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

AMBIENT = 295.15
MUSCLES, CAPACITY, CONDUCTANCE, STIFFNESS = 3, 0.0222, 3.6e-3, 756.0
LENGTH, CONTRACTION = 0.03137, 1.82e-3


def simulate(powers, step):
    """Temperature [K], rest length [m], stored and convected energy [J] after every step; shape (steps, 4, bundles).

    Args:
        powers: Shape (steps, bundles) [W], constant over each step.
        step: Length of a step [s].
    """
    count = powers.shape[1]
    state = np.concatenate([np.full(count, AMBIENT), np.zeros(count)])
    record = []
    for power in powers:

        def rates(_, y, power=power):
            out = MUSCLES * CONDUCTANCE * (y[:count] - AMBIENT)
            return np.concatenate([(power - out) / (MUSCLES * CAPACITY), out])

        state = solve_ivp(rates, (0.0, step), state, "DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
        rise = state[:count] - AMBIENT
        stored = MUSCLES * CAPACITY * rise
        record.append([state[:count], LENGTH * (1.0 - CONTRACTION * rise), stored, state[count:]])
    return np.array(record)
