"""A camera before a rig, ready to measure: lens, plane, and what was found out about both."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import numpy as np

from chainmail.camera.detect import Detector
from chainmail.camera.frames import Frame
from chainmail.camera.lens import Lens, calibrate, pictures_in, undistorted
from chainmail.camera.plane import Plane, mapped, plane_of_points, plane_of_scale
from chainmail.camera.rig import LensEntry, PlaneEntry, Rig
from chainmail.camera.steady import Followed, Motion, nearest, similarity
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array

#: Pictures from which coloured fiducials are read.
_FIRST = 10
#: Fiducials farther from their places than this share of the largest distance between them are wrong.
_WRONG = 0.01


@dataclass(frozen=True)
class Sight:
    """How pixels become places.

    Args:
        lens: None where there is no distortion to undo.
        plane: From undistorted pixels.
        notes: What was found out, in sentences.
        followed: Coloured fiducials, which tell whether the camera stands still; None where there are none.
    """

    lens: Lens | None
    plane: Plane
    notes: tuple[str, ...] = ()
    followed: Followed | None = None

    def at(self, motion: Motion | None, picture: int) -> Sight:
        """The same in one picture of a camera that moves."""
        return self if motion is None else replace(self, plane=motion.plane(self.plane, picture))

    def places(self, pixels: Array) -> Array:
        """(y, z) [m] of pixels in the picture, shape (points, 2)."""
        if not len(pixels):
            return np.zeros((0, 2))
        return self.plane.places(undistorted(pixels, self.lens))

    def pixels(self, places: Array) -> Array:
        """Pixels in the picture of places (points, 2) [m]."""
        ideal = self.plane.pixels(places)
        return ideal if self.lens is None else self.lens.distort(ideal)

    def pixel_length(self, pixels: Array) -> Array:
        """Length [m] of a pixel at each pixel, shape (points,)."""
        if not len(pixels):
            return np.zeros(0)
        half_u, half_v = np.array([0.5, 0.0]), np.array([0.0, 0.5])
        right, down = self.places(pixels + half_u), self.places(pixels + half_v)
        left, up = self.places(pixels - half_u), self.places(pixels - half_v)
        a, b = right - left, down - up
        return np.asarray(np.sqrt(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])))


def sight_of(rig: Rig, file: Path, frames: Iterable[Frame], picture: tuple[int, int]) -> Sight:
    """The camera of a rig.

    Args:
        rig: As read.
        file: Its file, beside which folders of pictures are.
        frames: Of the video: coloured fiducials are refined in the first of them.
        picture: Width and height of its pictures.

    Raises:
        InputError: The pictures are of another size than those of the rig, the lens cannot be calibrated, a fiducial
            is not found, or they do not span a plane.
    """
    _check_picture(rig, file, picture)
    lens, notes = _lens(rig.lens, file, picture)
    plane, more, followed = _plane(rig.plane, lens, file, frames)
    return Sight(lens, plane, (*notes, *_unstated_picture(rig, picture), *more), followed)


def camera_of(lens: LensEntry | None, plane: PlaneEntry, file: Path) -> Sight:
    """The camera of pixels that another tool found: no picture is at hand to refine anything.

    Raises:
        InputError: As for `sight_of`.
    """
    found, notes = _lens(lens, file)
    own, more, _ = _plane(plane, found, file, ())
    return Sight(found, own, (*notes, *more))


def _check_picture(rig: Rig, file: Path, picture: tuple[int, int]) -> None:
    if rig.picture is None or rig.picture == picture:
        return
    raise InputError(
        file,
        "picture",
        f"the pixels of the rig count in pictures of {_text(rig.picture)}, those of the video have {_text(picture)}",
        "take the video as it was filmed, not cropped or scaled; or read the pixels of `lens` and `plane` in it anew",
    )


def _unstated_picture(rig: Rig, picture: tuple[int, int]) -> tuple[str, ...]:
    """What is not noticed where nothing says in pictures of which size the rig's pixels count."""
    if rig.picture is not None or rig.plane.colour is not None:  # coloured fiducials are looked for
        return ()
    return (
        f"picture: the rig does not say in pictures of which size its pixels count; taken to be {_text(picture)}. "
        "A video that was cropped since shifts all places alike: state `picture`",
    )


def _text(size: tuple[int, int]) -> str:
    return f"{size[0]} x {size[1]}"


