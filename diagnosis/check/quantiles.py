"""Tails of the laws of chance by which doubts are weighed, without scipy.stats, which takes a second to load."""

from __future__ import annotations

import numpy as np
from scipy.special import chdtrc, chdtri, gammaln, ndtri, poch, stdtrit, xlogy


def chi_square_tail(value: float, degrees: float) -> float:
    """Probability that a chi-square variable is larger than a value."""
    return float(chdtrc(degrees, value))


def chi_square_beyond(probability: float, degrees: float) -> float:
    """Value that a chi-square variable exceeds with this probability."""
    return float(chdtri(degrees, probability))


def normal_beyond(probability: float) -> float:
    """Value that a standard normal variable exceeds with this probability."""
    return -float(ndtri(probability))


def student_beyond(probability: float, degrees: float) -> float:
    """Value that a variable of Student's t law exceeds with this probability."""
    return -float(stdtrit(degrees, probability))


def student_log_height(degrees: float) -> float:
    """Logarithm of the density of Student's t law at 0."""
    return float(np.log(poch(0.5 * degrees, 0.5)) - 0.5 * (np.log(degrees) + np.log(np.pi)))


def poisson_log(count: int, mean: float) -> float:
    """Logarithm of the probability of a count, of Poisson's law."""
    return float(xlogy(count, mean) - gammaln(count + 1) - mean)
