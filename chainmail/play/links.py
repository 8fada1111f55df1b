"""The links of a fabric at a time, as bodies to draw."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass

import numpy as np

from chainmail.play.film import Fabric, Field
from chainmail.play.palette import palette
from chainmail.play.raster import Body
from cosim.unit.protocol import Array

#: Colours of bars of held links, and of links that a finding is about.
HELD, CONCERNED = np.array([0.36, 0.36, 0.36]), np.array([0.85, 0.0, 0.48])


@dataclass(frozen=True)
class Pose:
    """All links at one time.

    Args:
        position: Middles [m], shape (links, 3).
        orientation: Quaternions x, y, z, w, shape (links, 4).
        bar_distance: [m], shape (links,).
        frame: Number of the frame at or before that time.
    """

    position: Array
    orientation: Array
    bar_distance: Array
    frame: int


def pose_at(fabric: Fabric, time: float) -> Pose | None:
    """Poses between two frames; None outside the times of the run."""
    times = fabric.times
    if not times[0] - 1e-9 <= time <= times[-1] + 1e-9:
        return None
    first = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 1))
    last = min(first + 1, len(times) - 1)
    share = 0.0 if last == first else float(np.clip((time - times[first]) / (times[last] - times[first]), 0.0, 1.0))
    position, turn, distance = (
        values[first] + share * (values[last] - values[first])
        for values in (fabric.position, fabric.orientation, fabric.bar_distance)
    )
    return Pose(position, turn / np.linalg.norm(turn, axis=1, keepdims=True), distance, first)


def markers(fabric: Fabric, pose: Pose) -> Array:
    """Both bars of the last link of every row, at its outer side, as `mechanics.unit` has them [m], (markers, 3)."""
    last = np.flatnonzero(fabric.place == fabric.place.max())
    axes = _rotations(pose.orientation[last])
    side = fabric.shape.outer_width / 2 * axes[:, :, 0]
    along = pose.bar_distance[last, None] / 2 * axes[:, :, 1]
    return np.stack([pose.position[last] + side - along, pose.position[last] + side + along], axis=1).reshape(-1, 3)


def bodies(
    fabric: Fabric, pose: Pose, quantity: Field, limits: tuple[float, float], concerned: Set[int] = frozenset()
) -> Iterator[Body]:
    """Two bars and two arms of every link, in the colours of a quantity.

    Args:
        fabric: Which.
        pose: Where its links are.
        quantity: What the colours show.
        limits: Values of the first and the last colour.
        concerned: Links whose bars are marked, from 0.
    """
    span = (limits[1] - limits[0]) or 1.0
    level = np.clip((quantity.values[pose.frame].reshape(-1, 2) - limits[0]) / span, 0.0, 1.0)
    colours = palette() / 255.0
    for link in range(fabric.links):
        arms = [colours[round(255 * value)] for value in level[link]]
        bar = colours[round(255 * level[link].mean())]
        bar = CONCERNED if link in concerned else HELD if fabric.is_held[link] else bar
        yield from _link(fabric, pose, link, (bar, *arms))


def ghost(fabric: Fabric, pose: Pose, colour: Array) -> Iterator[Body]:
    """The same in one colour."""
    for link in range(fabric.links):
        yield from _link(fabric, pose, link, (colour, colour, colour))


def _link(fabric: Fabric, pose: Pose, link: int, colours: Iterable[Array]) -> Iterator[Body]:
    bar, *arms = colours
    shape, middle, distance = fabric.shape, pose.position[link], float(pose.bar_distance[link])
    axes, radius = _rotations(pose.orientation[link : link + 1])[0], shape.bar_diameter / 2
    for end in (-1.0, 1.0):  # 0.1 % longer than an arm is wide, so that its end is seen and not that of the arm
        half = np.array([0.5005 * shape.outer_width, radius, radius])
        yield Body(half, True, middle + end * distance / 2 * axes[:, 1], axes, bar)
    for side, colour in zip((-1.0, 1.0), arms):
        half = np.array([radius, distance / 2, radius])
        yield Body(half, False, middle + side * shape.arm_x * axes[:, 0], axes, colour)


def _rotations(orientation: Array) -> Array:
    """Rotation matrices (links, 3, 3) of quaternions x, y, z, w; columns are the axes."""
    x, y, z, w = orientation.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
