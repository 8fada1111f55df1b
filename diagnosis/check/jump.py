"""A clock that is off by a constant from an instant on: which instant and size are best by any criterion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.report.display import instant

#: Instants that are tried, and sizes each way; then as many of both about the best, so often.
INSTANTS, SIZES, FINER, TIMES = 48, 7, 9, 2
#: What to look at where a clock jumps.
REMEDY = "compare instants before and after that both clocks know; correct the column of times from there on"
#: Jumps that are tried first, the price of the best of them.
TRIED = 2 * SIZES * INSTANTS


@dataclass(frozen=True)
class Jump:
    """A clock that jumps.

    Args:
        size: By how much the readings are said to be later than they were, from the instant on [s].
        at: The instant on the clock as it is written [s].
        value: What the criterion is there.
    """

    size: float
    at: float
    value: float

    def in_words(self, of: str = "the readings") -> str:
        """What is off, and what a clock did that is.

        Args:
            of: What it wrote.
        """
        way, why = ("late", "was set forward") if self.size > 0.0 else ("early", "stood still or was set back")
        return (
            f"from about {instant(self.at, 4)} s on {of} are written about {instant(abs(self.size), 2)} s too {way}: "
            f"the clock {why} there"
        )


def offsets(times: Array, size: float, at: float) -> Array:
    """By how much readings at some times [s] are said to be later than they were."""
    return np.where(times >= at, size, 0.0)


def best_jump(begin: float, end: float, sizes: Array, criterion: Callable[[Array], Array]) -> Jump:
    """The jump with the smallest criterion.

    Args:
        begin: Of the readings [s].
        end: Of the readings [s].
        sizes: Sizes that are tried, each way, in a geometric series [s].
        criterion: Jumps (size, instant), shape (jumps, 2), to what is to be small, shape (jumps,).
    """
    apart, ratio = (end - begin) / (INSTANTS + 1), float(sizes[1] / sizes[0])
    every: Array = np.asarray(begin + apart * np.arange(1.0, INSTANTS + 1.0))
    found = _smallest(np.concatenate([-sizes, sizes]), every, criterion)
    for _ in range(TIMES):
        finer = found.size * np.geomspace(1.0 / ratio, ratio, FINER)
        inside = np.unique(np.clip(found.at + np.linspace(-apart, apart, FINER), begin, end))
        found = _smallest(finer, np.asarray(inside, dtype=np.float64), criterion)
        ratio, apart = ratio ** (2.0 / (FINER - 1)), apart * 2.0 / (FINER - 1)
    return found


def _smallest(sizes: Array, instants: Array, criterion: Callable[[Array], Array]) -> Jump:
    tried = np.array([[s, t] for s in sizes for t in instants])
    values = criterion(tried)
    best = int(np.argmin(values))
    return Jump(float(tried[best, 0]), float(tried[best, 1]), float(values[best]))
