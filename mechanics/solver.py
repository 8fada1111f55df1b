"""Numerical settings of the mechanical unit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class SolverSettings:
    """Numerical settings of Bullet.

    Args:
        micro_step: Time step [s].
        iterations: Iterations of the projected Gauss-Seidel solver per step.
        penetration_limit: Largest overlap of two links that is tolerated [m].
        springs: "force": springs are joint forces; "motor": bounded joint motors (see `World`).

    Raises:
        ValueError: A number is not positive, or there is no such way to apply springs.
    """

    micro_step: float
    iterations: int
    penetration_limit: float
    springs: Literal["force", "motor"] = "force"

    def __post_init__(self) -> None:
        for name in ("micro_step", "iterations", "penetration_limit"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"{name} is {value}: give a positive number")
        if self.springs not in ("force", "motor"):
            raise ValueError(f"springs is {self.springs!r}: give 'force' or 'motor'")
