"""An independent twin of thermal_stiffness: scipy integrates the equations, the hysteresis goes in small steps."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from chainmail.equations import COOLING, HEATING, Coil

CELSIUS = 273.15
PAPER = Coil()
#: Equation (2) in N/m, its published constants being in N/mm.
NEWTON_PER_METRE = 1000.0
#: Where the branches cross below full austenite [degC].
CROSSING = brentq(lambda t: float(COOLING(t) - HEATING(t)), 60.0, 100.0, xtol=1e-13)
#: Steepest slope of each branch, a c / e (where b exp(-c T) = 1); the larger bounds every slope of k [N/(m K)].
STEEPEST = max(NEWTON_PER_METRE * g.a * g.c / np.e for g in (HEATING, COOLING))


def heating(celsius):
    """Heating branch [N/m]."""
    return NEWTON_PER_METRE * HEATING(celsius)


def cooling(celsius):
    """Cooling branch [N/m]."""
    return NEWTON_PER_METRE * COOLING(celsius)


def bounds(celsius):
    """Smallest and largest stiffness allowed at a temperature [N/m]."""
    low = heating(celsius)
    return low, np.where(np.asarray(celsius) >= CROSSING, low, cooling(celsius))


def follow(path, memory):
    """Stiffness after the temperatures `path` [degC], one small step after the other."""
    for celsius in path:
        low, high = bounds(celsius)
        memory = np.clip(memory, low, high)
    return memory


def simulate(powers, step, coil=PAPER, regressed=True, substeps=20):
    """Temperature [K], stiffness [N/m] and convected energy [J] at the end of every step.

    Args:
        powers: Shape (steps, coils) [W], constant over each step.
        step: Length of a step [s].
        coil: Constants of the coils.
        regressed: Whether cooling follows equation (5).
        substeps: Points on the temperature path at which the hysteresis is followed, per step.

    Returns:
        Shape (steps, 3, coils).
    """
    coils = powers.shape[1]
    temperature, convected = np.full(coils, coil.ambient), np.zeros(coils)
    memory = heating(temperature)
    record = []
    for power in powers:
        off = (power <= 0.0) & regressed
        flow = np.where(off, coil.cooling_rate * coil.heat_capacity, coil.conductance)

        def rates(_, y, power=power, flow=flow):
            out = flow * (y[:coils] - coil.ambient)
            return np.concatenate([(power - out) / coil.heat_capacity, out])

        solution = solve_ivp(
            rates,
            (0.0, step),
            np.concatenate([temperature, convected]),
            "DOP853",
            rtol=1e-12,
            atol=1e-12,
            t_eval=np.linspace(0.0, step, substeps + 1),
        )
        memory = follow(solution.y[:coils].T, memory)
        temperature, convected = solution.y[:coils, -1], solution.y[coils:, -1]
        record.append([temperature + CELSIUS, memory, convected])
    return np.array(record)
