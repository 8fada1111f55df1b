"""The models that there are, and runs of a single FMU unit, used by several tests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.fmu.unit import FmuUnit

FMUS = Path(__file__).resolve().parents[2] / "fmus"

#: Every model: a folder of `fmus` with a model.c, as in its Makefile.
MODELS = sorted(file.parent.name for file in FMUS.glob("*/model.c"))

#: One step of the co-simulation in these tests [ns].
STEP = 10_000_000

every_model = pytest.mark.parametrize("model", MODELS)
every_fmu = pytest.mark.parametrize(("model", "version"), [(model, version) for model in MODELS for version in (3, 2)])


def drive_of(unit: FmuUnit) -> str:
    """Name of the input that drives an actuator: `power` [W] or `voltage` [V]."""
    (drive,) = {"power", "voltage"} & set(unit.variables)
    return drive


def advance(
    unit: FmuUnit,
    drives: np.ndarray,
    outputs: tuple[str, ...],
    size: int = STEP,
    begin: int = 0,
    tensions: np.ndarray | None = None,
) -> np.ndarray:
    """Step with `drives` of shape (steps, coils); returns outputs of shape (steps, len(outputs), coils).

    `tensions` [N] of the same shape go to models that hear them.
    """
    drive, record = drive_of(unit), []
    for index, value in enumerate(drives):
        unit.set(drive, value)
        if tensions is not None and "tension" in unit.variables:
            unit.set("tension", tensions[index])
        unit.do_step(begin + index * size, size)
        record.append([unit.get(name).copy() for name in outputs])
    return np.array(record)
