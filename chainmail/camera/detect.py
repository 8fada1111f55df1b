"""Markers in one picture: where each spot of their colour is, how surely, and how much of it is seen.

A pixel that is covered by a marker in part holds its share of the marker's colour. The part of a colour beyond grey is
therefore proportional to that share times the local light, whatever the light: it is 0 for grey surroundings, bright or
dark. Divided by the spot's own brightest part it is the share itself, and its centroid is the marker's centre.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from chainmail.camera.colours import PLAIN, rgb
from chainmail.camera.opencv import opencv
from cosim.unit.protocol import AnyArray, Array

#: A spot's pixels count from this share of its brightness (none) to that (all); straight in between.
_NONE, _ALL = 0.15, 0.85
#: Pixels above this share of the way from the ground to the brightest markers' level belong to a spot.
_LEVEL = 0.3
#: No spot is sought below this strength, of 255: noise of a camera in the dark.
_FLOOR = 18.0
#: Margin around a spot within which its pixels are weighed [px].
_MARGIN = 3
#: A spot must have this share of a marker's area, and at most that.
_LEAST_AREA, _MOST_AREA = 0.05, 2.0
#: Fewest pixels that a spot may have.
_LEAST_PIXELS = 6
#: Pixels above this share are covered; fewest of them that show how light changes across a marker.
_INSIDE, _FEWEST_INSIDE = 0.75, 40
#: A marker has at least this part of its colour beyond that of its ground.
_LEAST_BEYOND = 0.1


@dataclass(frozen=True)
class Spots:
    """What was found in one picture.

    Args:
        pixels: Centres (u, v), shape (spots, 2) [px].
        deviation: Standard deviation of a coordinate by noise, shape (spots,) [px].
        area: Sum of the shares of pixels that are covered, shape (spots,) [px].
        contrast: Strength of its colour above that of the ground, of 255, shape (spots,).
        edges: For each spot points on its outline, shape (points, 2) [px].
    """

    pixels: Array
    deviation: Array
    area: Array
    contrast: Array
    edges: tuple[Array, ...]


#: Of a picture that shows none.
NO_SPOTS = Spots(np.zeros((0, 2)), np.zeros(0), np.zeros(0), np.zeros(0), ())


class Detector:
    """Finds spots of one colour.

    Args:
        colour: As a rig names it.
        diameter: Of a marker [px], about.
        count: How many markers there are.
        is_round: Whether spots that are not round are left out: what is dark or bright is seldom a marker.
    """

    def __init__(self, colour: str, diameter: float, count: int) -> None:
        self._cv2: Any = opencv()
        self.colour, self.diameter, self.count = colour, diameter, count
        self._area = np.pi * diameter**2 / 4.0
        red, green, blue = rgb(colour)
        own = np.array([blue, green, red])
        beyond = own - own.mean()
        size = float(beyond @ own)
        #: Weights of blue, green, red: 0 for grey, 220 for the marker's own colour.
        self._weights = np.zeros(3) if colour in PLAIN else 220.0 * beyond / size
        reach = 2 * int(np.ceil(0.75 * diameter)) + 1
        self._kernel = self._cv2.getStructuringElement(self._cv2.MORPH_RECT, (reach, reach))

    def spots(self, picture: AnyArray) -> Spots:
        """Spots of a picture (height, width, 3) of bytes; the largest ones, at most three for each marker."""
        strength = self._strength(picture)
        level = self._level(strength)
        # Under a lamp of the markers' colour the ground has some of it too: half of all pixels are ground.
        ground = float(np.median(strength[::4, ::4]))
        boxes = self._boxes(strength, max(ground + _LEVEL * (level - ground), _FLOOR)) if level > _FLOOR else []
        found = [s for s in (self._spot(picture, strength, box) for box in boxes) if s is not None]
        if not found:
            return NO_SPOTS
        centre, deviation, area, contrast, edge = zip(*found)
        return Spots(np.array(centre), np.array(deviation), np.array(area), np.array(contrast), tuple(edge))

    def _strength(self, picture: AnyArray) -> AnyArray:
        """How much of the marker's colour each pixel has, shape (height, width), bytes."""
        if self.colour not in PLAIN:
            return np.asarray(self._cv2.transform(picture, self._weights[None, :].astype(np.float32)))
        grey = self._cv2.cvtColor(picture, self._cv2.COLOR_BGR2GRAY)
        how = self._cv2.MORPH_BLACKHAT if self.colour == "dark" else self._cv2.MORPH_TOPHAT
        return np.asarray(self._cv2.morphologyEx(grey, how, self._kernel))

    def _level(self, strength: AnyArray) -> float:
        """Strength that a quarter of the markers' area reaches, or all pixels if there are fewer."""
        counts = np.cumsum(np.bincount(strength.ravel()[::4], minlength=256)[::-1])
        wanted = 0.25 * self.count * self._area / 4.0
        return 255.0 - float(np.searchsorted(counts, wanted))

    def _boxes(self, strength: AnyArray, threshold: float) -> list[tuple[int, int, int, int]]:
        smooth = self._cv2.blur(strength, (3, 3))
        mask = (smooth > threshold).astype(np.uint8)
        _, _, stats, _ = self._cv2.connectedComponentsWithStats(mask, connectivity=4)
        sizes = stats[1:, 4]
        fits = (sizes > max(_LEAST_AREA * self._area, _LEAST_PIXELS)) & (sizes < _MOST_AREA * self._area)
        fits &= np.max(stats[1:, 2:4], axis=1, initial=0) < 1.8 * self.diameter + 4.0
        chosen = np.flatnonzero(fits)
        chosen = chosen[np.argsort(-sizes[chosen], kind="stable")][: 3 * self.count + 12]
        return [(int(x), int(y), int(w), int(h)) for x, y, w, h in stats[1:, :4][chosen]]

    def _spot(
        self, picture: AnyArray, strength: AnyArray, box: tuple[int, int, int, int]
    ) -> tuple[Array, float, float, float, Array] | None:
        """Centre, deviation, area, contrast and outline of the spot in a box; None at the picture's border."""
        x, y, wide, high = box
        left, top, right, bottom = x - _MARGIN, y - _MARGIN, x + wide + _MARGIN, y + high + _MARGIN
        if left < 0 or top < 0 or right > strength.shape[1] or bottom > strength.shape[0]:
            return None
        cut = (slice(top, bottom), slice(left, right))
        if self.colour in PLAIN:
            values = strength[cut].astype(np.float64)
        else:
            values = picture[cut].astype(np.float64) @ self._weights
        share, base, peak = _shares(values)
        if peak - base < _FLOOR:
            return None
        if self.colour not in PLAIN:
            share = _beyond_ground(picture[cut].astype(np.float64), share)
        weights = self._of_middle(_weights(share))
        total = float(weights.sum())
        if total < _LEAST_PIXELS or total > _MOST_AREA * self._area:
            return None
        u, v = np.arange(left, right), np.arange(top, bottom)
        centre = _centroid(weights, u, v)
        noise = _noise(share, weights)
        edge = ((weights > 0.0) & (weights < 1.0)).astype(np.float64)
        lever = float(np.sum(edge * ((u[None, :] - centre[0]) ** 2 + (v[:, None] - centre[1]) ** 2))) / 2.0
        # The lit side of a marker that a gradient or the edge of a shadow crosses counts more than the other. That is
        # not corrected, since compression makes gradients that are none; it is how far the centre may be off.
        even = np.where(weights > 0.0, _weights(share / _lighting(share)), 0.0)
        lit = float(np.linalg.norm(_centroid(even, u, v) - centre)) / np.sqrt(2.0) if even.any() else 0.0
        deviation = max(noise / (_ALL - _NONE) * np.sqrt(lever) / total, lit)
        return centre, float(deviation), total, peak - base, _outline(share, left, top)

    def _of_middle(self, weights: Array) -> Array:
        """Only what belongs to the largest spot: a neighbour that reaches into the box does not count."""
        mask = (weights > 0.5).astype(np.uint8)
        count, labels, stats, _ = self._cv2.connectedComponentsWithStats(mask, connectivity=8)
        if count <= 2:
            return weights
        largest = 1 + int(np.argmax(stats[1:, 4]))
        others = ((labels > 0) & (labels != largest)).astype(np.uint8)
        return np.where(self._cv2.dilate(others, np.ones((3, 3), np.uint8)) > 0, 0.0, weights)


