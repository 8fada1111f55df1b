"""Spots of all pictures in the plane of the markers; what is hidden in part is fitted with a circle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from chainmail.camera.circle import fit_circle
from chainmail.camera.detect import Spots
from chainmail.camera.sight import Sight
from cosim.unit.protocol import AnyArray, Array

#: A spot with less than this share of a marker's area is fitted with a circle.
WHOLE = 0.94
#: With less than this share seen, an outline may be that of another circle.
_LEAST = 0.2


@dataclass(frozen=True)
class Places:
    """Spots of one picture.

    Args:
        places: (y, z), shape (spots, 2) [m].
        covariance: Shape (spots, 2, 2) [m^2].
        share: Of a marker that is seen, shape (spots,).
    """

    places: Array
    covariance: Array
    share: Array

    def __len__(self) -> int:
        return len(self.share)


def radius_of(pictures: Sequence[Spots], sight: Sight, count: int) -> float:
    """Radius of a marker [m]: that of the median area of the largest spots of each picture.

    Returns:
        Not a number where no picture has a spot.
    """
    areas = []
    for spots in pictures[:: max(1, len(pictures) // 400)]:
        own = spots.area * sight.pixel_length(spots.pixels) ** 2
        areas.append(np.sort(own)[::-1][:count])
    every = np.concatenate(areas) if areas else np.zeros(0)
    return float(np.sqrt(np.median(every) / np.pi)) if every.size else float("nan")


def places_of(spots: Spots, sight: Sight, radius: float, error: float) -> Places:
    """Spots of a picture as places; parts of one marker are put together.

    Args:
        spots: As detected.
        sight: The camera.
        radius: Of a whole marker [m].
        error: Of a whole marker's centre, for a contrast of 1 [px]: `chainmail.camera.detect.outline_error`.
    """
    if not len(spots.area):
        return Places(np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros(0))
    pixel = sight.pixel_length(spots.pixels)
    places = sight.places(spots.pixels)
    is_there = np.isfinite(places).all(axis=1)
    share = np.where(is_there, spots.area * pixel**2 / (np.pi * radius**2), 0.0)
    own = error / spots.contrast
    covariance = ((np.maximum(spots.deviation, own) * pixel) ** 2)[:, None, None] * np.eye(2)
    whole = np.flatnonzero(is_there & (share >= WHOLE))
    out = [(places[i], covariance[i], share[i]) for i in whole]
    for group in _groups(places, np.flatnonzero(is_there & (share < WHOLE)), radius):
        edges = sight.places(np.concatenate([spots.edges[i] for i in group]))
        largest = group[int(np.argmax(spots.contrast[group]))]
        circle = fit_circle(edges[np.isfinite(edges).all(axis=1)], radius, float(pixel[largest]), float(own[largest]))
        total = float(share[group].sum())
        # Of a sliver nobody can say where its centre is: it counts as hidden.
        if circle is not None and total >= _LEAST:
            out.append((circle.centre, circle.covariance, total))
    found = [np.array(part) for part in zip(*out)] if out else [np.zeros((0, 2)), np.zeros((0, 2, 2)), np.zeros(0)]
    return Places(found[0], found[1], found[2])


def _groups(places: Array, small: AnyArray, radius: float) -> list[AnyArray]:
    """Small spots that may be parts of one marker: closer than its diameter."""
    left, found = list(small), []
    while left:
        first = left[0]
        near = [i for i in left if np.linalg.norm(places[i] - places[first]) < 1.9 * radius]
        found.append(np.array(near))
        left = [i for i in left if i not in near]
    return found
