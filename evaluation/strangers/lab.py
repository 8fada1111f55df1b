"""A laboratory that is not this project's: courses by its own integrator, sensors, loggers, and their files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from cosim.unit.protocol import Array

#: 0 degC [K].
CELSIUS = 273.15
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
        return np.asarray(self.levels, dtype=np.float64)[
            np.searchsorted(self.times, np.asarray(t) + 1e-9, side="right") - 1
        ]


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
    times: Array = step * np.arange(count + 1, dtype=np.float64)
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


def celsius(state: int) -> Callable[[Array, Array, Array], Array]:
    """Reading of a temperature that is a state [degC]."""
    return lambda t, x, u: np.asarray(x[:, state] - CELSIUS)


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

    def entry(self) -> dict[str, Any]:
        """What the sidecar says of it."""
        found: dict[str, Any] = {"column": self.column, "unit": self.unit}
        if self.stated is not None:
            found["noise"] = f"{self.stated * self.noise:.4g} {self.unit}".strip()
        if self.quantum:
            found["quantum"] = f"{self.quantum:.4g} {self.unit}".strip()
        return found | dict(self.more)


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


@dataclass(frozen=True)
class Written:
    """What a recording is made of.

    Args:
        times: Of the course [s].
        states: Of the course, shape (times, states).
        sensors: What was measured; sensors of one rate share a table.
        programmes: `component.output` to its course and unit, as they were.
        logger: How it is written.
        recorded: Programmes whose course stands in a column.
        sidecar: Further keys; `components` goes into `overrides`.
        spoil: From column, times [s] and values to the values that were logged.
        told: What the sidecar says of a programme instead.
    """

    times: Array
    states: Array
    sensors: Sequence[Sensor]
    programmes: Mapping[str, tuple[Steps, str]]
    logger: Logger = field(default_factory=Logger)
    recorded: Sequence[str] = ()
    sidecar: Mapping[str, Any] = field(default_factory=dict)
    spoil: Callable[[str, Array, Array], Array] | None = None
    told: Mapping[str, Steps] = field(default_factory=dict)

    def course(self, name: str) -> Steps:
        """What is said of a programme."""
        return self.told.get(name, self.programmes[name][0])


def write(folder: Path, rng: np.random.Generator, made: Written) -> None:
    """Tables and `recording.yaml`."""
    folder.mkdir(parents=True, exist_ok=True)
    channels: dict[str, Any] = {}
    clock = {"column": f"time_{made.logger.unit}", "unit": made.logger.unit, "zero": made.logger.zero}
    for number, every in enumerate(sorted({s.every for s in made.sensors})):
        name = "data.csv" if number == 0 else f"data_{number + 1}.csv"
        columns, entries = _columns(rng, made, every)
        if number:
            entries = {n: e | {"table": name, "time": dict(clock)} for n, e in entries.items()}
        channels |= entries
        _table(folder / name, columns, made.logger.is_comma)
    keys = {"title": folder.name.replace("_", " "), "source": "made", "table": "data.csv", "time": clock}
    keys["overrides"] = _overrides(made)
    if made.recorded:
        keys["inputs"] = {n: {"column": n.partition(".")[2], "unit": made.programmes[n][1]} for n in made.recorded}
    keys["channels"] = channels
    keys |= {k: v for k, v in made.sidecar.items() if k != "components"}
    (folder / "recording.yaml").write_text(yaml.safe_dump(keys, sort_keys=False, allow_unicode=True), encoding="utf-8")


def _instants(rng: np.random.Generator, logger: Logger, stop: float, every: float) -> Array:
    """Times at which a sensor is read [s]."""
    t = np.arange(0.0, stop + every / 2, every)
    t = t[t <= stop + 1e-9]
    if logger.jitter:
        t = np.sort(np.clip(t + logger.jitter * every * rng.uniform(-0.5, 0.5, len(t)), 0.0, stop))
    if logger.gap:
        t = t[(t < logger.gap[0]) | (t > logger.gap[1])]
    return np.asarray(t)


def _columns(
    rng: np.random.Generator, made: Written, every: float
) -> tuple[dict[str, Array], dict[str, dict[str, Any]]]:
    """Columns of the table of one rate, and what the sidecar says of its channels."""
    logger = made.logger
    t = _instants(rng, logger, float(made.times[-1]), every)
    x = np.stack([np.interp(t, made.times, s) for s in made.states.T], axis=1)
    inputs = [s.at(t) for s, _ in made.programmes.values()]
    u = np.stack(inputs, axis=1) if inputs else np.zeros((len(t), 0))
    columns = {f"time_{logger.unit}": logger.zero + t * logger.rate / SECONDS[logger.unit]}
    if every == min(s.every for s in made.sensors):
        columns |= {n.partition(".")[2]: made.course(n).at(t) for n in made.recorded}
    entries = {}
    for sensor in (s for s in made.sensors if s.every == every):
        values = sensor.readings(t, x, u, rng)
        if made.spoil is not None:
            values = made.spoil(sensor.column, t, values)
        if logger.empty:
            values = np.where(rng.random(len(t)) < logger.empty, np.nan, values)
        columns[sensor.column] = values
        entries[sensor.name] = sensor.entry()
    return columns, entries


def _overrides(made: Written) -> dict[str, Any]:
    """What was done, in the scenario's own keys."""
    components: dict[str, Any] = {}
    for name, (_, unit) in made.programmes.items():
        if name in made.recorded:
            continue
        component, _, output = name.partition(".")
        steps = made.course(name)
        points = [[f"{t:.10g} s", f"{v:.10g} {unit}".strip()] for t, v in zip(steps.times, steps.levels)]
        components.setdefault(component, {"outputs": {}})["outputs"][output] = {"points": points}
    for name, more in made.sidecar.get("components", {}).items():
        components.setdefault(name, {}).update(more)
    found: dict[str, Any] = {"time": {"stop": f"{made.times[-1]:.10g} s"}}
    return found | ({"components": components} if components else {})


def _table(path: Path, columns: Mapping[str, Array], is_comma: bool) -> None:
    separator = ";" if is_comma else ","
    lines = [separator.join(columns)]
    for row in zip(*columns.values()):
        cells = ["" if np.isnan(v) else f"{v:.9g}" for v in row]
        lines.append(separator.join(c.replace(".", ",") for c in cells) if is_comma else separator.join(cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
