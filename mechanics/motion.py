"""State of all links: what a checkpoint keeps, and the woven start."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import Array
from mechanics.fabric import FabricDesign, Layout
from mechanics.half import half

#: Length units of Bullet per metre.
SCALE = 100.0


@dataclass
class Motion:
    """State of all links; the arrays are what a checkpoint keeps, in Bullet's own units so that nothing is rounded.

    Args:
        position: Shape (link, 3), centre of mass of the back half [cm].
        orientation: Shape (link, 4), quaternion x, y, z, w of the link.
        velocity: Shape (link, 3) [cm/s].
        angular_velocity: Shape (link, 3) [rad/s].
        slide: Shape (link,), bar distance less its greatest value [cm].
        slide_rate: Shape (link,) [cm/s].
    """

    position: Array
    orientation: Array
    velocity: Array
    angular_velocity: Array
    slide: Array
    slide_rate: Array

    def copy(self) -> Motion:
        """Deep copy."""
        return Motion(**{name: value.copy() for name, value in vars(self).items()})


def woven(design: FabricDesign, layout: Layout) -> Motion:
    """The flat start, at rest unless the design says otherwise."""
    n = design.links
    sine, cosine = np.sin(layout.tilt / 2), np.cos(layout.tilt / 2)
    orientation = np.zeros((n, 4))
    orientation[:, 0], orientation[:, 3] = sine, cosine
    along = np.stack([np.zeros(n), np.cos(layout.tilt), np.sin(layout.tilt)], axis=1)
    position = layout.back_bar + half(design).centre * along
    slide = layout.bar_distance - design.bar_distance_cold
    velocity = np.zeros((n, 3))
    if design.start_speed:
        speeds = np.random.default_rng(design.start_number).uniform(-1.0, 1.0, (n, 3))
        velocity[~layout.is_fixed] = SCALE * design.start_speed * speeds[~layout.is_fixed]
    return Motion(SCALE * position, orientation, velocity, np.zeros((n, 3)), SCALE * slide, np.zeros(n))


def rotation(orientation: Array) -> npt.NDArray[np.float64]:
    """Rotation matrices (link, 3, 3) of quaternions x, y, z, w (link, 4); columns are the links' x, y, z axes."""
    x, y, z, w = orientation.T
    return np.stack(
        [
            np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], -1),
            np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], -1),
            np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], -1),
        ],
        -2,
    )
