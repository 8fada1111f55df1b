"""A rigid arm on a hinge: its numbers and the laws of its friction."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

#: Numbers that may have either sign.
_SIGNED = frozenset(
    {
        "tilt",
        "initial_angle",
        "initial_angular_velocity",
        "spring_stiffness",
        "spring_rest",
        "periodic_torque",
        "periodic_phase",
        "constant_torque",
    }
)
#: Numbers that must not be 0.
_POSITIVE = frozenset({"mass", "centre_distance", "gravity", "stribeck_speed", "band_width"})


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
        cubic_drag: c in the torque -c w^3 [N m s^3/rad^3].
        spring_stiffness: k in the torque -k (angle - spring_rest) [N m/rad]; either sign: a magnet pushes.
        spring_rest: Angle at which that spring is at rest [rad].
        band_damping: b in the torque -b exp(-((angle - pi) / band_width)^2) w [N m s/rad].
        band_width: See there [rad].
        periodic_torque: Amplitude of an outer torque, that of sin(periodic_rate t + periodic_phase) [N m].
        periodic_rate: [rad/s].
        periodic_phase: [rad].
        constant_torque: Outer torque [N m].
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
    cubic_drag: float = 0.0
    spring_stiffness: float = 0.0
    spring_rest: float = math.pi
    band_damping: float = 0.0
    band_width: float = 0.5
    periodic_torque: float = 0.0
    periodic_rate: float = 0.0
    periodic_phase: float = 0.0
    constant_torque: float = 0.0
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

    def turning(self, friction: float, speed: float, free: float, step: float) -> float | None:
        """Torque of dry friction in a step in which the arm turns back; None where it does not turn, or may stick.

        It acts one way before the turn and the other way after, which one motor over a whole step cannot.

        Args:
            friction: Magnitude [N m].
            speed: Before the step [rad/s].
            free: All other torque [N m].
            step: [s].
        """
        following = speed + step * free / self.inertia
        if friction == 0.0 or speed * following >= 0.0 or abs(free) <= 2.0 * friction:
            return None
        before = abs(speed) / (abs(speed) + abs(following))
        return -math.copysign(friction, speed) * (2.0 * before - 1.0)

    @property
    def has_smooth_law(self) -> bool:
        """Whether any torque but weight and dry friction acts by itself."""
        return any(
            (
                self.viscous_damping,
                self.quadratic_drag,
                self.cubic_drag,
                self.spring_stiffness,
                self.band_damping,
                self.periodic_torque,
                self.constant_torque,
            )
        )

    def smooth_torque(self, time: float, angle: float, angular_velocity: float) -> float:
        """Torque of all laws but weight and dry friction [N m], at a time [s], an angle and a rate in radians."""
        w = angular_velocity
        found = (
            self.constant_torque - (self.viscous_damping + self.quadratic_drag * abs(w) + self.cubic_drag * w * w) * w
        )
        if self.spring_stiffness:
            found -= self.spring_stiffness * (angle - self.spring_rest)
        if self.band_damping:
            found -= self.band_damping * math.exp(-(((angle - math.pi) / self.band_width) ** 2)) * w
        if self.periodic_torque:
            found += self.periodic_torque * math.sin(self.periodic_rate * time + self.periodic_phase)
        return found

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
