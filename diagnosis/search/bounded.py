"""The step of a fit that stays within bounds."""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from cosim.unit.protocol import Array

#: Most turns in which bounds are found that a step would pass.
TURNS = 16
#: Slope, as a share of the largest, from which a number at its bound is let go.
EAGER = 1e-9


def bounded_step(normal: Array, slope: Array, lower: Array, upper: Array) -> Array:
    """Step to the minimum of a parabola within bounds; what would pass its bound stops there, and the rest follows.

    Cutting off each number by itself would leave those that belong together apart: a step of many numbers that are
    alike would then lead uphill.

    Args:
        normal: Half the second derivative, positive definite, shape (n, n).
        slope: Half the slope, shape (n,).
        lower: Least step, at most 0 where the start is inside, shape (n,).
        upper: Greatest step, shape (n,).

    Raises:
        LinAlgError: The normal matrix is not positive definite.
    """
    step = np.zeros_like(slope)
    if not step.size:  # a model without anything that may be off
        return step
    is_held = ((lower >= 0.0) & (slope > 0)) | ((upper <= 0.0) & (slope < 0))
    for _ in range(TURNS):
        free = np.flatnonzero(~is_held)
        pull = slope[free] + normal[np.ix_(free, np.flatnonzero(is_held))] @ step[is_held]
        step[free] = -cho_solve(cho_factor(normal[np.ix_(free, free)]), pull)
        is_over = ~is_held & ((step < lower) | (step > upper))
        if is_over.any():
            step[is_over] = np.clip(step, lower, upper)[is_over]
            is_held |= is_over
            continue
        slope_there = slope + normal @ step  # what was stopped too early is let go, the most eager first
        inward = np.where(step <= lower, -slope_there, slope_there) * is_held
        if inward.max(initial=0.0) <= EAGER * np.abs(slope).max(initial=0.0):
            break
        is_held[int(np.argmax(inward))] = False
    return np.asarray(np.clip(step, lower, upper))
