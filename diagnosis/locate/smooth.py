"""What recorded temperatures say about the true ones: departure of the coils from the simulation, smoothed.

A stiffness follows its coil's temperature through a steep curve with a memory: raw readings would drive it into loops
that noise alone makes. So the departure is a smooth random course, first one common to all coils, then one of each
string, then of each coil. Its size is the one under which the readings are most probable (C. E. Rasmussen and C. K. I.
Williams, Gaussian Processes for Machine Learning, MIT Press 2006, section 5.4.1).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array

#: Sizes of the departure that are tried [K].
SIZES = (0.0, 0.05, 0.2, 0.7, 2.5, 8.0, 25.0)
#: Time over which a coil's temperature follows what heats it [s], of the order of C/(hA).
PACE = 4.0
#: Most cosines: 80 over 100 s resolve 2.5 s.
COSINES = 80


@dataclass(frozen=True)
class Smoothed:
    """A course and what is not known about it.

    Args:
        mean: Shape (cosines,), coefficients.
        factor: The covariance of the coefficients is factor @ factor.T, shape (cosines, cosines).
    """

    mean: Array
    factor: Array


def cosines(times: Array, begin: float, end: float) -> tuple[Array, Array]:
    """Values of the basis at times, shape (times, cosines), and the relative deviation of each coefficient."""
    length = max(end - begin, 1e-9)
    count = int(min(COSINES, max(8, 2.0 * length / PACE * 4)))
    order = np.arange(count)
    basis = np.cos(np.pi * order * (times[:, None] - begin) / length)
    size = 1.0 / (1.0 + (PACE * np.pi * order / length) ** 2)
    return np.asarray(basis), np.asarray(size / np.sqrt(np.sum(size**2)))


def smooth(values: Array, weight: Array, basis: Array, size: Array) -> Smoothed:
    """Most probable course through noisy values.

    Args:
        values: Shape (samples,).
        weight: 1 / variance of each, 0 where it is not used, shape (samples,).
        basis: Shape (samples, cosines).
        size: Relative deviations of the coefficients, shape (cosines,).
    """
    normal = basis.T @ (weight[:, None] * basis)
    right = basis.T @ (weight * values)
    best, choice = 0.0, 0.0
    for amount in SIZES[1:]:
        scale = amount * size
        inner = np.eye(len(size)) + scale[:, None] * normal * scale
        root = np.linalg.cholesky(inner)
        along = np.linalg.solve(root, scale * right)
        evidence = 0.5 * float(along @ along) - float(np.sum(np.log(np.diag(root))))
        if evidence > best:
            best, choice = evidence, amount
    # Where nothing departs, something as small as the least size may still be there.
    scale = (choice or SIZES[1]) * size
    root = np.linalg.cholesky(np.eye(len(size)) + scale[:, None] * normal * scale)
    factor = scale[:, None] * np.linalg.inv(root).T
    mean = factor @ (factor.T @ right) if choice else np.zeros(len(size))
    return Smoothed(np.asarray(mean), np.asarray(factor))


def levels(values: Array, weight: Array, basis: Array, size: Array, groups: Sequence[Array]) -> list[Smoothed]:
    """Courses common to groups of columns, the largest groups first, each on what the ones before leave.

    Args:
        values: Shape (samples, coils).
        weight: As for `smooth`, shape (samples, coils).
        basis: As for `smooth`.
        size: As for `smooth`.
        groups: Numbers of columns.
    """
    left, found = values.copy(), []
    for members in groups:
        own = weight[:, members]
        total = own.sum(axis=1)
        mean = np.sum(own * left[:, members], axis=1) / np.maximum(total, 1e-300)
        course = smooth(mean, total, basis, size)
        left[:, members] -= (basis @ course.mean)[:, None]
        found.append(course)
    return found
