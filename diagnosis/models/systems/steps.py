"""As many steps of the integration in each macro-step as a system of FMUs needs."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.systems.fast import FastSystem

#: Steps of the integration are halved until nothing moves by more than this share of its own standard deviation.
EXACT, MOST_SUBSTEPS = 1e-3, 64


def resolve(system: FastSystem) -> Array | None:
    """Simulate with as few steps of the integration as give the result, and leave the system with that number.

    A step too long for the fastest time constant of an FMU makes the classical Runge-Kutta method diverge
    (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.2: beyond 2.78 time constants), so that a
    simulation that stops is no result yet.

    Returns:
        Recorded values, shape (outputs, recorded), a copy; None where every number of steps stops.
    """
    count, before = 1, None
    while True:
        system.set_substeps(count)
        rows = system.simulate()
        if rows is not None and before is not None and _is_same(before, rows.values):
            return rows.values.copy()
        if count >= MOST_SUBSTEPS:
            return None if rows is None else rows.values.copy()
        before = None if rows is None else rows.values.copy()
        count *= 2


def _is_same(before: Array, now: Array) -> bool:
    """Whether twice as many steps changed nothing; never of what ran away, whose size is no measure."""
    with np.errstate(over="ignore", invalid="ignore"):
        moved = np.max(np.abs(now - before), axis=0, initial=0.0)
        size = EXACT * np.std(now, axis=0) + 1e-12 * np.max(np.abs(now), axis=0, initial=0.0)
    return bool(np.all(np.isfinite(size) & (moved <= size)))
