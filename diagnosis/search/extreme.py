"""The largest of many: what chance alone gives the best of all candidates.

The law is written out because `scipy.stats` takes a second to load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array

#: Exponent beyond which exp(-exp(x)) is 0 for long.
MOST_EXPONENT = 700.0


@dataclass(frozen=True)
class Gumbel:
    """Gumbel's law of the largest of many.

    Args:
        place: Mode.
        scale: Deviation over pi times the root of 6; 0: a single value.
    """

    place: float
    scale: float

    @classmethod
    def of(cls, draws: Array) -> Gumbel:
        """By the mean and deviation of draws.

        Source: E. J. Gumbel, Statistics of Extremes, 1958, section 6.2.

        Args:
            draws: The largest of each null, shape (nulls,).
        """
        scale = float(np.std(draws)) * math.sqrt(6.0) / math.pi
        return cls(float(np.mean(draws)) - float(np.euler_gamma) * scale, scale)

    def exceeded(self, value: float) -> float:
        """Probability that the largest is above a value; the scale is not 0."""
        return -math.expm1(-math.exp(min(-(value - self.place) / self.scale, MOST_EXPONENT)))

    def quantile(self, level: float) -> float:
        """Value that the largest exceeds with a probability."""
        return self.place - self.scale * math.log(-math.log1p(-level))
