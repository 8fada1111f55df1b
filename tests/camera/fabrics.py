"""Motions of a fabric's markers with known shape: rows on a circular arc, links that lean by a fixed angle."""

from __future__ import annotations

import numpy as np

from chainmail.camera.opencv import opencv
from chainmail.camera.render import Motion

LEAN = np.radians(43.0)


def markers(curvature, length=0.033, pitch=0.0225, rows=6):
    """(y, z) of back and front marker of every row, shape (2 rows, 2) [m]; rows hang on an arc of that curvature."""
    angle = -curvature * pitch * np.arange(rows)
    step = pitch * np.stack([np.cos(angle - curvature * pitch / 2), np.sin(angle - curvature * pitch / 2)], axis=1)
    centres = np.array([0.012, 0.010]) + np.concatenate([np.zeros((1, 2)), np.cumsum(step[:-1], axis=0)])
    half = length / 2.0 * np.stack([np.cos(angle + LEAN), np.sin(angle + LEAN)], axis=1)
    return np.stack([centres - half, centres + half], axis=1).reshape(-1, 2)


def swaying(begin=0.0, end=1.5, low=1.0, high=7.0):
    """Curvature between two values and back, links that shorten from 33.5 to 30 mm meanwhile."""
    times = np.linspace(begin, end, 121)
    part = np.sin(np.pi * (times - begin) / (end - begin)) ** 2
    return Motion(times, np.array([markers(high + (low - high) * p, 0.0335 - 0.0035 * p) for p in part]))


def pictures_of(folder):
    """Pictures of a folder, in the order of their names."""
    return [opencv().imread(str(f)) for f in sorted(folder.iterdir())]


def saved(folder, pictures, names=None):
    """A new folder with these pictures."""
    folder.mkdir()
    for number, picture in enumerate(pictures):
        name = names[number] if names else f"{number:06d}.png"
        opencv().imwrite(str(folder / name), picture)
    return folder
