"""A homogenised row model for screening: a chain of rows that bends at every row as far as its weave lets it.

A hot row is straight but for the angle `stiff`; a cold one bends by `flexible`. Gravity bends every row downwards
until the next one hangs vertically. A cold 2 x 8 fabric bends by 12 to 14 degrees at every free row (docs/design.md).
Arithmetic only: it ranks patterns of rows, and judges none.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass


@dataclass(frozen=True)
class Chain:
    """A cantilever of rows.

    Args:
        rows: Number of rows, the tethered ones included.
        held: Tethered rows.
        pitch: Distance between two rows [m].
        flexible: Bend of a cold row [rad].
        stiff: Bend of a hot row [rad].
    """

    rows: int
    held: int
    pitch: float
    flexible: float
    stiff: float

    def angles(self, hot: Collection[int]) -> list[float]:
        """Slope of every row's way to the next one, from the last tethered row on [rad].

        Args:
            hot: Heated rows, counted from 1.
        """
        found = [0.0]
        for row in range(self.held + 1, self.rows):
            found.append(min(found[-1] + (self.stiff if row in hot else self.flexible), 0.5 * math.pi))
        return found

    def sag(self, hot: Collection[int]) -> float:
        """Sag of the last row below the tethered ones [m].

        >>> round(Chain(8, 2, 0.026, 0.25, 0.0).sag(range(3, 9)), 6)
        0.0
        """
        return self.pitch * sum(map(math.sin, self.angles(hot)))


def fitted(rows: int, held: int, pitch: float, cold_sag: float, hot_sag: float) -> Chain:
    """The chain that has the sag of two runs: all rows cold, and all free rows hot.

    Args:
        rows: Number of rows.
        held: Tethered rows.
        pitch: Distance between two rows [m].
        cold_sag: Of the cold run [m].
        hot_sag: Of the hot run [m].
    """
    free = range(held + 1, rows + 1)
    flexible = _angle(cold_sag, lambda a: Chain(rows, held, pitch, a, 0.0).sag(()))
    stiff = _angle(hot_sag, lambda a: Chain(rows, held, pitch, flexible, a).sag(free))
    return Chain(rows, held, pitch, flexible, min(stiff, flexible))


def _angle(sag: float, model: object) -> float:
    """Angle at which a rising model has a sag, by bisection; 0 or a right angle where it never has it."""
    assert callable(model)
    low, high = 0.0, 0.5 * math.pi
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if model(middle) < sag else (low, middle)
    return 0.5 * (low + high)
