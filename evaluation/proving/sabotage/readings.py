"""Readings are not what the recording calls them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from evaluation.proving.sabotage.sabotage import OF_READINGS, Bench, CoilNetwork, Sabotage, within
from evaluation.proving.sensors import Readings, Sensors

_BENCHES: tuple[str, ...] = ("network", "small", "zones", "bath", "heaters")
#: Kelvin at which the scale of Fahrenheit has the same number as that of Celsius has at 0.
_ICE = 273.15


class SwappedColumns(Sabotage):
    """Two channels name each other's column."""

    kind = "swapped_columns"
    law = "each of two channels is read from the column of the other"
    verdicts = OF_READINGS
    setups = _BENCHES
    same_as = ("wrong_identity",)

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        names = bench.sensors["temperature"].names
        if bench.setup.sheet.is_per_string or bench.setup.sheet.is_driven_by_power:  # strings are driven apart
            return cls(bench.all, {}, _apart(names, rng))
        coil = str(rng.choice(list(names)))
        pairs = [(coil, coil.replace("temperature", "extension"))]
        if "supply" in bench.sensors:
            pairs.append((str(rng.choice(list(bench.sensors["string"].names))), bench.sensors["supply"].names[0]))
        return cls(bench.all, {}, pairs[int(rng.integers(len(pairs)))])

    def tell(self, number: int, sidecar: dict[str, Any]) -> dict[str, str]:
        _exchange(sidecar, *self.channels)
        return {}


class SwappedCoils(SwappedColumns):
    """Two coils are exchanged with all that is measured at them."""

    kind = "swapped_coils"
    law = "all channels of each of two coils are read from the columns of the other"
    setups = ("zones",)

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        first, second = _apart(bench.sensors["temperature"].names, rng)
        both = [(n, n.replace("temperature", "extension")) for n in (first, second)]
        return cls(bench.all, {}, [*both[0], *both[1]])

    def tell(self, number: int, sidecar: dict[str, Any]) -> dict[str, str]:
        half = len(self.channels) // 2
        for one, other in zip(self.channels[:half], self.channels[half:]):
            _exchange(sidecar, one, other)
        return {}


def _exchange(sidecar: dict[str, Any], one: str, other: str) -> None:
    entries = sidecar["channels"]
    for key in ("column", "table"):
        entries[one][key], entries[other][key] = entries[other][key], entries[one][key]


def _apart(names: Sequence[str], rng: np.random.Generator) -> tuple[str, str]:
    """Two channels of different strings."""
    first = str(rng.choice(list(names)))
    string = first.split("[")[1].split(",")[0].split("]")[0]
    others = [n for n in names if n.split("[")[1].split(",")[0].split("]")[0] != string]
    return first, str(rng.choice(others))


class WrongUnit(Sabotage):
    """The numbers of a table are in another unit than the recording says."""

    kind = "wrong_unit"
    law = "number = value in `written`, read as `stated`"
    verdicts = OF_READINGS
    setups = _BENCHES

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        modes = [m for m in _UNITS if _UNITS[m][0] in (*bench.sensors, "time")]
        mode = str(rng.choice(modes))
        kind = _UNITS[mode][0]
        channels = bench.sensors[kind].names if kind in bench.sensors else ()
        made = cls(bench.all, {"factor": _UNITS[mode][2]}, channels)
        made._mode = mode
        return made

    _mode = ""

    def spoil(self, number: int, networks: Sequence[CoilNetwork]) -> list[CoilNetwork]:
        if self._mode == "degF as degC":
            return [_on(b, "temperature", lambda t: 1.8 * (t - _ICE) + 32.0 + _ICE) for b in networks]
        if self._mode == "ms as s":
            return [(s, replace(r, stamps=1000.0 * r.stamps)) for s, r in networks]
        return list(networks)

    def tell(self, number: int, sidecar: dict[str, Any]) -> dict[str, str]:
        stated = _UNITS[self._mode][1]
        if stated:
            for name in self.channels:
                sidecar["channels"][name]["unit"] = stated
        return {}

    def answer(self, names: Sequence[str], titles: Sequence[str], stop: float) -> dict[str, Any]:
        return super().answer(names, titles, stop) | {"mistake": self._mode}


#: Mistake: kind of sensors, unit stated where the sidecar is what is wrong, and reading over truth.
_UNITS: dict[str, tuple[str, str, float]] = {
    "mA as A": ("string", "A", 1000.0),
    "A as mA": ("supply", "mA", 0.001),
    "mm as cm": ("extension", "cm", 10.0),
    "degF as degC": ("temperature", "", 1.8),
    "ms as s": ("time", "", 1000.0),
}


def _on(network: CoilNetwork, quantity: str, change: Any) -> CoilNetwork:
    sensors, readings = network
    if sensors.kind.quantity != quantity:
        return network
    return sensors, replace(readings, values=change(readings.values), clean=change(readings.clean))


