"""The true arm: its numbers and every torque that acts on it. Angle 0 points up, pi hangs down."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

GRAVITY = 9.80665  # [m/s^2]


@dataclass(frozen=True)
class ArmEffect:
    """An effect on the arm, as in `proving.effects.effect.Effect`.

    Args:
        identifier: Name.
        law: Formula.
        strengths: Parameter to its values when weak, medium, strong.
        is_named: Whether a catalogue has it.
        signed: Parameter whose sign may be drawn.
        comparable: Parameters that mean the same in the catalogue.
    """

    identifier: str
    law: str
    strengths: Mapping[str, tuple[float, float, float]]
    is_named: bool = True
    signed: str = ""
    comparable: tuple[str, ...] = ()


EFFECTS: tuple[ArmEffect, ...] = (
    ArmEffect(
        "viscous_damping", "torque = -viscous_damping * w", {"viscous_damping": (3e-5, 1e-4, 3e-4)},
        comparable=("viscous_damping",),
    ),
    ArmEffect(
        "coulomb_friction", "torque = -coulomb_friction * sign(w)", {"coulomb_friction": (1e-4, 3e-4, 1e-3)},
        comparable=("coulomb_friction",),
    ),
    ArmEffect(
        "stiction", "torque = -stiction * exp(-(w / stribeck_speed)**2) * sign(w)",
        {"stiction": (1e-3, 2.5e-3, 6e-3), "stribeck_speed": (0.4, 0.4, 0.4)},
        comparable=("stiction", "stribeck_speed"),
    ),
    ArmEffect(
        "quadratic_drag", "torque = -quadratic_drag * abs(w) * w", {"quadratic_drag": (5e-6, 1.5e-5, 5e-5)},
        comparable=("quadratic_drag",),
    ),
    ArmEffect(
        "backlash", "abs(arm - encoder) <= backlash / 2", {"backlash": (0.008, 0.02, 0.05)}, comparable=("backlash",)
    ),
    ArmEffect(
        "tilt", "torque = weight_moment * sin(angle - tilt)", {"tilt": (0.005, 0.015, 0.04)}, signed="tilt",
        comparable=("tilt",),
    ),
    # Not in any catalogue: a cable that twists, a magnet below the hanging arm, a table that shakes.
    ArmEffect(
        "cable_spring", "torque = -cable * (angle - rest)", {"cable": (1e-3, 3e-3, 8e-3), "rest": (2.8, 2.8, 2.8)},
        is_named=False,
    ),
    ArmEffect(
        "eddy_brake", "torque = -brake * exp(-((angle - pi) / 0.25)**2) * w", {"brake": (2e-4, 6e-4, 2e-3)},
        is_named=False,
    ),
    ArmEffect(
        "shaking", "torque = shake * sin(rhythm * t)", {"shake": (3e-4, 8e-4, 2e-3), "rhythm": (9.0, 9.0, 9.0)},
        is_named=False,
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Arm:
    """True numbers.

    Args:
        inertia: About the hinge [kg m^2].
        moment: Mass times gravity times distance of the centre from the hinge [N m].
        distance: Of the centre from the hinge [m].
        effects: Parameters of all effects together, by their names; those left out are 0.
    """

    inertia: float
    moment: float
    distance: float
    effects: Mapping[str, float] = field(default_factory=dict)

    def of(self, name: str) -> float:
        """A parameter of an effect, 0 if it does not act."""
        return self.effects.get(name, 0.0)

    @property
    def mass(self) -> float:
        """[kg]"""
        return self.moment / (GRAVITY * self.distance)

    def weight(self, angle: float) -> float:
        """Torque of the weight [N m]."""
        return self.moment * math.sin(angle - self.of("tilt"))

    def given(self, time: float, angle: float, speed: float) -> float:
        """All torques but weight, viscous damping and dry friction [N m]."""
        torque = -self.of("quadratic_drag") * abs(speed) * speed
        if "cable" in self.effects:
            torque -= self.of("cable") * (angle - self.of("rest"))
        if "brake" in self.effects:
            torque -= self.of("brake") * math.exp(-(((angle - math.pi) / 0.25) ** 2)) * speed
        return torque + self.of("shake") * math.sin(self.of("rhythm") * time)

    def dry(self, speed: float) -> float:
        """Greatest torque of dry friction [N m]."""
        if "stiction" not in self.effects:
            return self.of("coulomb_friction")
        fall = math.exp(-((speed / self.of("stribeck_speed")) ** 2))
        return self.of("coulomb_friction") + self.of("stiction") * fall
