"""Fabrics made of formulas, for what needs no simulation: known motion, any size, jitter as contacts make it."""

from __future__ import annotations

import numpy as np

from chainmail.play.film import Curve, Fabric, Field, Shape

#: Of the prototype's links.
SHAPE = Shape(bar_diameter=8.35e-3, outer_width=34.4e-3, length_offset=0.85e-3)
_PITCH = 23e-3


def fabric(rows: int = 6, per_row: int = 3, frames: int = 50, duration: float = 5.0, seed: int = 0) -> Fabric:
    """A fabric that sinks from flat into a drape and jitters by 2 um and 0.05 mrad from frame to frame."""
    random = np.random.default_rng(seed)
    times = np.linspace(0.0, duration, frames)
    links = rows * per_row
    row, place = np.divmod(np.arange(links), per_row)
    sink = 1 - np.exp(-3 * times / duration * (1 + 0.3 * np.sin(9 * times / duration)))
    bend = 0.25 * np.maximum(row - 1, 0) * sink[:, None]
    position = np.empty((frames, links, 3))
    position[..., 0] = (place - (per_row - 1) / 2) * 0.018
    position[..., 1] = _PITCH * row * np.cos(bend / 2)
    position[..., 2] = -_PITCH * row * np.sin(bend / 2)
    tilt = np.where(place % 2, -0.66, 0.66) - bend
    orientation = np.stack([np.sin(tilt / 2), 0 * tilt, 0 * tilt, np.cos(tilt / 2)], axis=-1)
    is_held = row < 2
    moving = ~is_held[None, :, None]
    position += 2e-6 * random.standard_normal(position.shape) * moving
    orientation = orientation + 2.5e-5 * random.standard_normal(orientation.shape) * moving
    orientation /= np.linalg.norm(orientation, axis=2, keepdims=True)
    warm = 22 + 48 * np.sin(np.pi * times / duration)[:, None] * (1 + 0.02 * np.arange(2 * links) / links)
    length = 0.033 - 0.003 * (warm[:, ::2] - 22) / 50 + 2e-6 * random.standard_normal((frames, links))
    fields = (
        Field("temperature", "°C", warm),
        Field("stiffness", "N/mm", 0.157 + 0.01 * np.round(warm - 22)),
        Field("tension", "N", 3.7 + 0.001 * random.standard_normal(warm.shape)),
        Field("link length", "mm", 1e3 * np.repeat(length, 2, axis=1)),
    )
    curves = (
        Curve("Supply voltage", "V", "", times, np.where(times < duration / 2, 6.0, 0.0)),
        Curve("Coil temperature", "°C", "", times, warm.mean(axis=1), warm.min(axis=1), warm.max(axis=1)),
        Curve("Maximum curvature", "1/m", "", times, 12 * sink),
    )
    return Fabric(
        "sinking", "fabric", SHAPE, times, position, orientation, length, row + 1, place + 1, is_held, fields, curves
    )


def corners(fabric_shape: Shape, position: np.ndarray, orientation: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Outermost corners of every link [m], shape (..., 8, 3), from middles, quaternions and bar distances."""
    signs = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], dtype=float)
    half = np.stack(
        [
            np.full(distance.shape, fabric_shape.outer_width / 2),
            (distance + fabric_shape.bar_diameter) / 2,
            np.full(distance.shape, fabric_shape.bar_diameter / 2),
        ],
        axis=-1,
    )
    local = half[..., None, :] * signs
    vector, scalar = orientation[..., None, :3], orientation[..., None, 3:]
    first = np.cross(vector, local) + scalar * local
    return position[..., None, :] + local + 2 * np.cross(vector, first)
