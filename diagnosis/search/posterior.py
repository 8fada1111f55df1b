"""-2 log posterior of residuals and parameters, with readings that are wild counted less (Huber)."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import Array

#: Residuals beyond this many deviations count linearly (Huber): one wild reading must not look like physics.
HUBER = 4.0


def huber_weights(residuals: Array) -> Array:
    """Square roots of the weights with which residuals enter a linearised fit."""
    size = np.abs(residuals)
    return np.sqrt(np.where(size > HUBER, HUBER / np.maximum(size, HUBER), 1.0))


def cost(residuals: Array, base: Array, widths: Array | float = 1.0) -> float:
    """-2 log posterior: Huber's function of the residuals and the squares of the prior's z, up to a constant."""
    return float(np.sum(costs_of_readings(residuals))) + float(np.sum((base / widths) ** 2))


def costs_of_readings(residuals: Array) -> Array:
    """Huber's function of each residual, which sums to the part of -2 log posterior that is not the prior's."""
    size = np.abs(residuals)
    near = np.minimum(size, HUBER)  # the square of what lies farther is not needed, and may be too large
    return np.asarray(np.where(size > HUBER, 2 * HUBER * size - HUBER**2, near**2))
