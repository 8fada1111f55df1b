"""Two heaters with numbers and physics that the scenario `tclab` does not have, drawn anew for every recording."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from cosim.unit.protocol import Array

#: Length of a recording and step of the integration [s].
SPAN, STEP = 600.0, 0.25
ROOM = 21.0


@dataclass(frozen=True)
class Rig:
    """What is drawn.

    Args:
        capacity: Of each heater [J/K].
        loss: To the room, and its growth with temperature [W/K], [W/K^2].
        between: Heat between the heaters [W/K].
        fin: Heat capacity of a second mass behind each heater [J/K]; 0 for none.
        to_fin: Heat conducted to it [W/K].
        lag: Of the sensors [s].
        drift: Of the room over the recording [K].
        noise: Of a reading [K].
        interval: Between readings [s].
        contact: Instant and share of power that heater 1 loses for good [s], [1]; share 0 for none.
        draught: Begin, length [s], and what it adds to the loss [W/K]; 0 for none.
    """

    capacity: Array
    loss: tuple[float, float]
    between: float
    fin: float
    to_fin: float
    lag: float
    drift: float
    noise: float
    interval: float
    contact: tuple[float, float]
    draught: tuple[float, float, float]


def drawn(rng: np.random.Generator, slowness: float, has_event: bool) -> Rig:
    """A rig whose time constant is `slowness` times that of the scenario, on average."""
    contact = draught = 0.0
    if has_event:
        contact, draught = (0.3, 0.0) if rng.random() < 0.5 else (0.0, 0.008)
    return Rig(
        2.0 * slowness * np.exp(rng.normal(0.0, 0.25, 2)),
        (0.012 * np.exp(rng.normal(0.0, 0.25)), rng.uniform(0, 8e-5)),
        rng.uniform(0.0, 0.008),
        slowness * rng.uniform(0.2, 1.0) if rng.random() < 0.5 else 0.0,
        rng.uniform(0.005, 0.05),
        rng.uniform(1.0, 20.0),
        rng.uniform(-1.0, 1.0),
        float(np.exp(rng.uniform(np.log(0.03), np.log(0.2)))),
        float(rng.choice([1.0, 2.0, 4.0])),
        (rng.uniform(100.0, 500.0), contact),
        (rng.uniform(100.0, 350.0), rng.uniform(60.0, 150.0), draught),
    )


def programme(rng: np.random.Generator) -> Array:
    """Begin [s] and powers [W] of each stretch, shape (stretches, 3): three to six switches, at least 45 s apart."""
    count = int(rng.integers(3, 7))
    free = SPAN - 60.0 - 45.0 * count
    starts = 20.0 + np.sort(rng.uniform(0.0, free, count)) + 45.0 * np.arange(count)
    rows = [np.zeros(3)]
    for start in np.round(starts):
        powers = rows[-1][1:].copy()
        which = rng.integers(0, 3)
        for k in (0, 1) if which == 2 else (which,):
            levels = np.array([0.0, 0.3, 0.6, 0.9])
            powers[k] = rng.choice(levels[np.abs(levels - powers[k]) > 0.25])
        rows.append(np.array([start, *powers]))
    return np.array(rows)


def temperatures(rig: Rig, points: Array) -> tuple[Array, Array]:
    """Times [s] and what both sensors show without noise [degC], shape (samples, 2), by Euler steps."""
    times = np.arange(0.0, SPAN, STEP)
    power = points[:, 1:][np.searchsorted(points[:, 0], times + 1e-9, side="right") - 1].copy()
    power[times >= rig.contact[0], 0] *= 1.0 - rig.contact[1]
    begin, length, more = rig.draught
    extra = np.where((times >= begin) & (times < begin + length), more, 0.0)
    body, fin, sensor = (np.full(2, ROOM) for _ in range(3))
    found = np.empty((len(times), 2))
    for n, time in enumerate(times):
        found[n] = sensor
        room = ROOM + rig.drift * time / SPAN
        to_fin = rig.to_fin * (body - fin) if rig.fin else np.zeros(2)
        over = body - room
        loss = (rig.loss[0] + rig.loss[1] * over + extra[n]) * over
        sensor = sensor + STEP * (body - sensor) / rig.lag
        body = body + STEP * (power[n] - loss - to_fin + rig.between * (body[::-1] - body)) / rig.capacity
        fin = fin + STEP * to_fin / rig.fin if rig.fin else fin
    every = round(rig.interval / STEP)
    return times[::every], found[::every]


def readings(rig: Rig, points: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """The same with noise."""
    times, values = temperatures(rig, points)
    return times, np.asarray(values + rig.noise * rng.standard_normal(values.shape))


def quiet(rig: Rig) -> Rig:
    """The same without an event."""
    return replace(rig, contact=(0.0, 0.0), draught=(0.0, 0.0, 0.0))


def _table(file: Path, head: str, times: Array, values: Array) -> None:
    np.savetxt(file, np.column_stack([times, values]), "%.12g", ",", header=head, comments="")


def write(
    folder: Path, stated: Array, times: Array, values: Array, noise: float, column: tuple[Array, Array] | None = None
) -> Path:
    """A recording folder that states a programme, and has a column of both inputs where one is given."""
    folder.mkdir(parents=True)
    _table(folder / "data.csv", "time,T1,T2", times, values)
    outputs = {f"power_{k}": {"points": [[f"{p[0]} s", f"{p[k]} W"] for p in stated.tolist()]} for k in (1, 2)}
    sidecar: dict[str, Any] = {
        "title": folder.name,
        "table": "data.csv",
        "time": {"column": "time", "zero": 0},
        "overrides": {"components": {"drive": {"outputs": outputs}}},
        "uncertain": {"heaters.initial_temperature": "0.5 K"},
        "channels": {
            f"coil[{k}].temperature": {"column": f"T{k}", "unit": "degC", "noise": f"{noise:.4g} K"} for k in (1, 2)
        },
    }
    if column is not None:
        stamps, powers = column
        _table(folder / "q.csv", "time,Q1,Q2", stamps, powers)
        sidecar["inputs"] = {
            f"drive.power_{k}": {
                "column": f"Q{k}",
                "unit": "W",
                "table": "q.csv",
                "time": {"column": "time", "zero": 0},
            }
            for k in (1, 2)
        }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False))
    return folder