def _lens(
    entry: LensEntry | None, file: Path, picture: tuple[int, int] | None = None
) -> tuple[Lens | None, tuple[str, ...]]:
    if entry is None:
        return None, ()
    if entry.chessboard is not None:
        board, key = entry.chessboard, "lens.chessboard"
        found = calibrate(pictures_in(file.parent / board.folder, key, board.pattern), board.corners, key)
        if picture not in (None, found.picture):
            raise InputError(
                file,
                key,
                f"its pictures have {_text(found.picture)} pixels, those of the video {_text(picture)}",
                "take pictures of the board as the video was filmed: a lens holds for one size and cropping",
            )
        return found.lens, (f"lens: reprojection error {found.error:.3f} px in {found.used} of {found.given} pictures",)
    focal, centre = entry.focal, entry.centre
    if focal is None or centre is None:  # refused when the file was read
        raise InputError(file, "lens", "focal and centre are missing", "give both")
    k = [float(v) for v in entry.distortion] + [0.0] * (5 - len(entry.distortion))
    return Lens((focal[0], focal[1]), (centre[0], centre[1]), (k[0], k[1], k[2], k[3], k[4])), ()


def _plane(
    entry: PlaneEntry, lens: Lens | None, file: Path, frames: Iterable[Frame]
) -> tuple[Plane, tuple[str, ...], Followed | None]:
    if entry.scale is not None and entry.origin is not None:
        origin = np.array([entry.origin], dtype=np.float64)
        ((u, v),) = undistorted(origin, lens)
        return plane_of_scale(entry.scale.to("m"), (float(u), float(v)), entry.y, entry.z), (), None
    points = entry.fiducials or []
    pixels = np.array([p.pixel for p in points], dtype=np.float64)
    places = np.array([[c.to("m") for c in p.at] for p in points])
    followed = None
    if entry.colour is not None and entry.diameter is not None:
        followed = _refined(entry.colour, entry.diameter.to("m"), pixels, places, file, frames)
        pixels = followed.reference
    straight = undistorted(pixels, lens)
    if not np.isfinite(straight).all():
        number = int(np.argmin(np.isfinite(straight).all(axis=1)))
        raise InputError(
            file,
            "lens",
            f"it cannot be undone at the pixel of fiducial {number + 1}, where it is not known",
            "take pictures of the chessboard in all corners; or correct `distortion`, or that pixel",
        )
    try:
        found = plane_of_points(straight, places)
    except (ValueError, np.linalg.LinAlgError) as error:
        raise InputError(file, "plane.fiducials", str(error), "give points that span the plane") from error
    size = float(np.max(np.linalg.norm(places[:, None] - places[None], axis=2)))
    if found.error > _WRONG * size:
        raise InputError(
            file,
            "plane.fiducials",
            f"they are off by {1e3 * found.error:.3g} mm from one plane",
            "correct `at` or `pixel` of the one that is wrong",
        )
    if len(points) == 4:
        return found, ("plane: four fiducials fix it and leave no error to be seen",), followed
    return found, (f"plane: {len(points)} fiducials, off by {1e3 * found.error:.3g} mm",), followed


def _refined(
    colour: str, diameter: float, pixels: Array, places: Array, file: Path, frames: Iterable[Frame]
) -> Followed:
    """Centres of coloured fiducials in the first pictures, brought to one of them: a hand may hold the camera."""
    apart = np.linalg.norm(pixels[0] - pixels[1:], axis=1) / np.linalg.norm(places[0] - places[1:], axis=1)
    wide = diameter * float(np.median(apart))
    detector = Detector(colour, wide, len(pixels))
    centres, areas = [], []
    for frame in islice(iter(frames), _FIRST):
        spots = detector.spots(frame.picture)
        own, area = np.full_like(pixels, np.nan), np.full(len(pixels), np.nan)
        for number, pixel in enumerate(pixels):
            best = nearest(spots, pixel, wide)
            if best is not None:
                own[number], area[number] = spots.pixels[best], spots.area[best]
        centres.append(own)
        areas.append(area)
    found = np.array(centres)
    seen: AnyArray = np.asarray(np.isfinite(found).all(axis=2))
    for lost in np.flatnonzero(~seen.any(axis=0)):
        raise InputError(
            file,
            f"plane.fiducials[{lost + 1}]",
            f"no spot that is {colour}, whole and about {wide:.0f} pixels across is near its pixel",
            "correct `pixel`, or `colour` and `diameter` of the fiducials, or `at`, whose distances say how large a "
            "pixel is; one that the border cuts, or something covers in part, is none",
        )
    return Followed(colour, _aligned(found, seen), np.nanmedian(np.array(areas), axis=0), wide)


def _aligned(found: Array, seen: AnyArray) -> Array:
    """Median of centres (pictures, fiducials, 2), each picture brought to the one that shows most of them."""
    base = int(np.argmax(seen.sum(axis=1)))
    for number in range(len(found)):
        both = seen[number] & seen[base]
        if number != base and both.sum() > 1:
            found[number] = mapped(similarity(found[number, both], found[base, both]), found[number])
    return np.asarray(np.nanmedian(found, axis=0))
