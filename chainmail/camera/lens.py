"""Brown's model of a lens, and its calibration from pictures of a chessboard."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from chainmail.camera.opencv import opencv
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array

#: Steps of the fixed-point iteration that undoes a distortion; each gains about a digit with ordinary lenses.
_STEPS = 30
#: A point that is not undone to this is beyond what the model can be inverted for [focal lengths].
_CLOSED = 1e-7
#: Fewest pictures from which a lens is taken.
FEWEST_BOARDS = 6
#: A picture whose corners are off by so many times the median of all is blurred, or its board moved: it is left out.
_BLURRED = 2.5
#: Half of the window in which a corner is refined [px].
_AROUND = 5
#: Text, and the number that follows it.
_PIECES = re.compile(r"(\D*)(\d*)")
ENDINGS = (".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff")


@dataclass(frozen=True)
class Lens:
    """Intrinsics of a camera.

    Args:
        focal: Focal lengths along u and v [px].
        centre: Principal point (u, v) [px].
        distortion: k1, k2, p1, p2, k3.

    Source: D. C. Brown, Photogrammetric Engineering 32 (1966) 444-462, in the order of OpenCV.
    """

    focal: tuple[float, float]
    centre: tuple[float, float]
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)

    def distort(self, pixels: Array) -> Array:
        """Where an ideal camera's pixels are in the picture, shape (points, 2) [px]."""
        x, y = ((pixels - self.centre) / self.focal).T
        moved = np.stack(self._bent(x, y), axis=1)
        return np.asarray(moved * self.focal + self.centre)

    def undistort(self, pixels: Array) -> Array:
        """Pixels of an ideal camera with the same focal length, shape (points, 2) [px]; not a number where none is."""
        if not any(self.distortion):
            return np.asarray(pixels, dtype=np.float64)
        target = (pixels - np.asarray(self.centre)) / np.asarray(self.focal)
        x, y = target.T
        with np.errstate(over="ignore", invalid="ignore"):
            for _ in range(_STEPS):
                bent_x, bent_y = self._bent(x, y)
                x, y = x + target[:, 0] - bent_x, y + target[:, 1] - bent_y
            bent_x, bent_y = self._bent(x, y)
            is_closed = np.hypot(bent_x - target[:, 0], bent_y - target[:, 1]) < _CLOSED
        found = np.stack([x, y], axis=1) * self.focal + self.centre
        return np.asarray(np.where(is_closed[:, None], found, np.nan))

    def _bent(self, x: Array, y: Array) -> tuple[Array, Array]:
        k1, k2, p1, p2, k3 = self.distortion
        r2 = x * x + y * y
        radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
        return (
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        )


def undistorted(pixels: Array, lens: Lens | None) -> Array:
    """Pixels (points, 2) without the distortion of a lens; as they are where there is none to undo."""
    return pixels if lens is None else lens.undistort(pixels)


@dataclass(frozen=True)
class Calibration:
    """A lens from pictures of a chessboard.

    Args:
        lens: The lens.
        error: Root mean square distance of corners from where the lens puts them [px].
        used: Number of pictures in which the whole board was found and is sharp.
        given: Number of pictures.
        picture: Width and height of each [px].
    """

    lens: Lens
    error: float
    used: int
    given: int
    picture: tuple[int, int]


def pictures_in(folder: Path, key: str, pattern: str = "*") -> list[Path]:
    """Pictures of a folder, in the order of their names; numbers in them count as numbers: 2 comes before 10.

    Raises:
        InputError: There is no such folder, or it holds no picture.
    """
    if not folder.is_dir():
        raise InputError(folder, key, "there is no such folder", "give a folder of pictures")
    found = [p for p in folder.glob(pattern) if p.suffix.lower() in ENDINGS and p.is_file()]
    if not found:
        raise InputError(
            folder, key, f"it holds no picture `{pattern}`", f"give files that end in {', '.join(ENDINGS)}"
        )
    return sorted(found, key=lambda p: ([(t, int(n or -1)) for t, n in _PIECES.findall(p.name)], p.name))


def calibrate(files: list[Path], corners: tuple[int, int], key: str) -> Calibration:
    """The lens that put the corners of a flat chessboard where they are in the pictures.

    Args:
        files: Pictures of one size, the board in many places and leaning in many directions.
        corners: Inner corners along both sides.
        key: Of the rig file, for errors.

    Raises:
        InputError: A picture cannot be read or has another size, or too few show the whole board.

    Source: Z. Zhang, IEEE Transactions on Pattern Analysis and Machine Intelligence 22 (2000) 1330-1334.
    """
    boards, size = _boards(files, corners, key)
    if len(boards) < FEWEST_BOARDS:
        what = (
            f"a board with {corners[0]} x {corners[1]} inner corners is found in {len(boards)} of {len(files)} pictures"
        )
        raise InputError(
            files[0].parent,
            key,
            f"{what}; at least {FEWEST_BOARDS} are needed",
            "correct `corners`, or take sharper pictures of the whole board",
        )
    lens, error, each = _fitted(boards, corners, size)
    kept = [b for b, own in zip(boards, each) if own <= _BLURRED * float(np.median(each))]
    if FEWEST_BOARDS <= len(kept) < len(boards):
        lens, error, each = _fitted(kept, corners, size)
        boards = kept
    return Calibration(lens, error, len(boards), len(files), size)


def _boards(files: list[Path], corners: tuple[int, int], key: str) -> tuple[list[AnyArray], tuple[int, int]]:
    """Corners of the board in every picture that shows all of it, and width and height of the pictures."""
    cv2 = opencv()
    found, size = [], None
    for file in files:
        picture = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
        if picture is None:
            raise InputError(file, key, "this picture cannot be read", "leave it out, or save it anew")
        own = (int(picture.shape[1]), int(picture.shape[0]))
        if size not in (None, own):
            raise InputError(
                file,
                key,
                f"it has {own[0]} x {own[1]} pixels, others have {size[0]} x {size[1]}",
                "use pictures of one camera and setting",
            )
        size = own
        is_there, places = cv2.findChessboardCorners(
            picture, corners, flags=cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE
        )
        if is_there:
            stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 60, 1e-3)
            places = cv2.cornerSubPix(picture, places, (_AROUND, _AROUND), (-1, -1), stop)
            found.append(np.asarray(places, dtype=np.float32).reshape(-1, 1, 2))
    return found, size or (0, 0)


def _fitted(boards: list[AnyArray], corners: tuple[int, int], size: tuple[int, int]) -> tuple[Lens, float, Array]:
    """Lens, root mean square error over all corners [px], and that of every picture."""
    cv2 = opencv()
    board = np.zeros((corners[0] * corners[1], 3), dtype=np.float32)
    board[:, :2] = np.mgrid[0 : corners[0], 0 : corners[1]].T.reshape(-1, 2)
    fit = cv2.calibrateCameraExtended([board] * len(boards), boards, size, None, None)
    matrix, k = fit[1], [float(v) for v in np.asarray(fit[2]).ravel()[:5]]
    lens = Lens(
        (float(matrix[0, 0]), float(matrix[1, 1])),
        (float(matrix[0, 2]), float(matrix[1, 2])),
        (k[0], k[1], k[2], k[3], k[4]),
    )
    return lens, float(fit[0]), np.asarray(fit[-1], dtype=np.float64).ravel()
