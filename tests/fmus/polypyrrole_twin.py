"""Independent twins of polypyrrole_film: circuit by scipy's matrix exponential, a film by the diffusion equation."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

LAYERS = 5
RESISTANCE, LENGTH, SECTION, THICKNESS = 0.12, 0.03, 22.5e-6, 4e-6
VOLUMETRIC_CAPACITANCE, STRAIN_TO_CHARGE, DIFFUSION = 8e7, 1e-10, 1e-12
MODULUS, LEVER, REST_LENGTH = 0.8e9, 16.1, 0.0314
CAPACITANCE = VOLUMETRIC_CAPACITANCE * SECTION * LENGTH
#: What diffusion through half a film is as a resistance [ohm].
FILM_RESISTANCE = (0.5 * THICKNESS) ** 2 / (DIFFUSION * CAPACITANCE)


def circuit():
    """Matrix A [1/s] and vector b [A/V] of dq/dt = A q + b V, from the nodes' conductances."""
    capacitance, between = CAPACITANCE / LAYERS, LAYERS / FILM_RESISTANCE
    entry = 1.0 / (RESISTANCE + FILM_RESISTANCE / (2 * LAYERS))
    laplacian = np.zeros((LAYERS, LAYERS))
    for j in range(LAYERS - 1):
        laplacian[j : j + 2, j : j + 2] += between * np.array([[1.0, -1.0], [-1.0, 1.0]])
    laplacian[0, 0] += entry
    return -laplacian / capacitance, np.array([entry, 0.0, 0.0, 0.0, 0.0])


def simulate(voltages, step):
    """Rest length [m], stored and convected energy [J], current [A] after every step; shape (steps, 4, actuators).

    The heat is integrated by itself: loss in every resistor and in the shunt, by Gauss-Legendre quadrature.

    Args:
        voltages: Shape (steps, actuators) [V], constant over each step.
        step: Length of a step [s].
    """
    matrix, gain = circuit()
    nodes, weights = np.polynomial.legendre.leggauss(12)
    charge, heat = np.zeros((LAYERS, voltages.shape[1])), np.zeros(voltages.shape[1])
    whole, parts = expm(matrix * step), [expm(matrix * step * 0.5 * (1.0 + x)) for x in nodes]
    record = []
    for voltage in voltages:
        rest = np.full((LAYERS, 1), CAPACITANCE / LAYERS) * voltage
        for part, weight in zip(parts, weights):
            now = rest + part @ (charge - rest)
            heat = heat + 0.5 * step * weight * _loss(now, voltage)
        charge = rest + whole @ (charge - rest)
        stored = 0.5 * LAYERS / CAPACITANCE * (charge**2).sum(axis=0)
        length = REST_LENGTH - LEVER * STRAIN_TO_CHARGE / SECTION * charge.sum(axis=0)
        record.append([length, stored, heat, (matrix @ charge + np.outer(gain, voltage)).sum(axis=0)])
    return np.array(record)


def _loss(charge, voltage):
    """Heat flow [W]: every resistor's, and the shunt's, which takes the current that the film does not."""
    potential = charge * LAYERS / CAPACITANCE
    entry = RESISTANCE + FILM_RESISTANCE / (2 * LAYERS)
    current = (voltage - potential[0]) / entry
    inside = (np.diff(potential, axis=0) ** 2).sum(axis=0) * LAYERS / FILM_RESISTANCE
    return current**2 * entry + inside + voltage * (voltage / RESISTANCE - current)


def diffusion_charge(time, voltage, terms=60):
    """Charge [C] at times [s] after a step of the voltage, by the diffusion equation in half a film.

    dc/dt = D d2c/dx2, no flux in the middle, flux proportional to the missing charge at the face (the resistance R):
    separation of variables with mu tan(mu) = B, B = film resistance / R.

    Source: Crank, The Mathematics of Diffusion, 2nd ed. 1975, section 4.3.6 (surface evaporation), the same equations.
    """
    biot = FILM_RESISTANCE / RESISTANCE
    roots = np.array(
        [
            brentq(lambda mu: mu * np.sin(mu) - biot * np.cos(mu), n * np.pi, n * np.pi + 0.5 * np.pi)
            for n in range(terms)
        ]
    )
    weights = 2.0 * biot**2 / (roots**2 * (roots**2 + biot**2 + biot))
    decay = np.exp(-np.outer(time, roots**2) * DIFFUSION / (0.5 * THICKNESS) ** 2)
    return CAPACITANCE * voltage * (1.0 - decay @ weights)
