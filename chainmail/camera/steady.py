"""A camera that moves: coloured fiducials are followed through all pictures, and tell how it moved.

A bumped tripod or a hand moves the picture by a shift, a turn and a change of size, which is undone. What it leans is
not: over the few pixels of such a motion it bends the plane by far less than that.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from chainmail.camera.detect import Detector, Spots
from chainmail.camera.lens import Lens, undistorted
from chainmail.camera.plane import Plane, mapped
from cosim.unit.protocol import AnyArray, Array

#: A fiducial is sought so far around its last pixel, and may have moved so far since, in its diameters.
_AROUND, NEAR = 3.0, 1.5
#: Its area may differ so much from that of the first pictures: what covers a part of it moves its centre.
_OTHER_AREA = 0.15
#: Fewest fiducials of a picture that tell how the camera moved; three show an error too.
_FEWEST = 2
#: Pictures over whose median a motion counts: one wrong reading is none.
_LASTING = 5
#: A camera moves where a picture is shifted by more than this [px], and by more than so many deviations of a shift.
_SHIFT, _BEYOND = 0.1, 5.0


class Followed:
    """Coloured fiducials in the pictures of a video, one after the other.

    Args:
        colour: As a rig names it.
        pixels: Of the fiducials in the first pictures, shape (fiducials, 2).
        area: Of each of them there, shape (fiducials,) [px].
        wide: Their diameter [px].
    """

    def __init__(self, colour: str, pixels: Array, area: Array, wide: float) -> None:
        self.reference = pixels
        self._last, self._area, self._wide = pixels.copy(), area, wide
        self._detector = Detector(colour, wide, 1)
        self._found: list[Array] = []

    def look(self, picture: AnyArray) -> None:
        """Find them in the next picture."""
        own = np.full_like(self.reference, np.nan)
        for number, (u, v) in enumerate(self._last):
            found = self._nearest(picture, float(u), float(v), float(self._area[number]))
            if found is not None:
                own[number] = self._last[number] = found
        self._found.append(own)

    @property
    def pixels(self) -> Array:
        """Shape (pictures, fiducials, 2); not a number where one is hidden."""
        return np.array(self._found).reshape(-1, *self.reference.shape)

    def _nearest(self, picture: AnyArray, u: float, v: float, area: float) -> Array | None:
        half = int(np.ceil(_AROUND * self._wide))
        left, top = max(int(u) - half, 0), max(int(v) - half, 0)
        cut = picture[top : int(v) + half + 1, left : int(u) + half + 1]
        if min(cut.shape[:2]) < self._wide:
            return None
        spots = self._detector.spots(np.ascontiguousarray(cut))
        corner = np.array([left, top])
        best = nearest(spots, np.array([u, v]) - corner, self._wide)
        if best is None or not abs(spots.area[best] / area - 1.0) < _OTHER_AREA:
            return None
        return np.asarray(spots.pixels[best] + corner)


def nearest(spots: Spots, pixel: Array, wide: float) -> int | None:
    """Number of the spot nearest to a pixel; None where none is as near as a fiducial of this diameter [px] may be."""
    away = np.linalg.norm(spots.pixels - pixel, axis=1)
    return int(np.argmin(away)) if len(away) and away.min() < NEAR * wide else None


@dataclass(frozen=True)
class Motion:
    """How a camera moved.

    Args:
        shifts: Of the middle of the fiducials, shape (pictures, 2) [undistorted px]; not a number where fewer than
            two are seen.
        matrices: From the undistorted pixels of each picture to those of the first ones, shape (pictures, 3, 3); the
            identity where the camera stands still.
        error: Of the place that all markers of a picture share, shape (pictures,) [px]; 0 where it stands still.
        left: What a shift, a turn and a change of size leave of the fiducials, root mean square [px].
        is_moving: Whether it moves.
    """

    shifts: Array
    matrices: Array
    error: Array
    left: float
    is_moving: bool

    @property
    def known(self) -> AnyArray:
        """Pictures that show enough fiducials, shape (pictures,)."""
        return np.asarray(np.isfinite(self.shifts).all(axis=1))

    def plane(self, plane: Plane, picture: int) -> Plane:
        """The plane of the markers in one picture."""
        return replace(plane, matrix=plane.matrix @ self.matrices[picture]) if self.is_moving else plane


def motion_of(pixels: Array, reference: Array, lens: Lens | None) -> Motion | None:
    """The motion of a camera from its fiducials; None where too few pictures show them.

    Args:
        pixels: Shape (pictures, fiducials, 2); not a number where one is hidden.
        reference: The same in the first pictures, shape (fiducials, 2).
        lens: None where there is no distortion to undo.
    """
    straight = undistorted(pixels.reshape(-1, 2), lens).reshape(pixels.shape)
    first = undistorted(reference, lens)
    count = len(pixels)
    shifts, matrices = np.full((count, 2), np.nan), np.tile(np.eye(3), (count, 1, 1))
    squares, freedom = 0.0, 0
    seen: AnyArray = np.asarray(np.isfinite(straight).all(axis=2))
    for number in np.flatnonzero(seen.sum(axis=1) >= _FEWEST):
        own = seen[number]
        matrix = similarity(straight[number, own], first[own])
        squares += float(np.sum((mapped(matrix, straight[number, own]) - first[own]) ** 2))
        freedom += max(2 * int(own.sum()) - 4, 0)
        matrices[number] = matrix
        middle = first.mean(axis=0)
        shifts[number] = np.linalg.solve(matrix[:2, :2], middle - matrix[:2, 2]) - middle
    left = float(np.sqrt(squares / freedom)) if freedom else float("nan")
    known = np.isfinite(shifts).all(axis=1)
    if known.sum() < _LASTING:
        return None
    lasting = median_filter(shifts[known], size=(_LASTING, 1), mode="nearest")
    scatter = float(np.median(np.abs(shifts[known] - lasting))) / 0.6745
    is_moving = bool(np.max(np.abs(lasting)) > max(_SHIFT, _BEYOND * scatter / np.sqrt(_LASTING)))
    if not is_moving:
        return Motion(shifts, np.tile(np.eye(3), (count, 1, 1)), np.zeros(count), left, False)
    error = np.where(seen.any(axis=1), np.nan_to_num(left, nan=_SHIFT) / np.sqrt(np.maximum(seen.sum(axis=1), 1)), 0.0)
    return Motion(shifts, matrices, error, left, True)


def similarity(points: Array, goals: Array) -> Array:
    """Shift, turn and size that bring points next to their goals in the least-squares sense, shape (3, 3).

    Source: Umeyama, IEEE Transactions on Pattern Analysis 13 (1991) 376, in the complex plane.
    """
    a, b = points @ np.array([1.0, 1j]), goals @ np.array([1.0, 1j])
    from_middle = a - a.mean()
    turn = np.vdot(from_middle, b - b.mean()) / np.vdot(from_middle, from_middle)
    shift = b.mean() - turn * a.mean()
    return np.array([[turn.real, -turn.imag, shift.real], [turn.imag, turn.real, shift.imag], [0.0, 0.0, 1.0]])