class ShiftedClock(Sabotage):
    """The recorder's clock is off by more than the recording says it may be."""

    kind = "shifted_clock"
    law = "stamp = t + shift"
    verdicts = OF_READINGS
    setups = _BENCHES
    same_as = ("sensor_clock_offset",)

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        shift = float(rng.choice([-1.0, 1.0])) * float(rng.uniform(0.02, 0.08)) * bench.setup.stop
        numbers = bench.all if rng.random() < 0.5 else (bench.drawn_training(rng),)
        return cls(numbers, {"shift": round(shift, 2)})

    def spoil(self, number: int, networks: Sequence[CoilNetwork]) -> list[CoilNetwork]:
        if not self.concerns(number):
            return list(networks)
        return [(s, restamped(r, r.stamps + self.parameters["shift"])) for s, r in networks]


class DriftingClock(Sabotage):
    """The recorder's clock runs fast or slow."""

    kind = "drifting_clock"
    law = "stamp = t * (1 + rate)"
    verdicts = OF_READINGS
    setups = _BENCHES
    same_as = ("sensor_clock_offset",)

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        rate = float(rng.choice([-1.0, 1.0])) * float(rng.uniform(0.02, 0.06))
        numbers = bench.all if rng.random() < 0.5 else (bench.drawn_training(rng),)
        return cls(numbers, {"rate": rate})

    def spoil(self, number: int, networks: Sequence[CoilNetwork]) -> list[CoilNetwork]:
        if not self.concerns(number):
            return list(networks)
        return [(s, restamped(r, r.stamps * (1.0 + self.parameters["rate"]))) for s, r in networks]


def restamped(readings: Readings, stamps: np.ndarray[Any, np.dtype[np.float64]]) -> Readings:
    """Readings with other stamps; those beyond the ends of the recording are cut off, as whoever wrote it did."""
    kept = (stamps >= 0.0) & (stamps <= readings.stamps[-1])
    return Readings(np.round(stamps[kept], 4), readings.values[kept], readings.clean[kept])


class SensorOff(Sabotage):
    """A sensor is off by a constant for a while."""

    kind = "sensor_off"
    law = "value = truth + bias for begin <= t < end"
    verdicts = OF_READINGS
    setups = _BENCHES

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        sensors = bench.sensors[str(rng.choice(list(bench.sensors)))]
        bias = float(rng.choice([-1.0, 1.0])) * _off_by(sensors, rng)
        return cls(
            (bench.drawn_training(rng),), {"bias": bias}, (str(rng.choice(list(sensors.names))),), bench.span(rng)
        )

    def spoil(self, number: int, networks: Sequence[CoilNetwork]) -> list[CoilNetwork]:
        return [self._spoiled(b) if self.concerns(number) and self.channels[0] in b[0].names else b for b in networks]

    def _spoiled(self, network: CoilNetwork) -> CoilNetwork:
        sensors, readings = network
        added = np.zeros_like(readings.clean)
        added[self.rows(readings), sensors.names.index(self.channels[0])] = self.parameters["bias"]
        return sensors, replace(readings, values=readings.values + added, clean=readings.clean + added)

    def rows(self, readings: Readings) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Readings of the stretch."""
        assert self.span is not None, "a fault of a sensor has begin and end"
        return within(readings.stamps, self.span)


def _off_by(sensors: Sensors, rng: np.random.Generator) -> float:
    """8 to 30 times the noise: a fault that nobody overlooks in a plot."""
    return round(sensors.noise * float(rng.uniform(8.0, 30.0)) / sensors.kind.quantum) * sensors.kind.quantum


class SensorStuck(SensorOff):
    """A sensor gives its last reading again and again for a while."""

    kind = "sensor_stuck"
    law = "value = value(begin) for begin <= t < end"

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        """At a time when something is switched, so that there is something to miss."""
        sensors = bench.sensors[str(rng.choice(list(bench.sensors)))]
        number = bench.drawn_training(rng)
        programme = bench.programmes[number - 1]
        for _ in range(100):
            span = bench.span(rng)
            levels = np.array([programme.at(t) for t in np.linspace(*span, 60)])
            if np.ptp(levels, axis=0).min() > 0.0:
                break
        return cls((number,), {}, (str(rng.choice(list(sensors.names))),), span)

    def _spoiled(self, network: CoilNetwork) -> CoilNetwork:
        sensors, readings = network
        rows, column = np.flatnonzero(self.rows(readings)), sensors.names.index(self.channels[0])
        values, clean = readings.values.copy(), readings.clean.copy()
        seen = np.flatnonzero(np.isfinite(values[: rows[0] + 1, column]))
        values[rows, column] = values[seen[-1], column]
        clean[rows, column] = values[seen[-1], column]
        return sensors, replace(readings, values=values, clean=clean)


SABOTAGES: tuple[type[Sabotage], ...] = (
    SwappedColumns,
    SwappedCoils,
    WrongUnit,
    ShiftedClock,
    DriftingClock,
    SensorOff,
    SensorStuck,
)
