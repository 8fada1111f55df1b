"""A sensor: what becomes of a quantity on its way into a table."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field, StrictBool, model_validator

from cosim.components import AnyQuantity, Strict, Time
from cosim.unit.protocol import Array
from cosim.unit.quantity import In, PhysicalValue, conversion
from cosim.yaml_file import read_model
from diagnosis.recording.quantity import Target
from diagnosis.recording.series import Series, sample

_ZERO_TIME = PhysicalValue(0.0, "s")
_NotNegative = Annotated[PhysicalValue, In("s", minimum=0.0)]


class Sensor(Strict):
    """Of one channel or of several; what is left out is perfect."""

    unit: str | None = Field(default=None, description="Unit of the table; default degC for temperatures, else SI.")
    rate: Annotated[PhysicalValue, In("Hz", minimum=0.0, is_exclusive=True)] = PhysicalValue(10.0, "Hz")
    jitter: _NotNegative = Field(default=_ZERO_TIME, description="Deviation of the instants of reading; recorded.")
    clock_offset: Time = Field(default=_ZERO_TIME, description="Its clock shows the scenario's time plus this.")
    lag: _NotNegative = Field(default=_ZERO_TIME, description="Time constant with which it follows.")
    gain: float = Field(default=1.0, gt=0.0, allow_inf_nan=False, description="Of the value in its unit.")
    bias: AnyQuantity | None = Field(default=None, description="Added to the value.")
    drift: AnyQuantity | None = Field(default=None, description="Added per second, for example 0.01 K/s.")
    noise: AnyQuantity | None = Field(default=None, description="Standard deviation of white noise.")
    minimum: AnyQuantity | None = Field(default=None, description="Smallest reading.")
    maximum: AnyQuantity | None = Field(default=None, description="Largest reading.")
    quantum: AnyQuantity | None = Field(default=None, description="Step of the reading.")
    drop_outs: float = Field(default=0.0, ge=0.0, lt=1.0, description="Share of readings that are lost.")
    gaps: list[tuple[Time, Time]] = Field(default=[], description="Times from and to which nothing is read.")
    is_noise_stated: StrictBool = Field(default=True, description="Whether recording.yaml states the noise.")
    lag_bound: _NotNegative = Field(default=_ZERO_TIME, description="Stated in recording.yaml.")
    offset_bound: _NotNegative = Field(default=_ZERO_TIME, description="Stated in recording.yaml.")
    bias_bound: AnyQuantity | None = Field(default=None, description="Stated in recording.yaml.")

    @model_validator(mode="after")
    def _check(self) -> Sensor:
        for begin, end in self.gaps:
            if end.to("s") <= begin.to("s"):
                raise ValueError(f"gaps: {end} does not come after {begin}")
        return self


class SensorFile(Strict):
    """Sensors by channel: `coil[2,5].temperature` holds before `coil.temperature`, that before `default`."""

    default: Sensor = Sensor()
    channels: dict[str, Sensor] = {}

    def of(self, target: Target) -> Sensor:
        """The sensor of a channel."""
        for name in (str(target), f"{target.kind}.{target.quantity}"):
            if name in self.channels:
                return self.channels[name]
        return self.default


def load_sensors(path: Path) -> SensorFile:
    """Read `sensors.yaml`.

    Raises:
        InputError: It cannot be read, or a key or value is wrong.
    """
    return read_model(
        path,
        SensorFile,
        "sensors are a mapping with the keys default and channels",
        "docs/recordings.md lists the keys of a sensor",
        "see docs/recordings.md",
    )


@dataclass(frozen=True)
class Reading:
    """What a sensor wrote down.

    Args:
        times: Of its clock [s], rising, shape (readings,).
        values: In `unit`, shape (readings,); not a number where a reading was lost.
        unit: Unit.
    """

    times: Array
    values: Array
    unit: str


def read_with(sensor: Sensor, series: Series, random: np.random.Generator) -> Reading:
    """Readings of a quantity over a run.

    The quantity is smoothed by the lag, then taken at the instants of reading; gain, bias and drift; noise; clipping;
    rounding; losses. All but the lag act on the value in the sensor's unit.

    Args:
        sensor: The sensor.
        series: The quantity.
        random: Source of noise, jitter and losses.

    Raises:
        ValueError: A quantity of the sensor is not in the unit of the channel.
    """
    unit = sensor.unit or {"K": "degC"}.get(series.unit, series.unit)
    factor, offset = conversion(series.unit, unit)
    lagged = Series(series.times, lag(series.times, series.values, sensor.lag.to("s")), series.is_flow, series.unit)
    instants = _instants(sensor, float(series.times[0]), float(series.times[-1]), random)
    values = factor * sample(lagged, instants) + offset
    drift = 0.0 if sensor.drift is None else sensor.drift.to(f"{_difference_unit(unit)}/s")
    values = sensor.gain * values + _size(sensor.bias, unit) + drift * (instants - instants[0])
    values += _size(sensor.noise, unit) * random.standard_normal(len(values))
    low = -math.inf if sensor.minimum is None else sensor.minimum.to(unit)
    high = math.inf if sensor.maximum is None else sensor.maximum.to(unit)
    values = np.clip(values, low, high)
    quantum = _size(sensor.quantum, unit)
    if quantum:
        values = quantum * np.round(values / quantum)
    values[_lost(sensor, instants, random)] = math.nan
    return Reading(instants + sensor.clock_offset.to("s"), values, unit)


def lag(times: Array, values: Array, time_constant: float) -> Array:
    """First-order lag of a course that is straight between its samples, exact; it begins settled.

    Args:
        times: Shape (samples,) [s].
        values: Shape (samples,).
        time_constant: [s]; 0 changes nothing.
    """
    if time_constant == 0.0:
        return values
    found = values.copy()
    steps = np.diff(times)
    for i, step in enumerate(steps.tolist()):
        slope = (values[i + 1] - values[i]) / step
        # y' = (x - y) / tau with x a straight line: y follows at a distance of slope * tau.
        behind = found[i] - (values[i] - slope * time_constant)
        found[i + 1] = values[i + 1] - slope * time_constant + behind * math.exp(-step / time_constant)
    return found


def _instants(sensor: Sensor, begin: float, end: float, random: np.random.Generator) -> Array:
    period = 1.0 / sensor.rate.to("Hz")
    instants = begin + period * np.arange(math.floor((end - begin) / period + 1e-9) + 1)
    if sensor.jitter.number:
        # At most 0.4 periods each way, so that the instants still rise.
        moved = np.clip(sensor.jitter.to("s") * random.standard_normal(len(instants)), -0.4 * period, 0.4 * period)
        instants = np.clip(instants + moved, begin, end)
    return np.unique(instants)


def _lost(sensor: Sensor, instants: Array, random: np.random.Generator) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    lost = random.random(len(instants)) < sensor.drop_outs
    for begin, end in sensor.gaps:
        lost |= (instants >= begin.to("s")) & (instants <= end.to("s"))
    return np.asarray(lost)


def _difference_unit(unit: str) -> str:
    return {"degC": "K", "degF": "delta_degF"}.get(unit, unit)


def _size(value: PhysicalValue | None, unit: str) -> float:
    """A difference of readings in a unit: 0.3 degC of noise are 0.3 K.

    Raises:
        ValueError: It measures something else.
    """
    if value is None:
        return 0.0
    return value.number * conversion(value.unit or unit, unit)[0]
