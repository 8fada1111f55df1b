"""Pictures of links without a browser: a ray through every pixel meets cylinders and boxes in closed form.

Bars are finite cylinders along the x axis of their link, arms are boxes along its y axis (`chainmail.play.film.Shape`).
Of each only the pixels inside the outline of its bounding box are asked, and the nearest hit stays.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from chainmail.play.camera import Camera
from cosim.unit.protocol import Array

_CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
#: A hit: depth, shape (pixels), infinite where there is none; normal in the body's frame, shape (pixels, 3).
Hit = tuple[Array, Array]


@dataclass
class Layer:
    """A picture in the making.

    Args:
        depth: Distance of what is seen [m], shape (rows, columns); infinite where nothing is.
        colour: Shape (rows, columns, 3), 0 to 1.
    """

    depth: Array
    colour: Array


@dataclass(frozen=True)
class Body:
    """A cylinder along its x axis, or a box.

    Args:
        half: Half sizes along its axes [m]; of a cylinder y and z are its radius.
        is_round: Whether it is a cylinder.
        middle: [m], shape (3,).
        rotation: Columns: its axes, shape (3, 3).
        colour: Red, green, blue, 0 to 1.
    """

    half: Array
    is_round: bool
    middle: Array
    rotation: Array
    colour: Array


def empty(size: tuple[int, int], colour: Array) -> Layer:
    """A layer with nothing in it; `size` is width and height [px]."""
    shape = size[1], size[0]
    return Layer(np.full(shape, np.inf), np.broadcast_to(colour, (*shape, 3)).copy())


def draw(layer: Layer, camera: Camera, body: Body) -> None:
    """Draw a body where it is nearer than what is there."""
    seen = camera.project(body.middle + (_CORNERS * body.half) @ body.rotation.T)
    if (seen[:, 2] <= 0).any():
        return  # behind the eye; a camera that sees the whole fabric has nothing there
    left, top = np.maximum(np.floor(seen[:, :2].min(axis=0)), 0).astype(int)
    right, bottom = np.minimum(np.ceil(seen[:, :2].max(axis=0)), camera.size).astype(int)
    if left >= right or top >= bottom:
        return
    columns, rows = slice(left, right), slice(top, bottom)
    rays = camera.rays(columns, rows) @ body.rotation
    start = (camera.eye - body.middle) @ body.rotation
    meet: Callable[[Array, Array, Array], Hit] = _cylinder if body.is_round else _box
    depth, normal = meet(start, rays, body.half)
    is_nearer = depth < layer.depth[rows, columns]
    layer.depth[rows, columns][is_nearer] = depth[is_nearer]
    lit = _light(normal[is_nearer] @ body.rotation.T, camera)
    layer.colour[rows, columns][is_nearer] = np.minimum(1.0, lit[:, None] * body.colour)


def _light(normal: Array, camera: Camera) -> Array:
    """Brightness by the normals, as the page has it: a lamp at the upper left of the viewer, and light from above."""
    lamp = np.array([-0.35, 0.55, 1.0]) @ camera.axes
    return np.asarray(0.60 + 0.38 * np.maximum(normal @ (lamp / np.linalg.norm(lamp)), 0.0) + 0.12 * normal[:, 2])


def _box(start: Array, rays: Array, half: Array) -> Hit:
    """Entry into a box: the last of the entries into its three slabs, if before the first exit."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (-half - start) / rays, (half - start) / rays
    entry, leaving = np.minimum(one, other), np.maximum(one, other)
    axis = np.argmax(entry, axis=-1)
    depth = np.take_along_axis(entry, axis[..., None], axis=-1)[..., 0]
    is_hit = (depth <= leaving.min(axis=-1)) & (depth > 0)
    normal = np.zeros_like(rays)
    np.put_along_axis(normal, axis[..., None], -np.sign(np.take_along_axis(rays, axis[..., None], axis=-1)), axis=-1)
    return np.where(is_hit, depth, np.inf), normal


def _cylinder(start: Array, rays: Array, half: Array) -> Hit:
    """Entry into a finite cylinder along x: into y^2 + z^2 <= r^2 or into -h <= x <= h, whichever is later."""
    radius = half[1]
    a = rays[..., 1] ** 2 + rays[..., 2] ** 2
    b = rays[..., 1] * start[1] + rays[..., 2] * start[2]
    c = start[1] ** 2 + start[2] ** 2 - radius**2
    root = b * b - a * c
    with np.errstate(divide="ignore", invalid="ignore"):
        wide = np.sqrt(np.maximum(root, 0.0))
        side_in, side_out = (-b - wide) / a, (-b + wide) / a
        one, other = (-half[0] - start[0]) / rays[..., 0], (half[0] - start[0]) / rays[..., 0]
    end_in, end_out = np.minimum(one, other), np.maximum(one, other)
    depth = np.maximum(side_in, end_in)
    is_hit = (root > 0) & (depth <= np.minimum(side_out, end_out)) & (depth > 0)
    at = start + depth[..., None] * rays
    normal = np.where(
        (side_in >= end_in)[..., None],
        at * (0.0, 1 / radius, 1 / radius),
        np.stack([-np.sign(rays[..., 0]), np.zeros_like(a), np.zeros_like(a)], axis=-1),
    )
    return np.where(is_hit, depth, np.inf), normal
