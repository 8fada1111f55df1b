"""The camera of the renderer: where a place of the plane is in the picture, and the place behind every pixel.

Written apart from `lens.py` and `plane.py`, which undo it: a fault of one cannot hide in the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from chainmail.camera.camera_file import CameraFile
from cosim.unit.protocol import Array

_NEWTON = 12
#: Pixels whose place is found to this are inverted [px].
_CLOSED = 1e-6


@dataclass(frozen=True)
class Pinhole:
    """A pinhole with a distorting lens before a plane.

    Args:
        file: What was asked for.
    """

    file: CameraFile

    @property
    def focal(self) -> float:
        """Focal length [px]."""
        return self.file.distance.to("m") / self.file.scale.to("m")

    @property
    def middle(self) -> tuple[float, float]:
        """Principal point (u, v) [px]."""
        return (self.file.width - 1) / 2.0, (self.file.height - 1) / 2.0

    def project(self, places: Array) -> Array:
        """Pixels (u, v) of places (..., 2) [m]."""
        yaw, pitch = self.file.yaw.to("rad"), self.file.pitch.to("rad")
        right = places[..., 0] - self.file.centre[0].to("m")
        down = -(places[..., 1] - self.file.centre[1].to("m"))
        # Turned about the vertical, then about the horizontal axis of the picture.
        x, depth = right * np.cos(yaw), right * np.sin(yaw)
        y, depth = down * np.cos(pitch) - depth * np.sin(pitch), down * np.sin(pitch) + depth * np.cos(pitch)
        away = depth + self.file.distance.to("m")
        a, b = x / away, y / away
        k = [*map(float, self.file.distortion), 0.0, 0.0, 0.0, 0.0, 0.0]
        square = a**2 + b**2
        swell = 1.0 + k[0] * square + k[1] * square**2 + k[4] * square**3
        bent_a = a * swell + 2.0 * k[2] * a * b + k[3] * (square + 2.0 * a**2)
        bent_b = b * swell + k[2] * (square + 2.0 * b**2) + 2.0 * k[3] * a * b
        u, v = self.middle
        return np.asarray(np.stack([self.focal * bent_a + u, self.focal * bent_b + v], axis=-1))

    def places(self) -> Array:
        """Place (y, z) behind the centre of every pixel, shape (height, width, 2) [m], by Newton's method.

        Raises:
            ValueError: The lens bends so strongly that a pixel sees no place, or several.
        """
        scale = self.file.scale.to("m")
        u, v = np.meshgrid(np.arange(self.file.width), np.arange(self.file.height))
        wanted = np.stack([u, v], axis=-1).astype(np.float64)
        found = np.stack(
            [
                self.file.centre[0].to("m") + scale * (u - self.middle[0]),
                self.file.centre[1].to("m") - scale * (v - self.middle[1]),
            ],
            axis=-1,
        )
        step = 1e-3 * scale
        for _ in range(_NEWTON):
            here = self.project(found)
            off = wanted - here
            if np.abs(off).max() < _CLOSED:
                return found
            by_y = (self.project(found + np.array([step, 0.0])) - here) / step
            by_z = (self.project(found + np.array([0.0, step])) - here) / step
            determinant = by_y[..., 0] * by_z[..., 1] - by_z[..., 0] * by_y[..., 1]
            found[..., 0] += (off[..., 0] * by_z[..., 1] - off[..., 1] * by_z[..., 0]) / determinant
            found[..., 1] += (off[..., 1] * by_y[..., 0] - off[..., 0] * by_y[..., 1]) / determinant
        raise ValueError("the lens bends so strongly that a pixel sees no place of the plane, or several")
