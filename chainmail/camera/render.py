"""Pictures of a fabric's side as a camera takes them: the truth against which tracking is measured."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from chainmail.camera.camera_file import CameraFile, Rod
from chainmail.camera.colours import rgb
from chainmail.camera.pinhole import Pinhole
from cosim.unit.protocol import AnyArray, Array

#: Instants within an exposure.
_INSTANTS = 5
#: Exponent with which cameras code brightness.
_GAMMA = 2.2
#: Width and grey of a link's side, grey of the wall, and of a rod (share of white, as coded).
_LINK_WIDTH, _LINK, _WALL, _ROD = 7.0e-3, 0.38, 0.72, 0.16
#: Fiducials: blue, so wide, at these shares of the picture's width and height.
FIDUCIAL_COLOUR, FIDUCIAL_DIAMETER = "blue", 8e-3
_FIDUCIALS = ((0.06, 0.07), (0.94, 0.07), (0.06, 0.93), (0.94, 0.93), (0.5, 0.06), (0.5, 0.94))


@dataclass(frozen=True)
class Motion:
    """Places of markers over time.

    Args:
        times: Rising, shape (samples,) [s], at least four.
        places: (y, z), shape (samples, markers, 2) [m]; back and front marker of row 1, then of row 2.
    """

    times: Array
    places: Array


class Renderer:
    """Renders frames of a motion.

    Args:
        file: The camera.
        motion: What moves.
        seed: Of noise and of the wall's texture.

    Raises:
        ValueError: The camera sees no frame of the motion, or its lens cannot be inverted.
    """

    def __init__(self, file: CameraFile, motion: Motion, seed: int) -> None:
        self.file, self.motion, self._seed = file, motion, seed
        self._camera = Pinhole(file)
        self._course = CubicSpline(motion.times, motion.places, axis=0)
        period, exposure = 1.0 / file.rate.to("Hz"), file.exposure.to("s")
        if exposure > period:
            raise ValueError(f"the exposure, {file.exposure}, is longer than a frame at {file.rate}")
        begin = float(motion.times[0]) if file.begin is None else file.begin.to("s")
        end = float(motion.times[-1]) if file.end is None else file.end.to("s")
        if begin < motion.times[0] - 1e-9 or end > motion.times[-1] + 1e-9:
            raise ValueError(f"the motion lasts from {motion.times[0]:.6g} s to {motion.times[-1]:.6g} s only")
        count = int(np.floor((end - exposure - begin) / period + 1e-9)) + 1
        if count < 1:
            raise ValueError("no exposure fits between begin and end")
        #: Begin of every exposure [s], shape (frames,).
        self.begins = begin + period * np.arange(count)
        self._places = self._camera.places()
        down = np.asarray(np.gradient(self._places, axis=0))
        right = np.asarray(np.gradient(self._places, axis=1))
        area = right[..., 0] * down[..., 1] - right[..., 1] * down[..., 0]
        self._pixel: AnyArray = np.sqrt(np.abs(area))
        self._wall = self._still()
        self._light = self._lighting()

    @property
    def middles(self) -> Array:
        """Middle of every exposure [s], shape (frames,)."""
        return np.asarray(self.begins + self.file.exposure.to("s") / 2.0)

    def truth(self) -> Array:
        """Places of the markers in the middle of every exposure, shape (frames, markers, 2) [m]."""
        return np.asarray(self._course(self.middles))

    @property
    def focal(self) -> float:
        """Focal length [px]."""
        return self._camera.focal

    @property
    def middle(self) -> tuple[float, float]:
        """Principal point (u, v) [px]."""
        return self._camera.middle

    def fiducials(self) -> Array:
        """Places of the fiducials, shape (6, 2) [m], on whole millimetres."""
        high, wide = self.file.height - 1, self.file.width - 1
        at = [self._places[round(v * high), round(u * wide)] for u, v in _FIDUCIALS]
        return np.asarray(np.round(np.array(at), 3))

    def project(self, places: Array) -> Array:
        """Pixels of places (points, 2) [m]."""
        return self._camera.project(places)

    def frames(self) -> Iterator[AnyArray]:
        """Frames one by one, shape (height, width, 3), bytes in the order blue, green, red."""
        exposure = self.file.exposure.to("s")
        for number, begin in enumerate(self.begins.tolist()):
            random = np.random.default_rng([self._seed, number])
            middles = (np.arange(_INSTANTS) + 0.5) / _INSTANTS
            instants = begin + exposure * (middles if exposure else middles[:1])
            seen = 255.0 * np.clip(self._exposed(instants) * self._light, 0.0, 1.5) ** np.float32(1.0 / _GAMMA)
            if self.file.noise:
                seen += np.float32(self.file.noise) * random.standard_normal(seen.shape, dtype=np.float32)
            yield np.clip(np.round(seen), 0, 255).astype(np.uint8)

    def _exposed(self, instants: Array) -> AnyArray:
        """Mean light from every pixel over instants, shape (height, width, 3), linear."""
        cut = self._moving(instants)
        picture, total = self._wall.copy(), np.zeros_like(self._wall[cut])
        for time in instants.tolist():
            picture[cut] = self._wall[cut]
            self._draw(picture, time)
            total += picture[cut]
        picture[cut] = total / len(instants)
        return picture

    def _moving(self, instants: Array) -> tuple[slice, slice]:
        """The part of the picture in which something moves."""
        if any(r.begin.to("s") <= t <= r.end.to("s") for r in self.file.rods for t in instants.tolist()):
            return slice(0, self.file.height), slice(0, self.file.width)
        cut = self._window(self._course(instants).reshape(-1, 2), max(_LINK_WIDTH, self.file.diameter.to("m")))
        return (slice(0, 0), slice(0, 0)) if cut is None else cut

    def _draw(self, picture: AnyArray, time: float) -> None:
        """Everything that moves, at one instant."""
        markers = self._course(time)
        for back, front in zip(markers[0::2], markers[1::2]):
            self._draw_bar(picture, back, front, _LINK_WIDTH / 2.0, _grey(_LINK))
        for marker in markers:
            self._draw_disc(picture, marker, self.file.diameter.to("m") / 2.0, _paint(self.file.colour))
        for rod in self.file.rods:
            self._draw_rod(picture, rod, time)

    def _still(self) -> AnyArray:
        """What does not move: a wall with a faint texture, and fiducials."""
        random = np.random.default_rng([self._seed, 2**31])
        coarse = random.standard_normal((self.file.height // 24 + 2, self.file.width // 24 + 2))
        texture = np.kron(coarse, np.ones((24, 24)))[: self.file.height, : self.file.width]
        grey = _WALL + 0.015 * texture
        picture: AnyArray = np.repeat((np.clip(grey, 0.0, 1.0) ** _GAMMA)[..., None], 3, axis=2).astype(np.float32)
        if self.file.fiducials:
            for place in self.fiducials():
                self._draw_disc(picture, place, FIDUCIAL_DIAMETER / 2.0, _paint(FIDUCIAL_COLOUR))
        return picture

    def _lighting(self) -> Array:
        across = np.linspace(-0.5, 0.5, self.file.width)[None, :, None]
        return np.asarray(self.file.light * (1.0 + self.file.gradient * across), dtype=np.float32)

    def _draw_disc(self, picture: AnyArray, centre: Array, radius: float, colour: Array) -> None:
        cut = self._window(centre[None], radius)
        if cut is not None:
            away = np.hypot(*np.moveaxis(self._places[cut] - centre, -1, 0))
            _blend(picture, cut, np.clip(0.5 - (away - radius) / self._pixel[cut], 0.0, 1.0), colour)

    def _draw_bar(self, picture: AnyArray, first: Array, second: Array, half: float, colour: Array) -> None:
        cut = self._window(np.stack([first, second]), half)
        if cut is None:
            return
        along = second - first
        apart = self._places[cut] - first
        part = np.clip(apart @ along / (along @ along), 0.0, 1.0)
        away = np.hypot(*np.moveaxis(apart - part[..., None] * along, -1, 0))
        _blend(picture, cut, np.clip(0.5 - (away - half) / self._pixel[cut], 0.0, 1.0), colour)

    def _draw_rod(self, picture: AnyArray, rod: Rod, time: float) -> None:
        begin, end = rod.begin.to("s"), rod.end.to("s")
        if not begin <= time <= end:
            return
        part = (time - begin) / (end - begin)
        start, stop = (np.array([c.to("m") for c in p]) for p in (rod.start, rod.stop))
        middle, angle = (1.0 - part) * start + part * stop, rod.direction.to("rad")
        reach = 2.0 * max(self.file.width, self.file.height) * self.file.scale.to("m")
        along = reach * np.array([np.cos(angle), np.sin(angle)])
        self._draw_bar(picture, middle - along, middle + along, rod.width.to("m") / 2.0, _grey(_ROD))

    def _window(self, points: Array, margin: float) -> tuple[slice, slice] | None:
        """The part of the picture that holds points with a margin [m]; None where it is outside."""
        corners = np.concatenate([points + margin * np.array(d) for d in ((-1, -1), (-1, 1), (1, -1), (1, 1))])
        pixels = self._camera.project(corners)
        low = np.maximum(np.floor(pixels.min(axis=0)).astype(int) - 3, 0)
        high = np.minimum(np.ceil(pixels.max(axis=0)).astype(int) + 4, [self.file.width, self.file.height])
        if np.any(high <= low):
            return None
        return slice(int(low[1]), int(high[1])), slice(int(low[0]), int(high[0]))


def _blend(picture: AnyArray, cut: tuple[slice, slice], cover: AnyArray, colour: AnyArray) -> None:
    share = cover[..., None].astype(np.float32)
    picture[cut] += share * (colour - picture[cut])


def _grey(share: float) -> Array:
    return np.full(3, share**_GAMMA, dtype=np.float32)


def _paint(colour: str) -> Array:
    red, green, blue = rgb(colour)
    return np.asarray((np.array([blue, green, red]) / 255.0) ** _GAMMA, dtype=np.float32)
