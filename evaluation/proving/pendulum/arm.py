"""The true arm: its numbers and every torque that acts on it. Angle 0 points up, pi hangs down."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from evaluation.proving.effects.effect import value_at

GRAVITY = 9.80665  # [m/s^2]
#: Time [s], angle [rad] and angular velocity [rad/s] to a torque [N m]; asked for at rising times, and at 0 to begin.
Torque = Callable[[float, float, float], float]


@dataclass(frozen=True)
class ArmEffect:
    """An effect on the arm, as in `evaluation.proving.effects.effect.Effect`.

    Args:
        identifier: Name.
        law: Formula.
        strengths: Parameter to its range, from weak to strong.
        ranges: Parameter to its range, where it says nothing about the strength.
        is_named: Whether a catalogue has it.
        signed: Parameter whose sign may be drawn.
        comparable: Parameters that mean the same in the catalogue.
    """

    identifier: str
    law: str
    strengths: Mapping[str, tuple[float, float]]
    is_named: bool = True
    signed: str = ""
    comparable: tuple[str, ...] = ()
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)


EFFECTS: tuple[ArmEffect, ...] = (
    ArmEffect(
        "viscous_damping",
        "torque = -viscous_damping * w",
        {"viscous_damping": (3e-5, 3e-4)},
        comparable=("viscous_damping",),
    ),
    ArmEffect(
        "coulomb_friction",
        "torque = -coulomb_friction * sign(w)",
        {"coulomb_friction": (1e-4, 1e-3)},
        comparable=("coulomb_friction",),
    ),
    ArmEffect(
        "stiction",
        "torque = -stiction * exp(-(w / stribeck_speed)**2) * sign(w)",
        {"stiction": (1e-3, 6e-3)},
        comparable=("stiction", "stribeck_speed"),
        ranges={"stribeck_speed": (0.25, 0.7)},
    ),
    ArmEffect(
        "quadratic_drag",
        "torque = -quadratic_drag * abs(w) * w",
        {"quadratic_drag": (5e-6, 5e-5)},
        comparable=("quadratic_drag",),
    ),
    ArmEffect("backlash", "abs(arm - encoder) <= backlash / 2", {"backlash": (0.008, 0.05)}, comparable=("backlash",)),
    ArmEffect(
        "tilt",
        "torque = weight_moment * sin(angle - tilt)",
        {"tilt": (0.005, 0.04)},
        signed="tilt",
        comparable=("tilt",),
    ),
    # Not in any catalogue: a cable that twists, a magnet below the hanging arm, a table that shakes.
    ArmEffect(
        "cable_spring",
        "torque = -cable * (angle - rest)",
        {"cable": (1e-3, 8e-3)},
        is_named=False,
        ranges={"rest": (2.4, 3.7)},
    ),
    ArmEffect(
        "eddy_brake",
        "torque = -brake * exp(-((angle - pi) / brake_width)**2) * w",
        {"brake": (2e-4, 2e-3)},
        is_named=False,
        ranges={"brake_width": (0.12, 0.55)},
    ),
    ArmEffect(
        "shaking",
        "torque = shake * sin(rhythm * t)",
        {"shake": (3e-4, 2e-3)},
        is_named=False,
        ranges={"rhythm": (5.5, 14.0)},
    ),
)


def middle(effect: ArmEffect) -> dict[str, float]:
    """Parameters of an effect in the middle of their ranges, on a logarithmic scale."""
    return {n: value_at(span, 0.5) for n, span in {**effect.strengths, **effect.ranges}.items()}


@dataclass(frozen=True)
class Arm:
    """True numbers.

    Args:
        inertia: About the hinge [kg m^2].
        moment: Mass times gravity times distance of the centre from the hinge [N m].
        distance: Of the centre from the hinge [m].
        effects: Parameters of all effects together, by their names; those left out are 0.
        extra: A torque besides, or None.
    """

    inertia: float
    moment: float
    distance: float
    effects: Mapping[str, float] = field(default_factory=dict)
    extra: Torque | None = None

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
            torque -= self.of("brake") * math.exp(-(((angle - math.pi) / self.of("brake_width")) ** 2)) * speed
        if self.extra is not None:
            torque += self.extra(time, angle, speed)
        return torque + self.of("shake") * math.sin(self.of("rhythm") * time)

    def dry(self, speed: float) -> float:
        """Greatest torque of dry friction [N m]."""
        if "stiction" not in self.effects:
            return self.of("coulomb_friction")
        fall = math.exp(-((speed / self.of("stribeck_speed")) ** 2))
        return self.of("coulomb_friction") + self.of("stiction") * fall
