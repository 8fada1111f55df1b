"""Readings of two heaters that are not those of the scenario `tclab`: other numbers, and physics that it lacks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from cosim.unit.protocol import Array

#: (time [s], power 1, power 2 [W]), held.
FIRST = ((0.0, 0.0, 0.0), (10.0, 1.0, 0.0), (120.0, 1.0, 0.6), (250.0, 0.1, 0.6), (430.0, 0.8, 0.0))
SECOND = ((0.0, 0.0, 0.0), (60.0, 0.0, 0.9), (190.0, 0.7, 0.2), (330.0, 0.0, 0.9), (390.0, 0.9, 0.9), (520.0, 0.2, 0.3))
SPAN, STEP, NOISE = 600.0, 2.0, 0.08


def temperatures(points: Sequence[Sequence[float]]) -> Array:
    """Both temperatures [degC] every `STEP`, shape (samples, 2), by Euler steps of 0.1 s.

    Heat capacity 40 % and heat loss 30 % off, heat between the heaters, and sensors behind a lag of 12 s: the
    scenario has
    neither.
    """
    times = np.arange(0.0, SPAN, 0.1)
    starts = np.array([p[0] for p in points])
    power = np.array([p[1:] for p in points])[np.searchsorted(starts, times, side="right") - 1]
    body, sensor = np.full(2, 21.0), np.full(2, 21.0)
    found = np.empty((len(times), 2))
    for n in range(len(times)):
        found[n] = sensor
        sensor = sensor + 0.1 * (body - sensor) / 12.0
        body = body + 0.1 * (power[n] - 0.0156 * (body - 21.0) + 0.004 * (body[::-1] - body)) / 2.8
    return np.asarray(found[:: round(STEP / 0.1)])


def readings(points: Sequence[Sequence[float]], seed: int = 0) -> Array:
    """The same with noise."""
    clean = temperatures(points)
    return np.asarray(clean + NOISE * np.random.default_rng(seed).standard_normal(clean.shape))


def instants() -> Array:
    """Times of the readings [s]."""
    return np.arange(0.0, SPAN, STEP)


def programme(points: Sequence[Sequence[float]]) -> dict[str, Any]:
    """Overrides that state what was done."""
    outputs = {f"power_{k}": {"points": [[f"{p[0]} s", f"{p[k]} W"] for p in points]} for k in (1, 2)}
    return {"components": {"drive": {"outputs": outputs}}}


def write(
    folder: Path,
    points: Sequence[Sequence[float]],
    values: Array,
    *,
    times: Array | None = None,
    channel: Mapping[str, Any] | None = None,
    title: str = "",
    **keys: Any,
) -> Path:
    """A recording folder of both heaters, with the programme that it states."""
    folder.mkdir(parents=True)
    data = {"time": instants() if times is None else times, "T1": values[:, 0], "T2": values[:, 1]}
    pd.DataFrame(data).to_csv(folder / "data.csv", index=False)
    entry = {"unit": "degC", "noise": f"{NOISE} K", **(channel or {})}
    sidecar = {
        "title": title or folder.name,
        "table": "data.csv",
        "time": {"column": "time", "zero": 0},
        "overrides": programme(points),
        "uncertain": {"heaters.initial_temperature": "0.2 K"},
        "channels": {f"coil[{k}].temperature": {"column": f"T{k}", **entry} for k in (1, 2)},
        **keys,
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False))
    return folder