def _weights(share: Array) -> Array:
    return np.clip((share - _NONE) / (_ALL - _NONE), 0.0, 1.0)


def _centroid(weights: Array, u: AnyArray, v: AnyArray) -> Array:
    return np.array([weights.sum(axis=0) @ u, weights.sum(axis=1) @ v]) / float(weights.sum())


def _shares(values: Array) -> tuple[Array, float, float]:
    """Share of each pixel that is covered, and the strengths that stand for none and all of it.

    The ground is the median of the border; the top is the median of what is above three quarters of the brightest.
    """
    border = np.concatenate([values[0], values[-1], values[1:-1, 0], values[1:-1, -1]])
    base = float(np.median(border))
    high = float(np.quantile(values, 0.98))
    inside = values[values > base + _INSIDE * (high - base)]
    peak = float(np.median(inside)) if inside.size else high
    return (values - base) / max(peak - base, 1e-9), base, peak


def _lighting(share: Array) -> Array:
    """Light on a marker relative to its median: a plane through what is covered, between the half and twice of it."""
    is_inside = share > _INSIDE
    v, u = np.nonzero(is_inside)
    if len(u) < _FEWEST_INSIDE:
        return np.ones_like(share)
    middle_u, middle_v = float(u.mean()), float(v.mean())
    columns = np.stack([np.ones(len(u)), u - middle_u, v - middle_v], axis=1)
    level, right, down = np.linalg.lstsq(columns, share[is_inside], rcond=None)[0]
    high, wide = share.shape
    plane = level + right * (np.arange(wide) - middle_u)[None, :] + down * (np.arange(high) - middle_v)[:, None]
    return np.asarray(np.clip(plane, 0.5, 2.0))


