"""A homogenised row model for screening: a chain of rows whose joints bend as far as their weave lets them.

A joint between two rows turns by the smaller angle `stiff` where both rows are hot (jammed), by `flexible` where one is
cold, each as measured on two runs of the fabric itself. Gravity turns every joint downwards until the row is vertical.
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
        flexible: Angle of a joint that is not jammed [rad].
        stiff: Angle of a jammed joint [rad].
    """

    rows: int
    held: int
    pitch: float
    flexible: float
    stiff: float

    def sag(self, hot: Collection[int]) -> float:
        """Sag of the last row below the tethered ones [m].

        Args:
            hot: Heated rows, counted from 1.

        >>> round(Chain(8, 2, 0.0214, 0.25, 0.0).sag(range(3, 9)), 6)
        0.0
        """
        angle = sag = 0.0
        for row in range(self.held + 1, self.rows + 1):
            is_jammed = row in hot and (row - 1 <= self.held or row - 1 in hot)
            angle = min(angle + (self.stiff if is_jammed else self.flexible), 0.5 * math.pi)
            sag += self.pitch * math.sin(angle)
        return sag


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
