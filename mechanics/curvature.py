"""Equation (1) of the paper on the centres of the rows."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import Array


def max_curvature(points: Array) -> float:
    """Largest curvature [1/m] along a chain of points.

    Equation (1), |y'z'' - z'y''| / (y'^2 + z'^2)^(3/2), of the circle through each three consecutive points:
    kappa = 2 |(b - a) x (c - b)| / (|b - a| |c - b| |c - a|). It is exact on circles and lines however the points are
    spaced, and needs no smoothing parameter. End points have no neighbour on one side and give no value.

    Args:
        points: Shape (n, 2), y and z of the row centres in order [m]; n >= 3.

    Raises:
        ValueError: Fewer than three points, or two consecutive ones coincide.

    Source: paper, equation (1); circumscribed-circle (Menger) curvature.

    >>> round(max_curvature(np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])), 12)
    1.0
    """
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        raise ValueError(f"curvature needs at least three points (n, 2), not an array of shape {points.shape}")
    step = np.diff(points, axis=0)
    span = points[2:] - points[:-2]
    cross = np.abs(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0])
    length = np.hypot(step[:, 0], step[:, 1])
    product = length[:-1] * length[1:] * np.hypot(span[:, 0], span[:, 1])
    if not (product > 0).all():
        raise ValueError(f"points {int(np.argmin(product))} to {int(np.argmin(product)) + 2} coincide")
    return float(np.max(2 * cross / product))
