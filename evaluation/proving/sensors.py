"""Sensors: what they see of the truth, and how they spoil it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from evaluation.proving.rig import Array, DataSheet
from evaluation.proving.truth import Trace


@dataclass(frozen=True)
class Kind:
    """Sensors of one quantity.

    Args:
        quantity: Signal of the trace.
        axis: `coil`, `string` or `supply`.
        suffix: Of the channel's name.
        unit: In which they read.
        factor: SI to that unit.
        zero: SI value of its 0.
        noise: Least and greatest standard deviation, SI.
        quantum: Step of the reading, SI.
        rate: Readings per second [1/s].
        pivot: Reading about which a wrong gain turns, SI.
    """

    quantity: str
    axis: str
    suffix: str
    unit: str
    factor: float
    zero: float
    noise: tuple[float, float]
    quantum: float
    rate: float
    pivot: float = 0.0


KINDS = {
    "temperature": Kind("temperature", "coil", "temperature", "degC", 1.0, 273.15, (0.1, 0.4), 0.1, 2.0, 273.15),
    "extension": Kind("extension", "coil", "extension", "mm", 1e3, 0.0, (1e-4, 3.5e-4), 5e-5, 2.0),
    "string": Kind("string", "string", "current", "mA", 1e3, 0.0, (1e-3, 4e-3), 1e-3, 4.0),
    "supply": Kind("supply", "supply", "current", "A", 1.0, 0.0, (3e-3, 8e-3), 1e-3, 4.0),
}


def channel_names(kind: Kind, sheet: DataSheet) -> tuple[str, ...]:
    """Names of all channels of a kind, in the order of its elements."""
    if kind.axis == "supply":
        return (f"supply.{kind.suffix}",)
    if kind.axis == "string":
        return tuple(f"string[{n + 1}].{kind.suffix}" for n in range(len(sheet.strings)))
    if sheet.is_bath or sheet.is_driven_by_power:
        return tuple(f"coil[{n + 1}].{kind.suffix}" for n in range(sheet.coils))
    places = zip(sheet.string_of_coil, sheet.place_in_string)
    return tuple(f"coil[{s + 1},{p + 1}].{kind.suffix}" for s, p in places)


class Distortion(Protocol):
    """What is added to the readings of sensors by a law of other quantities."""

    def along(self, times: Array, variables: Mapping[str, Array]) -> Array:
        """Added at every time [s], shape (times, channels)."""


@dataclass
class Sensors:
    """All sensors of one kind with their small and large faults; arrays have shape (channels,).

    Args:
        kind: What they measure.
        names: Of the channels.
        noise: Standard deviation [SI], one for all.
        lag: Time constant [s].
        gain: Relative error about the pivot [1].
        bias: [SI]
        drift: [SI/s]
        ceiling: Most that is read [SI].
        delay: How much later a reading is stamped than taken [s].
        element: Which element each channel really measures.
        pickup: Reading per ampere of the coil's own current [SI/A].
        bend: Reading lost per square of the distance from the pivot [1/SI].
        dropouts: Share of readings that are missing.
        outliers: Share of readings that are wild.
        jitter: Share of the sampling interval by which readings scatter in time.
        distortion: What else they read, of sensors of temperatures and extensions; None: nothing.
    """

    kind: Kind
    names: tuple[str, ...]
    noise: float
    lag: Array
    gain: Array
    bias: Array
    drift: Array
    ceiling: Array
    delay: Array
    element: np.ndarray[tuple[int], np.dtype[np.int64]]
    pickup: Array
    bend: Array
    dropouts: float = 0.0
    outliers: float = 0.0
    jitter: float = 0.0
    kept: tuple[int, ...] = field(default=())
    distortion: Distortion | None = None

    def rows(self, channels: Sequence[str]) -> list[int]:
        """Numbers of channels."""
        return [self.names.index(c) for c in channels]


def drawn_sensors(kind: Kind, sheet: DataSheet, rng: np.random.Generator) -> Sensors:
    """Sensors as bought: lags up to 80 ms, gains within 0.1 %, a bias within a tenth of the noise, a shared clock."""
    names = channel_names(kind, sheet)
    count = len(names)
    noise = float(rng.uniform(*kind.noise))
    zero = np.zeros(count)
    return Sensors(
        kind,
        names,
        noise,
        lag=np.full(count, rng.uniform(0.0, 0.08)),
        gain=1e-3 * rng.uniform(-1, 1, count),
        bias=0.1 * noise * rng.uniform(-1, 1, count),
        drift=zero.copy(),
        ceiling=np.full(count, np.inf),
        delay=np.full(count, rng.uniform(-0.08, 0.08)),
        element=np.arange(count),
        pickup=zero.copy(),
        bend=zero.copy(),
        dropouts=float(rng.choice([0.0, 0.0, 0.02, 0.1])),
        jitter=float(rng.choice([0.0, 0.0, 0.2])),
    )


@dataclass(frozen=True)
class Readings:
    """What was read.

    Args:
        stamps: Times on the recorder's clock [s], shape (samples,).
        values: SI, not a number where a reading is missing, shape (samples, channels).
        clean: The same before noise, rounding and loss.
    """

    stamps: Array
    values: Array
    clean: Array


def read(sensors: Sensors, trace: Trace, stop: float, rng: np.random.Generator) -> Readings:
    """Readings of one recording.

    Args:
        sensors: The chain: element, lag, clock, pickup, gain and bend, bias, drift, noise, rounding, clipping, loss.
        trace: The truth.
        stop: End [s].
        rng: Source of noise.
    """
    kind = sensors.kind
    stamps = np.arange(0.0, stop + 1e-9, 1.0 / kind.rate)
    stamps[1:-1] += sensors.jitter / kind.rate * rng.uniform(-0.5, 0.5, stamps.size - 2)
    stamps = np.round(stamps, 4)
    times, course = trace.signal(kind.quantity)
    seen = _lagged(times, course[:, sensors.element], sensors.lag)
    if sensors.distortion is not None:
        seen = seen + sensors.distortion.along(times, variables_of(trace, kind.quantity))
    moments = np.clip(stamps[:, None] - sensors.delay, times[0], times[-1])
    columns = range(len(sensors.names))
    clean = np.stack([np.interp(moments[:, c], times, seen[:, c]) for c in columns], axis=1)
    if sensors.pickup.any():
        knots, current = trace.signal("current")
        own = [np.interp(moments[:, c], knots, current[:, sensors.element[c]]) for c in columns]
        clean = clean + sensors.pickup * np.stack(own, axis=1)
    clean = clean + sensors.gain * (clean - kind.pivot) - sensors.bend * (clean - kind.pivot) ** 2
    clean = clean + sensors.bias + sensors.drift * stamps[:, None]
    values = clean + sensors.noise * rng.standard_normal(clean.shape)
    wild = rng.random(clean.shape) < sensors.outliers
    values = np.where(wild, values + 15.0 * sensors.noise * rng.standard_normal(clean.shape), values)
    values = kind.quantum * np.round(values / kind.quantum)
    values, clean = np.minimum(values, sensors.ceiling), np.minimum(clean, sensors.ceiling)
    values[rng.random(clean.shape) < sensors.dropouts] = np.nan
    return Readings(stamps, values, clean)


def variables_of(trace: Trace, quantity: str) -> dict[str, Array]:
    """Variables of every coil at the ends of steps, shape (steps + 1, coils); `own` is the quantity itself."""
    time = np.repeat(trace.time[:, None], trace.states[quantity].shape[1], axis=1)
    flows = {n: np.concatenate([trace.flows[n][:1, 0], trace.flows[n][:, 1]]) for n in ("current", "power")}
    return {"own": trace.states[quantity], "warmth": trace.states["mean_temperature"], "time": time, **flows}


def _lagged(times: Array, course: Array, lag: Array) -> Array:
    """First-order lag of courses that are linear between their knots, exact; shape (knots, channels)."""
    if not (lag > 0.0).any():
        return course
    lag = np.maximum(lag, 1e-9)
    sizes = np.diff(times)[:, None]
    slopes = np.divide(np.diff(course, axis=0), sizes, out=np.zeros_like(course[1:]), where=sizes > 0.0)
    decays = np.exp(-sizes / lag)
    behind = course - lag * np.concatenate([slopes, slopes[-1:]])  # where a course that ran straight for ever would be
    seen = np.empty_like(course)
    seen[0] = value = course[0]
    for n in range(sizes.size):
        if sizes[n, 0] > 0.0:  # a jump takes no time
            value = course[n + 1] - lag * slopes[n] + (value - behind[n]) * decays[n]
        seen[n + 1] = value
    return seen
