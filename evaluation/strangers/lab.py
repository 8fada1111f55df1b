"""A laboratory that is not this project's: courses by its own integrator, sensors, loggers, and their files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from cosim.unit.protocol import Array

#: Seconds in a unit of time.
SECONDS = {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}


@dataclass(frozen=True)
class Steps:
    """An input that is held between instants.

    Args:
        times: Instants [s], from 0.
        levels: Value from each of them on.
    """

    times: tuple[float, ...]
    levels: tuple[float, ...]

    def at(self, t: Array) -> Array:
        """Values at times."""
        return np.asarray(self.levels)[np.searchsorted(self.times, np.asarray(t) + 1e-9, side="right") - 1]


def drawn_steps(rng: np.random.Generator, stop: float, dwell: float, low: float, high: float, grid: float) -> Steps:
    """Random levels for random times around a dwell, on a grid of instants [s]."""
    times, levels, t = [0.0], [float(f"{rng.uniform(low, high):.3g}")], 0.0
    while True:
        t += grid * round(rng.uniform(0.5, 1.5) * dwell / grid)
        if t >= stop - dwell / 4:
            return Steps(tuple(times), tuple(levels))
        times.append(t)
        levels.append(float(f"{rng.uniform(low, high):.3g}"))


def course(
    rates: Callable[[float, Array, Array], Any],
    start: Sequence[float],
    inputs: Sequence[Steps],
    stop: float,
    step: float,
) -> tuple[Array, Array]:
    """Times and states by classical Runge-Kutta, inputs held over each step."""
    count = round(stop / step)
    times = step * np.arange(count + 1)
    u = np.stack([s.at(times) for s in inputs], axis=1) if inputs else np.zeros((count + 1, 0))
    x = np.asarray(start, dtype=float)
    states = np.empty((count + 1, len(x)))
    states[0] = x
    for i in range(count):
        t, v = times[i], u[i]
        a = np.asarray(rates(t, x, v))
        b = np.asarray(rates(t + step / 2, x + step / 2 * a, v))
        c = np.asarray(rates(t + step / 2, x + step / 2 * b, v))
        d = np.asarray(rates(t + step, x + step * c, v))
        x = x + step / 6 * (a + 2 * b + 2 * c + d)
        states[i + 1] = x
    return times, states


@dataclass(frozen=True)
class Sensor:
    """One column of a logger.

    Args:
        name: Channel of the scenario.
        column: Its header.
        unit: Of the values.
        read: Values in that unit, from times [s], states and inputs of shape (times, ...).
        noise: Standard deviation in that unit.
        every: Between two readings [s].
        stated: What the sidecar says of the noise, as a multiple of it; None: nothing.
        quantum: Of the converter.
        colour: Correlation of neighbouring readings' noise.
        wild: Share of wild readings, of 15 deviations.
        more: Further keys of the sidecar.
    """

    name: str
    column: str
    unit: str
    read: Callable[[Array, Array, Array], Array]
    noise: float
    every: float
    stated: float | None = 1.0
    quantum: float = 0.0
    colour: float = 0.0
    wild: float = 0.0
    more: Mapping[str, Any] = field(default_factory=dict)

    def readings(self, t: Array, x: Array, u: Array, rng: np.random.Generator) -> Array:
        """What it shows."""
        noise = rng.standard_normal(len(t))
        if self.colour:
            for i in range(1, len(noise)):
                noise[i] = self.colour * noise[i - 1] + np.sqrt(1 - self.colour**2) * noise[i]
        values = self.read(t, x, u) + self.noise * noise
        if self.wild:
            hit = rng.random(len(t)) < self.wild
            values[hit] += 15 * self.noise * rng.choice([-1, 1], hit.sum())
        return np.round(values / self.quantum) * self.quantum if self.quantum else values


@dataclass(frozen=True)
class Logger:
    """How a recording is written.

    Args:
        unit: Of time.
        zero: Reading of the clock at the begin, in that unit.
        rate: Of the clock, 1 where it is right; what is stated is 1.
        jitter: Of the times of readings, as a share of their interval.
        is_comma: Whether decimals have a comma and columns a semicolon.
        gap: Stretch without readings [s].
        empty: Share of empty cells.
    """

    unit: str = "s"
    zero: float = 0.0
    rate: float = 1.0
    jitter: float = 0.0
    is_comma: bool = False
    gap: tuple[float, float] | None = None
    empty: float = 0.0


def write(
    folder: Path,
    rng: np.random.Generator,
    times: Array,
    states: Array,
    sensors: Sequence[Sensor],
    programmes: Mapping[str, tuple[Steps, str]],
    logger: Logger = Logger(),
    recorded: Sequence[str] = (),
    sidecar: Mapping[str, Any] | None = None,
    spoil: Callable[[str, Array, Array], Array] | None = None,
    told: Mapping[str, Steps] | None = None,
) -> None:
    """Tables and `recording.yaml`.

    Args:
        folder: Of the recording.
        rng: Noise.
        times: Of the course [s].
        states: Of the course, shape (times, states).
        sensors: What was measured; sensors of one rate share a table.
        programmes: `component.output` to its course and unit, as they were.
        logger: How it is written.
        recorded: Programmes whose course stands in a column.
        sidecar: Further keys.
        spoil: From column, times [s] and values to the values that were logged.
        told: What the sidecar says of a programme instead.
    """
    folder.mkdir(parents=True, exist_ok=True)
    inputs = [s for s, _ in programmes.values()]
    per = SECONDS[logger.unit]
    stop = float(times[-1])
    keys: dict[str, Any] = {"title": folder.name.replace("_", " "), "source": "made"}
    channels: dict[str, Any] = {}
    rates = sorted({s.every for s in sensors})
    column_of_time = f"time_{logger.unit}"
    for number, every in enumerate(rates):
        t = np.arange(0.0, stop + every / 2, every)
        t = t[t <= stop + 1e-9]
        if logger.jitter:
            t = np.sort(np.clip(t + logger.jitter * every * rng.uniform(-0.5, 0.5, len(t)), 0.0, stop))
        if logger.gap:
            t = t[(t < logger.gap[0]) | (t > logger.gap[1])]
        x = np.stack([np.interp(t, times, s) for s in states.T], axis=1)
        u = np.stack([s.at(t) for s in inputs], axis=1) if inputs else np.zeros((len(t), 0))
        columns: dict[str, Array] = {column_of_time: logger.zero + t * logger.rate / per}
        if number == 0:
            for name in recorded:
                columns[name.partition(".")[2]] = (told or {}).get(name, programmes[name][0]).at(t)
        name = "data.csv" if number == 0 else f"data_{number + 1}.csv"
        clock = {"column": column_of_time, "unit": logger.unit, "zero": logger.zero}
        for sensor in (s for s in sensors if s.every == every):
            values = sensor.readings(t, x, u, rng)
            if spoil is not None:
                values = spoil(sensor.column, t, values)
            if logger.empty:
                values = np.where(rng.random(len(t)) < logger.empty, np.nan, values)
            columns[sensor.column] = values
            channel: dict[str, Any] = {"column": sensor.column, "unit": sensor.unit}
            if sensor.stated is not None:
                channel["noise"] = f"{sensor.stated * sensor.noise:.4g} {sensor.unit}".strip()
            if sensor.quantum:
                channel["quantum"] = f"{sensor.quantum:.4g} {sensor.unit}".strip()
            if number:
                channel |= {"table": name, "time": dict(clock)}
            channels[sensor.name] = channel | dict(sensor.more)
        _table(folder / name, columns, logger.is_comma)
        if number == 0:
            keys |= {"table": name, "time": clock}
    held = {n: v for n, v in programmes.items() if n not in recorded}
    components: dict[str, Any] = {}
    for name, (steps, unit) in held.items():
        component, _, output = name.partition(".")
        steps = (told or {}).get(name, steps)
        points = [[f"{t:.10g} s", f"{v:.10g} {unit}".strip()] for t, v in zip(steps.times, steps.levels)]
        components.setdefault(component, {"outputs": {}})["outputs"][output] = {"points": points}
    keys["overrides"] = {"time": {"stop": f"{stop:.10g} s"}}
    if components:
        keys["overrides"]["components"] = components
    if recorded:
        keys["inputs"] = {n: {"column": n.partition(".")[2], "unit": programmes[n][1]} for n in recorded}
    keys["channels"] = channels
    for key, value in (sidecar or {}).items():
        if key == "components":
            for name, more in value.items():
                keys["overrides"].setdefault("components", {}).setdefault(name, {}).update(more)
        else:
            keys[key] = value
    (folder / "recording.yaml").write_text(yaml.safe_dump(keys, sort_keys=False, allow_unicode=True), encoding="utf-8")


def _table(path: Path, columns: Mapping[str, Array], is_comma: bool) -> None:
    separator = ";" if is_comma else ","
    lines = [separator.join(columns)]
    for row in zip(*columns.values()):
        cells = ["" if np.isnan(v) else f"{v:.9g}" for v in row]
        lines.append(separator.join(c.replace(".", ",") for c in cells) if is_comma else separator.join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
