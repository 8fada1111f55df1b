"""What a straight line in the simulated course, its scale and its zero, does not explain of readings."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import Array


def line_basis(simulated: Array) -> Array:
    """Orthonormal columns of what scale and shift of a simulated course make, shape (readings, 2)."""
    return np.linalg.qr(np.stack([np.ones(len(simulated)), simulated], axis=1))[0]


def freed(row: Array, basis: Array) -> Array:
    """A row without what a basis explains of it."""
    return np.asarray(row - basis @ (basis.T @ row))
