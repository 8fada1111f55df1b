"""A rigid arm on a hinge: its numbers and the laws of its friction."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

#: Numbers that may have either sign.
_SIGNED = frozenset({"tilt", "initial_angle", "initial_angular_velocity"})
#: Numbers that must not be 0.
_POSITIVE = frozenset({"mass", "centre_distance", "gravity", "stribeck_speed"})


@dataclass(frozen=True)
class PendulumDesign:
    """An arm, its hinge and its encoder. Angle 0 points up, pi hangs down.

    Friction takes energy, so its numbers are bounded below by 0; at 0 each of them is absent.

    Args:
        mass: [kg].
        centre_distance: From the hinge to the centre of mass [m].
        central_inertia: About the centre of mass, along the hinge [kg m^2].
        gravity: Magnitude [m/s^2].
        viscous_damping: b in the torque -b w [N m s/rad].
        coulomb_friction: Dry friction while it moves [N m].
        stiction: By how much dry friction at rest is larger [N m].
        stribeck_speed: Speed over which that falls off [rad/s].
        quadratic_drag: c in the torque -c |w| w of air in turbulent flow [N m s^2/rad^2].
        backlash: Play between arm and encoder [rad]: the encoder stands until the play is used up.
        tilt: How far the hanging arm stands off pi because the stand leans in the plane of the swing [rad].
        initial_angle: [rad].
        initial_angular_velocity: [rad/s].

    Raises:
        ValueError: A number is not finite, or outside its bounds.

    Source: dry friction after B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083-1138,
    equation for Stribeck friction: F_c + (F_s - F_c) exp(-(w/w_s)^2).
    """

    mass: float
    centre_distance: float
    central_inertia: float
    gravity: float = 9.80665
    viscous_damping: float = 0.0
    coulomb_friction: float = 0.0
    stiction: float = 0.0
    stribeck_speed: float = 0.05
    quadratic_drag: float = 0.0
    backlash: float = 0.0
    tilt: float = 0.0
    initial_angle: float = math.pi
    initial_angular_velocity: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value):
                raise ValueError(f"{field.name} is {value}: give a finite number")
            if field.name in _POSITIVE and not value > 0:
                raise ValueError(f"{field.name} is {value}: give a positive number")
            if field.name not in _SIGNED and value < 0:
                raise ValueError(f"{field.name} is {value}: it takes energy, so it cannot be negative")

    @property
    def inertia(self) -> float:
        """Moment of inertia about the hinge [kg m^2]."""
        return self.central_inertia + self.mass * self.centre_distance**2

    @property
    def weight_moment(self) -> float:
        """Largest moment of the weight about the hinge [N m]."""
        return self.mass * self.gravity * self.centre_distance

    def dry_friction(self, angular_velocity: float) -> float:
        """Magnitude of dry friction [N m] at an angular velocity [rad/s]."""
        if self.stiction == 0.0:
            return self.coulomb_friction
        return self.coulomb_friction + self.stiction * math.exp(-((angular_velocity / self.stribeck_speed) ** 2))

    def kinetic_energy(self, angular_velocity: float) -> float:
        """[J]."""
        return 0.5 * self.inertia * angular_velocity**2

    def potential_energy(self, angle: float) -> float:
        """[J], 0 where the arm hangs."""
        return self.weight_moment * (1.0 + math.cos(angle - self.tilt))


def behind_play(follower: float, leader: float, play: float) -> float:
    """Where a follower stands that `leader` drags through a play (full width `play`), from where it stood before.

    Source: play operator, A. Visintin, Differential Models of Hysteresis, Springer 1994, chapter III.
    """
    return min(max(follower, leader - play / 2), leader + play / 2)
