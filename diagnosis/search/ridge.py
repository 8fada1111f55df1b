"""Down a ridge that bends: two numbers of a law of which the recordings show a product of powers.

What stiction takes per swing is about its torque times the square of its speed. Steps along straight lines leave such
a ridge at once and end where they began; in logarithms it is straight.
"""

from __future__ import annotations

import numpy as np

from diagnosis.search.fit import Fit, fit
from diagnosis.search.problem import Model, Point
from diagnosis.search.switches import costs_at

#: Factors on a number by which the ridge is looked along.
FACTORS = (0.5, 0.7, 0.85, 1.2, 1.4, 2.0)
#: Points within this of the fit [-2 log posterior] are worth another fit: beyond it the ridge has walls.
NEAR = 12.0
#: What another fit must lower -2 log posterior by to be gone on from, and how often.
WORTH, ROUNDS = 0.3, 3


def along_ridge(model: Model, found: Fit) -> Fit:
    """The fit, or a better one that lies along the ridges of its terms.

    Args:
        model: Model and training recordings.
        found: A fit with its covariance: that says what else moves when one number does.
    """
    for _ in range(ROUNDS):
        points = along(found)
        if not points:
            break
        costs = costs_at(model, found, points)
        best = int(np.argmin(costs))
        if not costs[best] < found.cost + NEAR:
            break
        other = fit(model, points[best], widths=found.widths)
        if other.cost > found.cost - WORTH:
            break
        found = other
    return found


def along(found: Fit) -> list[Point]:
    """Points along the ridges of a fit: one number of a term by a factor, all others as they go with it.

    Numbers of terms go in logarithms where they and their lower bounds are not negative, the model's own in a straight
    line. Instants and first numbers (strengths) are not led: others lead them.
    """
    numbers = [
        (p, v, is_first)
        for t, values in found.point.terms.items()
        for p, v, is_first in zip(t.parameters, values, (True, *[False] * (len(values) - 1)))
    ]
    begin, points = len(found.point.base), []
    covariance = found.covariance
    for i, (parameter, value, is_first) in enumerate(numbers):
        spread = covariance[begin + i, begin + i]
        leads = not is_first and not parameter.is_instant and parameter.lower >= 0.0 < value
        if not leads or not np.isfinite(spread) or spread <= 0.0:
            continue
        slopes = covariance[:, begin + i] / spread
        for factor in FACTORS:
            step = value * float(np.log(factor))
            values = []
            for j, (other, now, _) in enumerate(numbers):
                moved = float(slopes[begin + j]) * step
                is_log = other.lower >= 0.0 < now
                there = now * float(np.exp(np.clip(moved / now, -3.0, 3.0))) if is_log else now + moved
                values.append(min(max(there, other.lower), other.upper))
            terms = {}
            for t in found.point.terms:
                count = len(t.parameters)
                terms[t], values = tuple(values[:count]), values[count:]
            points.append(Point(found.point.base + slopes[:begin] * step, terms))
    return points
