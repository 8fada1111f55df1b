"""How sure a share of few cases is."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from scipy.stats import binomtest


@dataclass(frozen=True)
class Share:
    """How many of how many.

    Args:
        hits: Number of cases for which it is so.
        total: Number of cases.
    """

    hits: int
    total: int

    @classmethod
    def of(cls, answers: Iterable[bool | None]) -> Share:
        """Share of those that are true among those that are not None."""
        asked = [a for a in answers if a is not None]
        return cls(sum(asked), len(asked))

    @property
    def value(self) -> float:
        """Share in [0, 1]; NaN of nothing."""
        return self.hits / self.total if self.total else math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the probability behind it.

        Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209-212.

        >>> low, high = Share(9, 10).interval
        >>> round(low, 3), round(high, 3)
        (0.596, 0.982)
        """
        if not self.total:
            return 0.0, 1.0
        low, high = binomtest(self.hits, self.total).proportion_ci(method="wilson")
        return float(low), float(high)

    def __str__(self) -> str:
        if not self.total:
            return "no case"
        low, high = self.interval
        return f"{100 * self.value:.0f} % ({self.hits} of {self.total}; {100 * low:.0f} to {100 * high:.0f} %)"
