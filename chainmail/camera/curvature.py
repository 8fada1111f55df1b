"""Largest curvature of a fabric over time from measured row centres, with its standard deviation.

The largest of several noisy values is too large on average. So the three rows at which a fabric is bent most, and to
which side, are chosen from the mean over neighbouring pictures, and the curvature of those rows is read in this one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d

from cosim.unit.protocol import AnyArray, Array

#: Pictures over which the place of the largest curvature is chosen.
_WINDOW = 9
#: A row is more curved than the one chosen by so many deviations: noise does not explain it.
_CLEARLY = 4.0


@dataclass(frozen=True)
class Curvature:
    """Largest curvature.

    Args:
        values: Shape (frames,) [1/m]; not a number in a gap.
        deviation: Shape (frames,) [1/m].
        row: Middle one of the three rows, from 1; 0 in a gap; shape (frames,).
    """

    values: Array
    deviation: Array
    row: AnyArray


def curvatures(centres: Array) -> Array:
    """Signed curvature of the circle through each three consecutive rows, shape (..., rows - 2) [1/m].

    Args:
        centres: Shape (..., rows, 2) [m].

    Source: equation (1) of the paper on the circumscribed circle, as in `mechanics/curvature.py`.
    """
    step = np.diff(centres, axis=-2)
    span = centres[..., 2:, :] - centres[..., :-2, :]
    length = np.linalg.norm(step, axis=-1)
    cross = step[..., :-1, 0] * step[..., 1:, 1] - step[..., :-1, 1] * step[..., 1:, 0]
    return np.asarray(2.0 * cross / (length[..., :-1] * length[..., 1:] * np.linalg.norm(span, axis=-1)))


def curvature_deviation(centres: Array, covariance: Array) -> Array:
    """Standard deviation of `curvatures`, to first order, shape (frames, rows - 2) [1/m].

    Args:
        centres: Shape (frames, rows, 2) [m].
        covariance: Shape (frames, rows, 2, 2) [m^2]; rows are independent.
    """
    rows = centres.shape[1]
    total = np.zeros((len(centres), rows - 2))
    step = 1e-6
    for place in range(3):
        slopes = []
        for axis in range(2):
            moved = np.stack([centres[:, k : rows - 2 + k] for k in range(3)], axis=2)
            moved[:, :, place, axis] += step
            ahead = curvatures(moved)[..., 0]
            moved[:, :, place, axis] -= 2.0 * step
            slopes.append((ahead - curvatures(moved)[..., 0]) / (2.0 * step))
        slope = np.stack(slopes, axis=-1)
        total += np.einsum("fri,frij,frj->fr", slope, covariance[:, place : rows - 2 + place], slope)
    return np.sqrt(total)


def largest_curvature(centres: Array, covariance: Array) -> Curvature:
    """Largest curvature in every picture in which all rows are known.

    Args:
        centres: Shape (frames, rows, 2) [m].
        covariance: Shape (frames, rows, 2, 2) [m^2].
    """
    own, deviation = curvatures(centres), curvature_deviation(centres, covariance)
    known = np.asarray(np.isfinite(own).all(axis=1) & np.isfinite(deviation).all(axis=1))
    weight = np.where(known[:, None], 1.0 / np.maximum(deviation, 1e-9) ** 2, 0.0)
    total = uniform_filter1d(weight, _WINDOW, axis=0, mode="nearest")
    mean = uniform_filter1d(np.where(known[:, None], own, 0.0) * weight, _WINDOW, axis=0, mode="nearest")
    mean = mean / np.maximum(total, 1e-300)
    place = np.argmax(np.abs(mean), axis=1)
    frames = np.arange(len(own))
    sign = np.sign(mean[frames, place])
    # Where another row is more curved by more than noise, the fabric moves too fast for the pictures around to tell.
    largest = np.argmax(np.where(known[:, None], np.abs(own), 0.0), axis=1)
    ahead = np.abs(own[frames, largest]) - sign * own[frames, place]
    is_fast = known & (ahead > _CLEARLY * np.hypot(deviation[frames, largest], deviation[frames, place]))
    place = np.where(is_fast, largest, place)
    sign = np.where(is_fast, np.sign(own[frames, largest]), sign)
    values = np.where(known, sign * own[frames, place], np.nan)
    spread = np.hypot(deviation[frames, place], _by_choice(np.abs(mean), deviation, place))
    return Curvature(values, np.where(known, spread, np.nan), np.where(known, place + 2, 0))


def _by_choice(mean: Array, deviation: Array, place: AnyArray) -> Array:
    """How much too large a curvature is on average because its row was chosen as the largest, shape (frames,) [1/m].

    Errors of compression stay while a fabric hardly moves, so the mean over pictures that chooses has them too. Of two
    normal values with means d apart and a difference that scatters by s, the larger one is too large by
    s phi(d / s), phi being the normal density.

    Args:
        mean: Over neighbouring pictures, shape (frames, rows - 2) [1/m].
        deviation: Of single pictures, shape (frames, rows - 2) [1/m].
        place: Of the largest, shape (frames,).
    """
    frames = np.arange(len(mean))
    apart = mean[frames, place][:, None] - mean
    both = np.maximum(np.hypot(deviation, deviation[frames, place][:, None]), 1e-12)
    excess = both * np.exp(-(np.minimum(apart / both, 9.0) ** 2) / 2.0) / np.sqrt(2.0 * np.pi)
    excess[frames, place] = 0.0
    return np.asarray(np.sqrt(np.sum(excess**2, axis=1)))
