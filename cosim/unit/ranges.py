"""The range for which a unit is made, as its variables declare it."""

from __future__ import annotations

import numpy as np

from cosim.unit.variable import AnyArray, Array, Variable

#: Share of the largest value by which rounding may pass a bound.
ROUNDING = 1e-6


def with_unit(value: float, variable: Variable) -> str:
    """A value of a variable."""
    return f"{value:.6g}" if variable.unit == "1" else f"{value:.6g} {variable.unit}"


def in_words(variable: Variable) -> str:
    """The range of a variable, with its unit.

    >>> from cosim.unit.variable import Causality
    >>> in_words(Variable("level", Causality.OUTPUT, (), "m", least=0.0, most=2.0))
    '0 to 2 m'
    >>> in_words(Variable("level", Causality.OUTPUT, (), "m", least=0.0))
    'at least 0 m'
    >>> in_words(Variable("share", Causality.OUTPUT, (), "1", most=1.0))
    'at most 1'
    """
    low, high = variable.least, variable.most
    if low is not None and high is not None:
        text = f"{low:.6g} to {high:.6g}"
    elif low is not None:
        text = f"at least {low:.6g}"
    else:
        text = f"at most {high:.6g}"
    return text if variable.unit == "1" else f"{text} {variable.unit}"


def beyond(variable: Variable, values: AnyArray) -> Array:
    """How far values lie outside the range, same shape, in the variable's unit; 0 inside and within rounding."""
    numbers = np.asarray(values, dtype=np.float64)
    found = np.zeros_like(numbers)
    if variable.least is not None:
        found = np.maximum(found, variable.least - numbers)
    if variable.most is not None:
        found = np.maximum(found, numbers - variable.most)
    slack = ROUNDING * float(np.max(np.abs(numbers), initial=0.0))
    return np.asarray(np.where(found > slack, found, 0.0))


def has_range(variable: Variable) -> bool:
    """Whether a range is declared of a number."""
    return variable.type.is_number and (variable.least is not None or variable.most is not None)
