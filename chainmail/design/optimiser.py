"""CMA-ES for what closed forms and structure do not decide."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence

import numpy as np

from cosim.unit.protocol import Array

#: First standard deviation, as a share of every range.
STEP = 0.25


def minimised(distance: Callable[[Array], float], begin: Sequence[float], most: int, seed: int) -> float:
    """Least distance to a request that was found; it ends with the first point that meets it.

    Args:
        distance: Of a point in the unit cube; 0 or less where the request is met.
        begin: First point, shape (numbers,).
        most: Points that may be looked at.
        seed: Of the random numbers.

    Source: N. Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772; package `cma`.

    >>> best = minimised(lambda x: float(np.sum((x - 0.2) ** 2)) - 0.01, [0.8, 0.9], 200, 1)
    >>> -0.01 <= best <= 0.0
    True
    """
    if most < 1:
        return np.inf
    with warnings.catch_warnings():
        # It asks for matplotlib to draw with, which nothing here does.
        warnings.simplefilter("ignore")
        import cma

    best, seen = np.inf, 0
    if len(begin) == 1:
        # CMA-ES needs two numbers; a second one that nothing depends on does no harm.
        return minimised(lambda x: distance(x[:1]), [*begin, 0.5], most, seed)
    options = {"bounds": [0.0, 1.0], "seed": seed + 1, "verbose": -9}
    strategy = cma.CMAEvolutionStrategy(list(begin), STEP, options)
    while seen < most:  # whether it has converged does not matter: only a point that meets the request ends it
        points = strategy.ask()
        values = []
        for point in points[: most - seen]:
            values.append(distance(np.asarray(point)))
            seen += 1
            best = min(best, values[-1])
            if best <= 0.0:
                return best
        if len(values) < len(points):
            break
        strategy.tell(points, values)
    return best
