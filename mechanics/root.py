"""Root of a function of one variable between two bounds, without loading SciPy (a third of a second at every start)."""

from __future__ import annotations

import math
from collections.abc import Callable

#: Relative width at which an interval is as narrow as floating-point numbers allow: four units of the last place.
_RELATIVE = 4.0 * 2.0**-52
_MOST = 100


def root_between(function: Callable[[float], float], lower: float, upper: float, tolerance: float) -> float:
    """Where a continuous function passes 0: secant or inverse quadratic steps, bisection where these do not converge.

    Steps and comparisons are those of `scipy.optimize.brentq`, so that geometry keeps its last bit.

    Args:
        function: Has opposite signs at the bounds.
        lower: Bound.
        upper: Bound.
        tolerance: Largest error of the root, beside 4 units of its last place.

    Raises:
        ValueError: The signs at the bounds are the same.

    Source: R. P. Brent, Algorithms for Minimization without Derivatives, Prentice-Hall 1973, chapter 4.

    >>> root_between(lambda x: x * x - 2.0, 0.0, 2.0, 1e-14)
    1.414213562373095
    """
    before, now = lower, upper
    value_before, value = function(before), function(now)
    if value_before == 0.0:
        return before
    if value == 0.0:
        return now
    if (value_before < 0.0) == (value < 0.0):
        raise ValueError(f"the function has the same sign at {lower:g} and at {upper:g}")
    opposite, value_opposite, step_before, step = 0.0, 0.0, 0.0, 0.0
    for _ in range(_MOST):
        if value_before != 0.0 and value != 0.0 and math.copysign(1.0, value_before) != math.copysign(1.0, value):
            opposite, value_opposite = before, value_before
            step_before = step = now - before
        if abs(value_opposite) < abs(value):  # the best guess comes first
            before, now, opposite = now, opposite, now
            value_before, value, value_opposite = value, value_opposite, value
        least = (tolerance + _RELATIVE * abs(now)) / 2.0
        half = (opposite - now) / 2.0
        if value == 0.0 or abs(half) < least:
            return now
        trial = math.nan
        if abs(step_before) > least and abs(value) < abs(value_before):
            trial = _interpolated((before, value_before), (now, value), (opposite, value_opposite))
        if 2.0 * abs(trial) < min(abs(step_before), 3.0 * abs(half) - least):
            step_before, step = step, trial
        else:
            step_before = step = half
        before, value_before = now, value
        now += step if abs(step) > least else math.copysign(least, half)
        value = function(now)
    return now


def _interpolated(before: tuple[float, float], now: tuple[float, float], opposite: tuple[float, float]) -> float:
    """Step to the root of the line through two points, or of the inverse parabola through three."""
    (x_before, f_before), (x_now, f_now), (x_opposite, f_opposite) = before, now, opposite
    if x_before == x_opposite:
        return -f_now * (x_now - x_before) / (f_now - f_before)
    first = (f_before - f_now) / (x_before - x_now)
    second = (f_opposite - f_now) / (x_opposite - x_now)
    return -f_now * (f_opposite * second - f_before * first) / (second * first * (f_opposite - f_before))
