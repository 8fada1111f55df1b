"""From undistorted pixels to the plane in which the markers move, and back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array

#: Smaller singular value of points about their centre, relative to the larger one: below it they are on one line.
_FLAT = 1e-3
#: Condition of a homography between normalised points; of a plane that anybody can see it is below ten.
_STEEP = 1e4


@dataclass(frozen=True)
class Plane:
    """A homography from undistorted pixels (u, v) to places (y, z) [m].

    Args:
        matrix: Shape (3, 3).
        error: Root mean square distance of fiducials from where they should be [m]; 0 where four fix it exactly.
        doubt: Deviation of a coordinate that the fiducials leave to all places in common [m].
    """

    matrix: Array
    error: float = 0.0
    doubt: float = 0.0

    def places(self, pixels: Array) -> Array:
        """(y, z) [m] of pixels (points, 2)."""
        return mapped(self.matrix, pixels)

    def pixels(self, places: Array) -> Array:
        """Undistorted pixels of places (points, 2) [m]."""
        return mapped(np.asarray(np.linalg.inv(self.matrix)), places)

    def scale(self, pixels: Array) -> Array:
        """Length of a pixel [m] at each pixel, shape (points,): root of the area that one pixel covers."""
        h = self.matrix
        w = pixels @ h[2, :2] + h[2, 2]
        return np.asarray(np.sqrt(np.abs(np.linalg.det(h) / w**3)))


def plane_of_scale(scale: float, origin: tuple[float, float], y: str, z: str) -> Plane:
    """Plane of a camera that looks squarely: `scale` metres to a pixel, axes right or left, up or down."""
    along_u = scale if y == "right" else -scale
    along_v = -scale if z == "up" else scale
    u, v = origin
    return Plane(np.array([[along_u, 0.0, -along_u * u], [0.0, along_v, -along_v * v], [0.0, 0.0, 1.0]]))


def plane_of_points(pixels: Array, places: Array) -> Plane:
    """Homography through four points, or next to more of them in the least-squares sense.

    Args:
        pixels: Undistorted, shape (points, 2), at least four.
        places: (y, z) of the same points [m].

    Raises:
        ValueError: Three of four, or all, lie on one line.

    Source: normalised direct linear transformation, Hartley and Zisserman, Multiple View Geometry, algorithm 4.2.
    """
    for points in (pixels, places):
        sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if not sizes[1] > _FLAT * sizes[0]:
            raise ValueError("the points lie on one line")
    a, b = _normaliser(pixels), _normaliser(places)
    u, v = mapped(a, pixels).T
    y, z = mapped(b, places).T
    one, none = np.ones_like(u), np.zeros_like(u)
    rows = np.concatenate(
        [
            np.stack([u, v, one, none, none, none, -y * u, -y * v, -y], axis=1),
            np.stack([none, none, none, u, v, one, -z * u, -z * v, -z], axis=1),
        ]
    )
    sizes, turned = np.linalg.svd(rows)[1:]
    if not sizes[7] > _FLAT * sizes[0] * 1e-2:
        raise ValueError("three of the points lie on one line, which leaves the plane open")
    normal = turned[-1].reshape(3, 3)
    if not np.linalg.cond(normal) < _STEEP:
        raise ValueError("three of the points lie on one line, which leaves the plane open")
    matrix = np.asarray(np.linalg.inv(b) @ normal @ a, dtype=np.float64)
    found = Plane(matrix / matrix[2, 2])
    # Eight numbers are fitted: the rest of the coordinates tells the error.
    freedom = 2 * len(pixels) - 8
    apart = found.places(pixels) - places
    one = float(np.sqrt(np.sum(apart**2) / freedom)) if freedom else 0.0
    # Of a fit with eight numbers to 2 n coordinates the mean variance of a fitted coordinate is 8 / 2 n of one's own.
    return Plane(found.matrix, np.sqrt(2.0) * one, one * float(np.sqrt(4.0 / len(pixels))))


def mapped(matrix: Array, points: Array) -> Array:
    """Points (points, 2) by a homography (3, 3), of which a similarity is one."""
    lifted = points @ matrix[:, :2].T + matrix[:, 2]
    return np.asarray(lifted[:, :2] / lifted[:, 2:])


def _normaliser(points: Array) -> Array:
    """Shift and scale that put the points' centre to 0 and their mean distance from it to sqrt(2)."""
    centre = points.mean(axis=0)
    size = np.sqrt(2.0) / np.mean(np.hypot(*(points - centre).T))
    return np.array([[size, 0.0, -size * centre[0]], [0.0, size, -size * centre[1]], [0.0, 0.0, 1.0]])
