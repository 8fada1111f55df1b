"""Frames of a video file or of a folder of pictures, and when each was taken."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd  # type: ignore[import-untyped]

from chainmail.camera.lens import pictures_in
from chainmail.camera.opencv import opencv
from chainmail.camera.rig import ClockEntry
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import conversion

#: Relative difference of two rates from which both are said: 29.97 and 30 per second are one.
_OTHER_RATE = 0.005
_NUMBER = re.compile(r"\d+")


@dataclass(frozen=True)
class Frame:
    """One picture.

    Args:
        picture: Blue, green, red, shape (height, width, 3), bytes.
        stamp: Time stamp that the video file gives [s]; not a number for pictures of a folder.
        is_repeated: Whether it is the picture before it, bit for bit.
    """

    picture: AnyArray
    stamp: float = math.nan
    is_repeated: bool = False


class Frames:
    """The frames of a video file or of a folder.

    Args:
        source: File or folder.

    Raises:
        InputError: It does not exist, or holds no video or picture that can be read.
    """

    def __init__(self, source: Path) -> None:
        self.source = source
        self.files = pictures_in(source, "") if source.is_dir() else []
        #: Frames per second and number of frames that the video file states; 0 for a folder.
        self.rate, self.stated = 0.0, 0
        #: Frames that the last pass could read.
        self.read = 0
        first = next(iter(self), None)
        if first is None:
            raise InputError(source, "", "no frame of it can be read", "give a video that OpenCV decodes, or a folder")
        self.shape = first.picture.shape

    def __iter__(self) -> Iterator[Frame]:
        previous: AnyArray | None = None
        for frame in self._pictures() if self.files else self._video():
            yield Frame(frame.picture, frame.stamp, previous is not None and _is_same(frame.picture, previous))
            previous = frame.picture

    @property
    def is_cut(self) -> bool:
        """Whether the last pass could read fewer frames than the file states; what it read last was left out."""
        return self.read < self.stated

    def jump(self) -> tuple[str, str] | None:
        """Two neighbours of a folder between whose numbers others are missing; None where none are.

        Only where the names differ in one number alone, and their numbers rise by the same amount elsewhere.
        """
        names = [(_NUMBER.split(f.stem), [int(n) for n in _NUMBER.findall(f.stem)]) for f in self.files]
        if len({tuple(text) for text, _ in names}) != 1:
            return None
        numbers = np.array([n for _, n in names], dtype=np.float64)
        changing = np.flatnonzero(np.any(numbers != numbers[0], axis=0))
        if len(changing) != 1:
            return None
        step = np.diff(numbers[:, changing[0]])
        far = np.flatnonzero(step != np.min(step))
        return (self.files[far[0]].name, self.files[far[0] + 1].name) if len(far) else None

    def _pictures(self) -> Iterator[Frame]:
        cv2, shape = opencv(), None
        for file in self.files:
            picture = cv2.imread(str(file), cv2.IMREAD_COLOR)
            if picture is None:
                raise InputError(file, "", "this picture cannot be read", "save it anew, or remove it from the folder")
            if shape not in (None, picture.shape):
                raise InputError(
                    file,
                    "",
                    f"it has {picture.shape[1]} x {picture.shape[0]} pixels, those before {shape[1]} x {shape[0]}",
                    "give pictures of one size",
                )
            shape = picture.shape
            yield Frame(picture)

    def _video(self) -> Iterator[Frame]:
        cv2 = opencv()
        if not self.source.is_file():
            raise InputError(self.source, "", "there is no such file or folder", "give a video or a folder of pictures")
        video = cv2.VideoCapture(str(self.source))
        last: Frame | None = None
        self.read = 0
        try:
            self.rate = float(video.get(cv2.CAP_PROP_FPS)) if video.isOpened() else 0.0
            self.stated = int(max(video.get(cv2.CAP_PROP_FRAME_COUNT), 0.0)) if video.isOpened() else 0
            while video.isOpened():
                is_read, picture = video.read()
                if not is_read:
                    break
                if last is not None:
                    yield last
                self.read += 1
                last = Frame(picture, float(video.get(cv2.CAP_PROP_POS_MSEC)) / 1000.0)
            # Where a file breaks off, decoders fill up its last picture from the one before.
            if last is not None and not self.is_cut:
                yield last
        finally:
            video.release()


def _is_same(one: AnyArray, other: AnyArray) -> bool:
    middle = len(one) // 2  # one line tells most pictures apart
    return np.array_equal(one[middle], other[middle]) and np.array_equal(one, other)


def frame_times(clock: ClockEntry, stamps: Array, rate: float, rig: Path, video: Path) -> tuple[Array, str]:
    """Middle of the exposure of every frame on the scenario's clock [s], and where the times are from.

    Args:
        clock: Of the rig.
        stamps: Time stamps of the video file, shape (frames,) [s]; not numbers for a folder.
        rate: Frames per second that the video file states.
        rig: Rig file, for paths and errors.
        video: For errors.

    Raises:
        InputError: There are no times, they do not rise, or are not as many as the frames.
    """
    count = len(stamps)
    if clock.rate is not None:
        own = clock.rate.to("Hz")
        times, said = np.arange(count) / own, f"{clock.rate} of the rig file{_other_rate(own, rate)}"
    elif clock.stamps is not None:
        times, said = _stamps(clock, rig, count), f"time stamps of {clock.stamps}"
    elif count > 1 and np.all(np.diff(stamps) > 0.0):
        times, said = stamps - stamps[0], f"time stamps of the video ({rate:.6g} frames per second)"
    else:
        raise InputError(rig, "clock", f"{video} says no times of its frames", "give `rate` or `stamps`")
    if np.any(np.diff(times) <= 0.0):
        late = int(np.argmax(np.diff(times) <= 0.0))
        what = f"times do not rise: {times[late]:.6g} s, then {times[late + 1]:.6g} s"
        raise InputError(rig, "clock.stamps", what, "correct the table of time stamps")
    exposure = clock.exposure.to("s")
    if count > 1 and exposure > 1.001 * float(np.min(np.diff(times))):
        raise InputError(
            rig,
            "clock.exposure",
            f"{clock.exposure} is longer than the shortest time between frames",
            "correct it, or the times",
        )
    to_middle = {"begin": 0.5, "middle": 0.0, "end": -0.5}[clock.stamp] * exposure
    return times + (to_middle + clock.offset.to("s")), said


def _other_rate(own: float, rate: float) -> str:
    """What the video file says of its rate where the rig file says something else."""
    if not rate > 0.0 or abs(rate / own - 1.0) < _OTHER_RATE:
        return ""
    return (
        f", though the video says {rate:.6g} frames per second: right where it is played faster or slower than it was "
        "filmed; else leave out `rate`"
    )


def _stamps(clock: ClockEntry, rig: Path, count: int) -> Array:
    file = rig.parent / str(clock.stamps)
    try:
        column = pd.read_csv(file)[clock.column].to_numpy(dtype=np.float64)
        factor = conversion(clock.unit, "s")[0]
    except KeyError as error:
        raise InputError(file, "", f"there is no column `{clock.column}`", "correct clock.column of the rig") from error
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError(file, "", f"it cannot be read as time stamps: {why}", "correct clock.stamps") from error
    if len(column) != count or not np.isfinite(column).all():
        raise InputError(file, "", f"it has {int(np.isfinite(column).sum())} times for {count} frames", "give one each")
    return np.asarray(factor * column)
