"""Golden traces: selected values of short runs, stored in tests/golden and compared within stated tolerances."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

FOLDER = Path(__file__).resolve().parents[1] / "golden"


@dataclass(frozen=True)
class Tolerance:
    """Allowed difference: absolute + relative * largest stored value of the series; `reason` says where it is from."""

    absolute: float
    relative: float
    reason: str


def series(dataset: xr.Dataset, selection: Mapping[str, Tolerance], times: list[float]) -> dict[str, list[object]]:
    """Chosen variables at chosen times, with `time` first; every element of an array, rounded to 12 digits."""
    at = dataset.sel(time=times, method="nearest", tolerance=1e-9)
    found: dict[str, list[object]] = {"time": [float(t) for t in times]}
    for name in selection:
        values = np.vectorize(lambda x: float(f"{x:.12g}"))(at[name].values)
        found[name] = values.tolist()
    return found


def path(name: str) -> Path:
    """File of a golden trace."""
    return FOLDER / f"{name}.json"


def store(name: str, found: Mapping[str, list[object]]) -> None:
    """Write a golden trace, one series per line."""
    FOLDER.mkdir(exist_ok=True)
    lines = ",\n".join(f'  "{key}": {json.dumps(values)}' for key, values in found.items())
    path(name).write_text("{\n" + lines + "\n}\n")


def load(name: str) -> dict[str, list[object]]:
    """Read a golden trace."""
    return dict(json.loads(path(name).read_text()))


def differences(
    found: Mapping[str, list[object]], stored: Mapping[str, list[object]], selection: Mapping[str, Tolerance]
) -> list[str]:
    """One line for every series that leaves its tolerance, with the time and size of the largest difference."""
    if found["time"] != stored["time"] or set(found) != set(stored):
        return [
            f"other series or times: {sorted(found)} at {found['time']}, stored {sorted(stored)} at {stored['time']}"
        ]
    lines = []
    for name, tolerance in selection.items():
        one, other = np.array(found[name], dtype=float), np.array(stored[name], dtype=float)
        if one.shape != other.shape:
            lines.append(f"{name}: shape {one.shape}, stored {other.shape}")
            continue
        limit = tolerance.absolute + tolerance.relative * float(np.abs(other).max())
        off = np.abs(one - other).reshape(len(one), -1).max(axis=1)
        if not (off <= limit).all():
            worst = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
            moment = f"{name} at t = {found['time'][worst]} s"
            lines.append(f"{moment}: off by {off[worst]:.3g}, allowed {limit:.3g} ({tolerance.reason})")
    return lines
