"""Numerical settings of the mechanical unit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class SolverSettings:
    """Numerical settings of the engine.

    Args:
        micro_step: Time step [s].
        iterations: Bullet: iterations of the projected Gauss-Seidel solver per step. MuJoCo: the most iterations of
            Newton's method, which ends earlier where it has converged.
        penetration_limit: Largest overlap of two links that is tolerated [m].
        springs: "force": springs are joint forces; "motor": bounded joint motors (`mechanics.bullet`); Bullet alone.
        engine: "bullet" or "mujoco".
        friction_model: "cone": the friction of a contact points against its sliding; "pyramid": both its components are
            bounded by themselves, which is cheaper and holds up to sqrt(2) more in between; Bullet alone.
        friction_anchors: Whether a contact that sticks is drawn back to where it began to stick, so that what is at
            rest does not creep; Bullet alone.

    Raises:
        ValueError: A number is not positive, or there is no such way to apply springs.
    """

    micro_step: float
    iterations: int
    penetration_limit: float
    springs: Literal["force", "motor"] = "force"
    engine: Literal["bullet", "mujoco"] = "bullet"
    friction_model: Literal["cone", "pyramid"] = "cone"
    friction_anchors: bool = False

    def __post_init__(self) -> None:
        for name in ("micro_step", "iterations", "penetration_limit"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"{name} is {value}: give a positive number")
        if self.springs not in ("force", "motor"):
            raise ValueError(f"springs is {self.springs!r}: give 'force' or 'motor'")
        if self.engine not in ("bullet", "mujoco"):
            raise ValueError(f"engine is {self.engine!r}: give 'bullet' or 'mujoco'")
        if self.friction_model not in ("cone", "pyramid"):
            raise ValueError(f"friction_model is {self.friction_model!r}: give 'cone' or 'pyramid'")
