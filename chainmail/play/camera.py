"""From where a picture is taken; the same views as on the page (`web/scene.js`)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from chainmail.play.film import Film
from cosim.unit.protocol import Array

#: View to azimuth and elevation [rad]: at 0, 0 seen from +x, with y to the right and z up.
VIEWS = {
    "oblique": (-0.55, 0.42),
    "side": (0.0, 0.0),
    "top": (0.0, math.pi / 2 - 1e-3),
    "front": (-math.pi / 2, 0.0),
}
#: Angle of view from the lower to the upper edge [rad].
ANGLE = 0.5


@dataclass(frozen=True)
class Camera:
    """A perspective camera.

    Args:
        eye: Where it stands [m].
        axes: Rows: directions of the picture to the right, up, and towards the viewer, shape (3, 3).
        size: Width and height of the picture [px].
    """

    eye: Array
    axes: Array
    size: tuple[int, int]

    @property
    def focal(self) -> float:
        """Focal length [px]."""
        return self.size[1] / 2 / math.tan(ANGLE / 2)

    def project(self, points: Array) -> Array:
        """Column, row [px] and distance along the line of sight [m] of points, shape (..., 3)."""
        seen = (points - self.eye) @ self.axes.T
        depth = -seen[..., 2]
        column = self.size[0] / 2 + self.focal * seen[..., 0] / depth
        return np.stack([column, self.size[1] / 2 - self.focal * seen[..., 1] / depth, depth], axis=-1)

    def rays(self, columns: slice, rows: slice) -> Array:
        """Directions [m per metre of depth] through the middles of pixels, shape (rows, columns, 3)."""
        right = (np.arange(columns.start, columns.stop) + 0.5 - self.size[0] / 2) / self.focal
        up = (self.size[1] / 2 - np.arange(rows.start, rows.stop) - 0.5) / self.focal
        return np.asarray(right[None, :, None] * self.axes[0] + up[:, None, None] * self.axes[1] - self.axes[2])


@dataclass(frozen=True)
class Reach:
    """Where a film takes place.

    Args:
        corners: Outermost middles of links of all frames [m], shape (corners, 3).
        margin: How far a link reaches from its middle [m].
    """

    corners: Array
    margin: float


def reach_of(film: Film) -> Reach:
    """The outermost links of all fabrics and frames: those farthest in one of many directions."""
    points = np.concatenate([f.position.reshape(-1, 3) for f in film.fabrics])
    steps = np.array([[x, y, z] for x in (-2, -1, 0, 1, 2) for y in (-2, -1, 0, 1, 2) for z in (-2, -1, 0, 1, 2)])
    farthest = np.unique(np.argmax(points @ steps.T, axis=0))
    margin = max(float(f.bar_distance.max() + f.shape.bar_diameter) / 2 for f in film.fabrics)
    return Reach(points[farthest], margin)


def camera(view: str, reach: Reach, size: tuple[int, int]) -> Camera:
    """A camera that just sees everything.

    Args:
        view: One of `VIEWS`.
        reach: What it must see.
        size: Width and height of the picture [px].
    """
    azimuth, elevation = VIEWS[view]
    sa, ca, se, ce = math.sin(azimuth), math.cos(azimuth), math.sin(elevation), math.cos(elevation)
    axes = np.array([[-sa, ca, 0.0], [-ca * se, -sa * se, ce], [ca * ce, sa * ce, se]])
    seen = reach.corners @ axes.T
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    half = np.abs(seen - middle)[:, :2] + reach.margin
    tangent = math.tan(ANGLE / 2) * np.array([size[0] / size[1], 1.0])
    distance = float(np.max((half / tangent).max(axis=1) + seen[:, 2] - middle[2])) + reach.margin
    return Camera((middle + np.array([0.0, 0.0, distance])) @ axes, axes, size)
