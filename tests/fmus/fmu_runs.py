"""Runs of a single FMU unit, used by several tests."""

from __future__ import annotations

import numpy as np

from cosim.fmu.unit import FmuUnit

#: One step of the co-simulation in these tests [ns].
STEP = 10_000_000


def advance(
    unit: FmuUnit, powers: np.ndarray, outputs: tuple[str, ...], size: int = STEP, begin: int = 0
) -> np.ndarray:
    """Step with `powers` of shape (steps, coils); returns outputs of shape (steps, len(outputs), coils)."""
    record = []
    for index, power in enumerate(powers):
        unit.set("power", power)
        unit.do_step(begin + index * size, size)
        record.append([unit.get(name).copy() for name in outputs])
    return np.array(record)
