"""Rigid half of a link: one bar and two arm stubs, with mass, centre of mass and inertia."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mechanics.fabric import FabricDesign


@dataclass(frozen=True)
class Half:
    """Half a link in its own frame: x along the bar, y along the arms away from the bar, z normal to the link.

    Args:
        mass: Mass [kg].
        centre: Distance from the bar's axis to the centre of mass [m].
        inertia: Principal moments about the centre of mass (x, y, z) [kg m^2].
        bar_radius: Radius of the bar [m].
        bar_length: Length of the bar [m].
        arm_x: Distance of each arm's axis from the middle [m].
        arm_size: Size of an arm along (x, y, z) [m]; it begins at the bar's axis.
    """

    mass: float
    centre: float
    inertia: tuple[float, float, float]
    bar_radius: float
    bar_length: float
    arm_x: float
    arm_size: tuple[float, float, float]


def half(design: FabricDesign) -> Half:
    """Half of a link of uniform density: the arms of two halves meet in the middle when the link is at its outer stop.

    Args:
        design: Fabric.

    Source: parallel-axis theorem over one solid cylinder and two solid cuboids, scaled to half the link's mass.
    """
    d, w = design.bar_diameter, design.outer_width
    arm = design.bar_distance_cold / 2
    bar_volume, arm_volume = math.pi / 4 * d**2 * w, d**2 * arm
    density = design.link_mass / 2 / (bar_volume + 2 * arm_volume)
    bar_mass, arm_mass = density * bar_volume, density * arm_volume
    centre = 2 * arm_mass * (arm / 2) / (bar_mass + 2 * arm_mass)
    arm_x = (w - d) / 2
    across_bar = bar_mass * (d**2 / 16 + w**2 / 12)
    along_bar = bar_mass * d**2 / 8
    from_arm = 2 * arm_mass * (arm / 2 - centre) ** 2 + bar_mass * centre**2
    inertia = (
        along_bar + 2 * arm_mass * (arm**2 + d**2) / 12 + from_arm,
        across_bar + 2 * arm_mass * (d**2 / 6 + arm_x**2),
        across_bar + 2 * arm_mass * ((arm**2 + d**2) / 12 + arm_x**2) + from_arm,
    )
    return Half(design.link_mass / 2, centre, inertia, d / 2, w, arm_x, (d, arm, d))
