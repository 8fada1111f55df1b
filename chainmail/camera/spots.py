"""Spots of all pictures in the plane of the markers; what is hidden in part is fitted with a circle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from chainmail.camera.circle import fit_circle
from chainmail.camera.detect import Spots
from chainmail.camera.sight import Sight
from cosim.unit.protocol import AnyArray, Array

#: A spot with less than this share of a marker's area is hidden in part, unless areas scatter: then with so many
#: deviations less, but never with less than the third number.
WHOLE, _SCATTER, _LOWEST = 0.94, 4.0, 0.85
#: With less than this share seen, what is seen of the rim is a third of it or less, and corners of what hides the rest
#: pass for rim: the circle may be another one.
_LEAST = 0.35


@dataclass(frozen=True)
class Places:
    """Spots of one picture.

    Args:
        places: (y, z), shape (spots, 2) [m].
        covariance: Shape (spots, 2, 2) [m^2].
        share: Of a marker that is seen, shape (spots,).
        is_whole: Whether the whole marker is seen, as far as its area tells, shape (spots,).
    """

    places: Array
    covariance: Array
    share: Array
    is_whole: AnyArray

    def __len__(self) -> int:
        return len(self.share)


@dataclass(frozen=True)
class Size:
    """Size of the markers, as measured.

    Args:
        radius: [m]; not a number where no picture has a spot.
        whole: A spot with less than this share of a marker's area is fitted with a circle.
    """

    radius: float
    whole: float = WHOLE


def size_of(pictures: Sequence[Spots], sight: Sight, count: int) -> Size:
    """Size of a marker: that of the median area of the largest spots of each picture.

    Compression makes areas scatter. The lower one of what scatters alike above the median is still a whole marker.

    Args:
        pictures: Spots of each picture.
        sight: The camera.
        count: Number of markers.
    """
    areas = []
    for spots in pictures[:: max(1, len(pictures) // 400)]:
        own = spots.area * sight.pixel_length(spots.pixels) ** 2
        areas.append(np.sort(own)[::-1][:count])
    every = np.concatenate(areas) if areas else np.zeros(0)
    if not every.size:
        return Size(float("nan"))
    median = float(np.median(every))
    above = every[every >= median] / median - 1.0
    scatter = float(np.median(above)) / 0.6745
    return Size(float(np.sqrt(median / np.pi)), float(np.clip(1.0 - _SCATTER * scatter, _LOWEST, WHOLE)))


def places_of(spots: Spots, sight: Sight, size: Size, error: float) -> Places:
    """Spots of a picture as places; parts of one marker are put together.

    Args:
        spots: As detected.
        sight: The camera.
        size: Of a whole marker.
        error: Of a whole marker's centre, for a contrast of 1 [px]: `chainmail.camera.detect.outline_error`.
    """
    radius = size.radius
    if not len(spots.area):
        return Places(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros(0), np.zeros(0, dtype=bool))
    pixel = sight.pixel_length(spots.pixels)
    places = sight.places(spots.pixels)
    is_there = np.isfinite(places).all(axis=1)
    share = np.where(is_there, spots.area * pixel**2 / (np.pi * radius**2), 0.0)
    own = error / spots.contrast
    # A strip at the rim that is hidden and not told from scatter moves the centroid by its share of a radius at most;
    # so does something of the markers' colour that touches a rim and counts as marker, beyond what areas scatter by.
    strip = np.where(share < WHOLE, (1.0 - share) * radius / 2.0, 0.0)
    strip = np.where(share > 2.0 - size.whole, (share - 1.0) * radius, strip)
    variance = (np.maximum(spots.deviation, own) * pixel) ** 2 + strip**2
    covariance = variance[:, None, None] * np.eye(2)
    whole = np.flatnonzero(is_there & (share >= size.whole))
    out = [(places[i], covariance[i], share[i], True) for i in whole]
    for group in _groups(places, np.flatnonzero(is_there & (share < size.whole)), radius):
        edges = sight.places(np.concatenate([spots.edges[i] for i in group]))
        largest = group[int(np.argmax(spots.contrast[group]))]
        circle = fit_circle(edges[np.isfinite(edges).all(axis=1)], radius, float(pixel[largest]), float(own[largest]))
        total = float(share[group].sum())
        # Of a sliver nobody can say where its centre is: it counts as hidden.
        if circle is not None and total >= _LEAST:
            out.append((circle.centre, circle.covariance, total, total >= WHOLE))
    if not out:
        return Places(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros(0), np.zeros(0, dtype=bool))
    found = [np.array(part) for part in zip(*out)]
    return Places(found[0], found[1], found[2], found[3])


def _groups(places: Array, small: AnyArray, radius: float) -> list[AnyArray]:
    """Small spots that may be parts of one marker: closer than its diameter."""
    left, found = list(small), []
    while left:
        first = left[0]
        near = [i for i in left if np.linalg.norm(places[i] - places[first]) < 1.9 * radius]
        found.append(np.array(near))
        left = [i for i in left if i not in near]
    return found
