"""How many fresh starts a statement needs: a sequential test, and the interval of a share."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from scipy.stats import beta


class Verdict(Enum):
    """Of a sequential test."""

    OPEN = "open"
    ACCEPTED = "accepted"
    REJECTED = "rejected"


@dataclass(frozen=True)
class SequentialTest:
    """Wald's sequential probability ratio test of a share.

    Args:
        good: Share that is to be accepted.
        bad: Share that is to be rejected.
        error: Greatest probability of either wrong verdict.

    Source: A. Wald, Sequential Analysis, Wiley 1947, sections 3 and 5.

    >>> test = SequentialTest(0.9, 0.6, 0.1)
    >>> [test.verdict(n, 0).value for n in (5, 6)]
    ['open', 'accepted']
    >>> test.verdict(0, 2).value
    'rejected'
    """

    good: float
    bad: float
    error: float

    @property
    def fewest(self) -> int:
        """Runs after which the share can be accepted, where all of them meet the requirement.

        >>> SequentialTest(0.9, 0.6, 0.1).fewest
        6
        """
        return math.ceil(math.log((1 - self.error) / self.error) / math.log(self.good / self.bad) - 1e-9)

    def verdict(self, met: int, missed: int) -> Verdict:
        """After so many runs that met the requirement and so many that did not."""
        ratio = met * math.log(self.good / self.bad) + missed * math.log((1 - self.good) / (1 - self.bad))
        bound = math.log((1 - self.error) / self.error)
        if ratio >= bound:
            return Verdict.ACCEPTED
        return Verdict.REJECTED if ratio <= -bound else Verdict.OPEN


def share_interval(met: int, runs: int, confidence: float) -> tuple[float, float]:
    """Interval of a share (Clopper and Pearson, Biometrika 26 (1934) 404-413).

    >>> low, high = share_interval(6, 6, 0.9)
    >>> round(low, 3), high
    (0.607, 1.0)
    """
    tail = 0.5 * (1.0 - confidence)
    low = 0.0 if met == 0 else float(beta.ppf(tail, met, runs - met + 1))
    high = 1.0 if met == runs else float(beta.ppf(1.0 - tail, met + 1, runs - met))
    return low, high
