"""The factor on a number, an input or a time constant with which least is left of a recording."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import minimize_scalar

#: Accuracy of ln(factor).
EXACT = 1e-3


def best_logarithm(cost: Callable[[float], float], tried: Sequence[float]) -> tuple[float, float]:
    """The logarithm of the factor with the least cost, and that cost; 0 and infinity where none has any.

    Args:
        cost: Of a logarithm; infinite where nothing runs.
        tried: Logarithms that are tried first, rising; between the neighbours of the best one it is found.
    """
    grid = np.array(tried)
    costs = np.array([cost(x) for x in grid.tolist()])
    if not np.isfinite(costs).any():
        return 0.0, math.inf
    best = int(np.argmin(np.where(np.isfinite(costs), costs, np.inf)))
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    result = minimize_scalar(cost, bounds=(float(low), float(high)), method="bounded", options={"xatol": EXACT})
    value, least = float(result.x), float(result.fun)
    return (value, least) if least < costs[best] else (float(grid[best]), float(costs[best]))