def _beyond_ground(picture: Array, share: Array) -> Array:
    """Share of each pixel that is covered, by the part of its colour that the ground around this spot does not have.

    Under a lamp with a colour grey is not grey: a bright and a dark ground then differ in a fixed mixture of the
    colours, which moves a marker that lies before both. The weights taken here are 0 for the ground's own colour,
    however bright, and largest for this marker.

    Args:
        picture: Around the spot, shape (height, width, 3).
        share: A first estimate, by the marker's nominal colour, shape (height, width).
    """
    border = np.concatenate([picture[0], picture[-1], picture[1:-1, 0], picture[1:-1, -1]])
    total = border.sum(axis=1)
    bright = border[total > 0.1 * float(total.max())]
    covered = picture[share > _ALL]
    if not len(bright) or not len(covered):
        return share
    ground = np.median(bright / bright.sum(axis=1, keepdims=True), axis=0)
    marker = np.median(covered, axis=0)
    beyond = marker - (marker @ ground) / (ground @ ground) * ground
    if beyond @ beyond < _LEAST_BEYOND**2 * (marker @ marker):
        return share
    return _shares(picture @ beyond)[0]


def _noise(share: Array, weights: Array) -> float:
    """Standard deviation of a share, from the pixels that no marker covers, at least that of rounding."""
    outside = share[weights == 0.0]
    if outside.size < 8:
        return 0.02
    spread = float(np.median(np.abs(outside - np.median(outside)))) / 0.6745
    return max(spread, 0.003)


def _outline(share: Array, left: int, top: int) -> Array:
    """Where the share crosses one half between neighbouring pixels, shape (points, 2) as (u, v)."""
    found = []
    for along in (0, 1):
        first = share[:, :-1] if along == 0 else share[:-1]
        second = share[:, 1:] if along == 0 else share[1:]
        rows, columns = np.nonzero((first > 0.5) != (second > 0.5))
        a, b = first[rows, columns], second[rows, columns]
        part = (0.5 - a) / (b - a)
        u = columns + (part if along == 0 else 0.0)
        v = rows + (part if along == 1 else 0.0)
        found.append(np.stack([u + left, v + top], axis=1))
    return np.concatenate(found)


def outline_error(edges: Sequence[Array], centres: Array, contrast: Array) -> float:
    """Error of a centre by pixels, noise, and compression in blocks, for a contrast of 1 [px].

    A shift of the centre is the first harmonic of an outline's distance from it, over the angle. The third and fifth
    have the same causes and nearly the same size, and neither a shift nor a lean of the disc (the second) nor the
    square grid of pixels (the fourth) makes them. What rounds and quantises colours does so by the same steps
    everywhere: it moves the outline of a marker with half the contrast twice as far.

    Args:
        edges: Outlines of whole markers, each of shape (points, 2) [px].
        centres: Shape (outlines, 2) [px].
        contrast: Of each of them, of 255, shape (outlines,).

    Returns:
        Root mean square of the coefficients of these harmonics times the contrast, without those beyond four
        deviations, which something that cuts into an outline makes; 0 without outlines.
    """
    squares = []
    for edge, centre, strength in zip(edges, centres, contrast):
        if len(edge) < 16:
            continue
        away = edge - centre
        angle = np.arctan2(away[:, 1], away[:, 0])
        columns = [np.ones_like(angle)] + [f(k * angle) for k in (1, 2, 3, 4, 5) for f in (np.cos, np.sin)]
        found = np.linalg.lstsq(np.stack(columns, axis=1), np.hypot(away[:, 0], away[:, 1]), rcond=None)[0]
        squares += [float(strength * found[k]) ** 2 for k in (5, 6, 9, 10)]
    if not squares:
        return 0.0
    kept = [s for s in squares if s <= 16.0 * float(np.median(squares)) / 0.6745**2]
    return float(np.sqrt(np.mean(kept)))
