"""A marker that is hidden in part: the circle of known size through what is seen of its outline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array

#: Most points of an outline that are paired.
_MOST = 28
#: Share of the radius by which a point may be off a circle and belong to it; and by which any may be outside.
_ON, _OUTSIDE = 0.06, 0.10
#: Least share of the points that must lie on the circle, and least angle that they must span.
_LEAST_SHARE, _LEAST_SPAN = 0.3, np.radians(75.0)
_STEPS = 6


@dataclass(frozen=True)
class Circle:
    """A circle of given radius.

    Args:
        centre: [m], shape (2,).
        covariance: Of the centre [m^2], shape (2, 2).
    """

    centre: Array
    covariance: Array


def fit_circle(points: Array, radius: float, pixel: float, error: float = 0.0) -> Circle | None:
    """The circle on whose rim most of an outline lies, and outside of which nothing does.

    Pairs of points give two circles each; the best is refined by least squares on its points. What hides the rest cuts
    into the outline: those points lie inside.

    Args:
        points: Outline, shape (points, 2) [m].
        radius: Of the marker [m].
        pixel: Length of a pixel [m]: a point of an outline is known to a fifth of it.
        error: Of the centre of a whole marker, by what points of an outline have in common [px].

    Returns:
        None where too little of a rim is seen to say where its centre is.
    """
    if len(points) < 6:
        return None
    chosen = points[np.linspace(0, len(points) - 1, min(_MOST, len(points))).astype(int)]
    centres = _candidates(chosen, radius)
    if not len(centres):
        return None
    slack = max(_ON * radius, 0.3 * pixel)
    off = np.linalg.norm(points[None] - centres[:, None], axis=2) - radius
    on = np.sum(np.abs(off) < slack, axis=1)
    outside = np.sum(off > max(_OUTSIDE * radius, 0.5 * pixel), axis=1)
    best = int(np.argmax(on - 3.0 * outside))
    if outside[best] > 0.04 * len(points):
        return None
    return _refined(points, centres[best], radius, slack, pixel, error)


def _candidates(points: Array, radius: float) -> Array:
    first, second = np.triu_indices(len(points), 1)
    a, b = points[first], points[second]
    apart = np.linalg.norm(b - a, axis=1)
    fits = (apart > 0.4 * radius) & (apart < 1.999 * radius)
    a, b, apart = a[fits], b[fits], apart[fits]
    middle, across = (a + b) / 2.0, np.stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0]], axis=1) / apart[:, None]
    high = np.sqrt(radius**2 - apart**2 / 4.0)[:, None]
    return np.concatenate([middle + high * across, middle - high * across])


def _refined(points: Array, centre: Array, radius: float, slack: float, pixel: float, error: float) -> Circle | None:
    for _ in range(_STEPS):
        away = points - centre
        distance = np.linalg.norm(away, axis=1)
        is_on = np.abs(distance - radius) < slack
        if is_on.sum() < max(5, _LEAST_SHARE * len(points)):
            return None
        normal = away[is_on] / distance[is_on, None]
        information = normal.T @ normal
        if np.linalg.eigvalsh(information)[0] < 1e-3 * is_on.sum():
            return None
        centre = centre + np.linalg.solve(information, normal.T @ (distance[is_on] - radius))
    angles = np.sort(np.arctan2(normal[:, 1], normal[:, 0]))
    gaps = np.diff(np.append(angles, angles[0] + 2.0 * np.pi))
    if 2.0 * np.pi - float(gaps.max()) < _LEAST_SPAN:
        return None
    # Points of an outline are not independent: neighbours share pixels, and about a third of them count.
    scatter = max(float(np.sqrt(np.mean((distance[is_on] - radius) ** 2))), 0.2 * pixel)
    # An error that moves the whole circle by `error` is spread over all of its outline, which crosses 8 r lines of the
    # grid; through a piece of it less is averaged, and not the same in all directions.
    whole = (error * pixel) ** 2 * (4.0 * radius / pixel)
    spread = np.linalg.inv(information)
    return Circle(centre, (3.0 * scatter**2 + whole) * spread + (0.05 * pixel) ** 2 * np.eye(2))
