"""One picture of a film: the fabric, a colour bar, the time, and two curves with a cursor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from chainmail.play.camera import Camera, Reach, camera
from chainmail.play.film import Curve, Fabric, Field, Film, Marks
from chainmail.play.links import bodies, ghost, markers, pose_at
from chainmail.play.palette import GHOSTS, palette
from chainmail.play.raster import Layer, draw, empty
from cosim.unit.protocol import Array

_BACKGROUND = np.array([0.965, 0.972, 0.98])
_INK, _GRID, _LINE, _CURSOR = (26, 32, 44), (203, 213, 224), (31, 79, 216), (214, 39, 40)
#: Share of the ghost's colour where it covers something.
_OPACITY = 0.38
#: A ghost no nearer than this does not tint what lies in the same place [m].
_BEHIND = 3e-4
#: Rays per pixel along each side.
_FINE = 2
#: Longest and shortest bar of colours, in heights of a letter.
_LONGEST_BAR, _SHORTEST_BAR = 8.0, 3.0
#: Height of the strip of one curve, in heights of the letters.
_STRIP = 4.2


@dataclass(frozen=True)
class Style:
    """How a film is drawn.

    Args:
        size: Width and height [px].
        view: One of `chainmail.play.camera.VIEWS`.
        quantity: Name of the quantity that the colours show.
        curves: Titles of the plots under the picture.
    """

    size: tuple[int, int]
    view: str
    quantity: str
    curves: tuple[str, ...]


class Painter:
    """Draws the film at any time.

    Args:
        film: What.
        reach: What the camera must see.
        ranges: Quantity to lowest value, highest value and unit.
        style: How.
    """

    def __init__(self, film: Film, reach: Reach, ranges: dict[str, tuple[float, float, str]], style: Style) -> None:
        self.film, self.style = film, style
        self.letters = max(11, round(style.size[0] / 45))
        self.font = ImageFont.load_default(self.letters)
        self.low, self.high, self.unit = ranges[style.quantity]
        self.strips = [_strip(film, title) for title in style.curves]
        self.height = style.size[1] - round(_STRIP * self.letters) * len(self.strips)
        self.camera = camera(style.view, reach, (_FINE * style.size[0], _FINE * self.height))
        self.quantity = next(q for q in film.fabric.fields if q.name == style.quantity)
        self.concerned = frozenset(link for finding in film.findings for link in finding.links)

    def at(self, time: float) -> Image.Image:
        """The picture at a time [s]."""
        picture = Image.new("RGB", self.style.size, "white")
        picture.paste(self._fabrics(time), (0, 0))
        pen = ImageDraw.Draw(picture)
        self._marks(pen, time)
        self._legend(picture, pen, time)
        for number, curves in enumerate(self.strips):
            self._curves(pen, curves, self.height + round(number * _STRIP * self.letters), time)
        return picture

    def _fabrics(self, time: float) -> Image.Image:
        layer = empty(self.camera.size, _BACKGROUND)
        pose = pose_at(self.film.fabric, time)
        if pose is not None:
            for body in bodies(self.film.fabric, pose, self.quantity, (self.low, self.high), self.concerned):
                draw(layer, self.camera, body)
        for number, fabric in enumerate(self.film.fabrics[1:]):
            _cover(layer, self.camera, fabric, time, GHOSTS[number % len(GHOSTS)])
        rows, columns = layer.depth.shape
        fine = layer.colour.reshape(rows // _FINE, _FINE, columns // _FINE, _FINE, 3).mean(axis=(1, 3))
        return Image.fromarray(np.rint(255 * fine).astype(np.uint8))

    def _marks(self, pen: ImageDraw.ImageDraw, time: float) -> None:
        pose = pose_at(self.film.fabric, time)
        for number, marks in enumerate(self.film.marks):
            colour = GHOSTS[(len(self.film.fabrics) - 1 + number) % len(GHOSTS)]
            for simulated, recorded in [] if pose is None else pairs(self.film.fabric, marks, time):
                for point, is_disc in ((simulated, False), (recorded, True)):
                    x, y = self.camera.project(point)[:2] / _FINE
                    size = self.letters * (0.28 if is_disc else 0.42)
                    box = (x - size, y - size, x + size, y + size)
                    pen.ellipse(box, _rgb(colour) if is_disc else None, _INK if not is_disc else None, 2)

    def _legend(self, picture: Image.Image, pen: ImageDraw.ImageDraw, time: float) -> None:
        m, width = self.letters, self.style.size[0]
        low, high = f"{self.low:.4g} {self.unit}", f"{self.high:.4g} {self.unit}  {self.quantity.name}"
        clock = f"t = {time:.2f} s"
        low_long, high_long, clock_long = (pen.textlength(text, self.font) for text in (low, high, clock))
        free = width - 4.0 * m - low_long - high_long
        # Where a narrow picture leaves no room for a bar beside the time, the time goes below it.
        line = 0.8 * m if free - clock_long >= _SHORTEST_BAR * m else 2.2 * m
        room = free - (clock_long if line < m else 0.0)
        length = max(round(min(_LONGEST_BAR * m, room)), m)
        bar = Image.fromarray(np.broadcast_to(palette()[None], (1, 256, 3)).copy()).resize((length, m))
        pen.text((m, 0.8 * m), low, _INK, self.font)
        at = round(m + low_long + m / 2)
        picture.paste(bar, (at, round(0.95 * m)))
        pen.text((at + length + m / 2, 0.8 * m), high, _INK, self.font)
        pen.text((width - m - clock_long, line), clock, _INK, self.font)

    def _curves(
        self, pen: ImageDraw.ImageDraw, curves: Sequence[tuple[Curve, Array | None]], top: int, time: float
    ) -> None:
        m, width = self.letters, self.style.size[0]
        left, right, upper, lower = m, width - m, top + 1.5 * m, top + (_STRIP - 0.4) * m
        begin = min(float(f.times[0]) for f in self.film.fabrics)
        end = max(float(f.times[-1]) for f in self.film.fabrics)
        values = np.concatenate([c.values for c, _ in curves])
        low, high = float(values.min()), float(values.max())
        span = ((end - begin) or 1.0, (high - low) or 1.0)
        first = curves[0][0]
        title = f"{first.plot}, {low:.3g} to {high:.3g} {first.unit}"
        pen.text((left, top + 0.1 * m), title, _INK, self.font)
        pen.line((left, lower, right, lower), _GRID)
        for curve, colour in curves:
            x = left + (right - left) * (curve.times - begin) / span[0]
            y = lower - (lower - upper) * (curve.values - low) / span[1]
            corners = [(float(a), float(b)) for a, b in zip(x, y) if left <= a <= right]
            pen.line(corners, _LINE if colour is None else _rgb(colour), max(1, m // 8))
        cursor = left + (right - left) * (time - begin) / span[0]
        pen.line((cursor, upper, cursor, lower), _CURSOR, max(1, m // 8))


def pairs(fabric: Fabric, marks: Marks, time: float) -> list[tuple[Array, Array]]:
    """Simulated and recorded place [m] of every point that has a reading at a time; (3,) each.

    A coordinate that was not recorded is that of the simulation.
    """
    pose = pose_at(fabric, time)
    if pose is None:
        return []
    of_kind = {"marker": markers(fabric, pose), "link": pose.position}
    found = []
    for point in marks.points:
        simulated = of_kind[point.kind][point.number - 1]
        read = [track.at(time) if track is not None else float(s) for track, s in zip(point.axes, simulated)]
        if all(value is not None for value in read):
            found.append((simulated, np.array(read, dtype=np.float64)))
    return found


def _strip(film: Film, title: str) -> list[tuple[Curve, Array | None]]:
    """Curves of a plot, that of the first fabric without a colour of its own."""
    return [
        (curve, GHOSTS[(number - 1) % len(GHOSTS)] if number else None)
        for number, fabric in enumerate(film.fabrics)
        for curve in fabric.curves
        if curve.plot == title
    ]


def _cover(layer: Layer, seen: Camera, fabric: Fabric, time: float, colour: Array) -> None:
    """Lay a ghost over what is behind it."""
    pose = pose_at(fabric, time)
    if pose is None:
        return
    own = empty(seen.size, _BACKGROUND)
    for body in ghost(fabric, pose, colour):
        draw(own, seen, body)
    is_before = own.depth < layer.depth - _BEHIND
    layer.colour[is_before] += _OPACITY * (own.colour[is_before] - layer.colour[is_before])


def _rgb(colour: Array) -> tuple[int, int, int]:
    red, green, blue = (round(255 * float(part)) for part in colour)
    return red, green, blue


def fields_of(film: Film) -> dict[str, Field]:
    """Quantities that the colours can show, by name."""
    return {quantity.name: quantity for quantity in film.fabric.fields}
