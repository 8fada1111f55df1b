"""Faults of a recording, drawn and written into its files: tables and `recording.yaml` of any rig.

What a laboratory does wrong, in the files that it hands over. Nothing here knows a rig: columns are numbers with a
unit, and courses of inputs are rows under `overrides`.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from cosim.unit.protocol import Array

Rng = np.random.Generator

#: Unit to others in which a sensor of it may have read: factor and offset from the one to the other. Sources: BIPM, The
#: International System of Units, 9th ed., 2019; NIST SP 811, 2008, appendix B.
READ_IN: Mapping[str, tuple[tuple[str, float, float], ...]] = {
    "degC": (("degF", 1.8, 32.0), ("K", 1.0, 273.15)),
    "degF": (("degC", 1.0 / 1.8, -32.0 / 1.8),),
    "K": (("degC", 1.0, -273.15),),
    "bar": (("psi", 14.5038, 0.0), ("kPa", 100.0, 0.0), ("atm", 0.986923, 0.0)),
    "kPa": (("psi", 0.145038, 0.0), ("mbar", 10.0, 0.0), ("mmHg", 7.50062, 0.0)),
    "mbar": (("mmHg", 0.750062, 0.0), ("Pa", 100.0, 0.0)),
    "Pa": (("kPa", 1e-3, 0.0), ("mmHg", 7.50062e-3, 0.0)),
    "mm": (("in", 1.0 / 25.4, 0.0), ("cm", 0.1, 0.0)),
    "cm": (("in", 1.0 / 2.54, 0.0), ("mm", 10.0, 0.0)),
    "m": (("ft", 1.0 / 0.3048, 0.0), ("cm", 100.0, 0.0)),
    "um": (("mil", 1.0 / 25.4, 0.0),),
    "deg": (("rad", np.pi / 180.0, 0.0), ("gon", 10.0 / 9.0, 0.0)),
    "rad": (("deg", 180.0 / np.pi, 0.0),),
    "deg/s": (("rad/s", np.pi / 180.0, 0.0), ("rpm", 1.0 / 6.0, 0.0)),
    "rpm": (("rad/s", np.pi / 30.0, 0.0), ("Hz", 1.0 / 60.0, 0.0)),
    "rad/s": (("rpm", 30.0 / np.pi, 0.0),),
    "V": (("mV", 1e3, 0.0),),
    "mV": (("V", 1e-3, 0.0),),
    "A": (("mA", 1e3, 0.0),),
    "mA": (("A", 1e-3, 0.0),),
    "N": (("lbf", 1.0 / 4.44822, 0.0), ("kgf", 1.0 / 9.80665, 0.0)),
    "N*m": (("lbf*ft", 1.0 / 1.35582, 0.0),),
    "kg": (("lb", 1.0 / 0.45359237, 0.0),),
    "g": (("oz", 1.0 / 28.3495, 0.0),),
    "m/s": (("km/h", 3.6, 0.0), ("knot", 1.0 / 0.514444, 0.0)),
    "km/h": (("mph", 1.0 / 1.609344, 0.0), ("m/s", 1.0 / 3.6, 0.0)),
    "L/min": (("m^3/h", 0.06, 0.0), ("gal/min", 1.0 / 3.785412, 0.0)),
    "W": (("kW", 1e-3, 0.0),),
    "%": (("1", 0.01, 0.0),),
}
#: Channels whose readings have no sign, so that a reversed one is no mistake that anybody makes.
UNSIGNED = ("degC", "degF", "K", "%", "kg", "g", "L", "mL")


@dataclass(frozen=True)
class Fault:
    """What was done to a recording.

    Args:
        kind: Of the fault.
        recording: Folder of the recording.
        subjects: Channels or inputs concerned; empty: all of it.
        told: In words, with its size.
    """

    kind: str
    recording: str
    subjects: tuple[str, ...]
    told: str


@dataclass
class Files:
    """A recording as it lies in its folder.

    Args:
        folder: Of the recording.
        keys: Of `recording.yaml`.
        tables: Name of a file to its columns, header to cells; every cell a number, empty ones not a number.
    """

    folder: Path
    keys: dict[str, Any]
    tables: dict[str, dict[str, Array]]

    @property
    def channels(self) -> dict[str, dict[str, Any]]:
        """What `recording.yaml` says of each channel."""
        found: dict[str, dict[str, Any]] = self.keys["channels"]
        return found

    def table(self, entry: Mapping[str, Any]) -> dict[str, Array]:
        """Columns of the table in which something stands."""
        return self.tables[entry.get("table", self.keys["table"])]

    def values(self, name: str) -> Array:
        """Readings of a channel."""
        found: Array = self.table(self.channels[name])[self.channels[name]["column"]]
        return found

    def put(self, name: str, values: Array) -> None:
        """Other readings of a channel."""
        self.table(self.channels[name])[self.channels[name]["column"]] = values

    def times(self, name: str) -> Array:
        """Times of a channel from the first on, in the unit of its clock."""
        entry = self.channels[name]
        clock = entry.get("time", self.keys["time"])
        found = self.table(entry)[clock["column"]]
        return np.asarray(found - found[0])

    def courses(self) -> dict[str, list[list[str]]]:
        """`component.output` to its rows of instant and level under `overrides`, where it has three or more."""
        found = {}
        for name, component in self.keys.get("overrides", {}).get("components", {}).items():
            for output, given in component.get("outputs", {}).items():
                if isinstance(given, dict) and len(given.get("points", ())) >= 3:
                    found[f"{name}.{output}"] = given["points"]
        return found


def read(folder: Path) -> Files:
    """A recording's files."""
    keys = yaml.safe_load((folder / "recording.yaml").read_text(encoding="utf-8"))
    names = {keys["table"], *(e["table"] for e in keys["channels"].values() if "table" in e)}
    return Files(folder, keys, {name: _columns(folder / name) for name in sorted(names)})


def written(files: Files) -> None:
    """Write them anew."""
    text = yaml.safe_dump(files.keys, sort_keys=False, allow_unicode=True)
    (files.folder / "recording.yaml").write_text(text, encoding="utf-8")
    for name, columns in files.tables.items():
        rows = [",".join(columns)]
        rows += [",".join("" if np.isnan(v) else f"{v:.9g}" for v in row) for row in zip(*columns.values())]
        (files.folder / name).write_text("\n".join(rows) + "\n", encoding="utf-8")


def _columns(path: Path) -> dict[str, Array]:
    with path.open(encoding="utf-8", newline="") as file:
        first = file.readline()
        file.seek(0)
        is_comma = ";" in first
        header, *rows = csv.reader(file, delimiter=";" if is_comma else ",")
    cells = [[float(c.replace(",", ".") if is_comma else c) if c else np.nan for c in row] for row in rows]
    return dict(zip(header, np.array(cells, dtype=np.float64).T))


def _one(rng: Rng, names: list[str]) -> str | None:
    return str(rng.choice(sorted(names))) if names else None


def _stretch(rng: Rng, times: Array) -> Array:
    """A stretch of 15 to 40 % of a recording, as a mask."""
    length, end = rng.uniform(0.15, 0.4), float(times[-1])
    begin = rng.uniform(0.1, 0.9 - length)
    return np.asarray((times >= begin * end) & (times <= (begin + length) * end))


def other_unit(files: Files, rng: Rng) -> Fault | None:
    """A sensor that read in another unit than is stated."""
    name = _one(rng, [n for n, e in files.channels.items() if e["unit"] in READ_IN])
    if name is None:
        return None
    stated = files.channels[name]["unit"]
    unit, factor, offset = READ_IN[stated][int(rng.integers(len(READ_IN[stated])))]
    files.put(name, factor * files.values(name) + offset)
    return Fault("unit", files.folder.name, (name,), f"{name} read in {unit}, {stated} is stated")


def exchanged(files: Files, rng: Rng) -> Fault | None:
    """Two columns of one unit exchanged."""
    pairs = [
        (a, b)
        for a in files.channels
        for b in files.channels
        if a < b
        and files.channels[a]["unit"] == files.channels[b]["unit"]
        and files.table(files.channels[a]) is files.table(files.channels[b])
    ]
    if not pairs:
        return None
    a, b = pairs[int(rng.integers(len(pairs)))]
    first, second = files.values(a), files.values(b)
    files.put(a, second)
    files.put(b, first)
    return Fault("swapped", files.folder.name, (a, b), f"{a} and {b} exchanged")


def reversed_sign(files: Files, rng: Rng) -> Fault | None:
    """A sensor with its leads exchanged."""
    name = _one(rng, [n for n, e in files.channels.items() if e["unit"] not in UNSIGNED])
    if name is None:
        return None
    files.put(name, -files.values(name))
    return Fault("sign", files.folder.name, (name,), f"{name} with the opposite sign")


def gain(files: Files, rng: Rng) -> Fault | None:
    """A sensor that reads too much or too little, about zero."""
    name = str(rng.choice(sorted(files.channels)))
    factor = float(rng.choice([rng.uniform(0.6, 0.85), rng.uniform(1.18, 1.6)]))
    files.put(name, factor * files.values(name))
    return Fault("gain", files.folder.name, (name,), f"{name} reads {factor:.3f} times what it should")


def _moved(files: Files, move: Callable[[Array], Array]) -> None:
    """Every clock, by a function of the time since the begin in the clock's unit; rows that would not rise are left."""
    for columns, clock in _clocks(files):
        begin = columns[clock][0]
        new = begin + move(columns[clock] - begin)
        rises = np.concatenate([[True], new[1:] > np.maximum.accumulate(new)[:-1]])
        columns[clock] = new
        for header in columns:
            columns[header] = columns[header][rises]


def _clocks(files: Files) -> list[tuple[dict[str, Array], str]]:
    """Tables with the header of their clock."""
    every = [files.keys, *files.channels.values()]
    found = {e.get("table", files.keys["table"]): e.get("time", files.keys["time"])["column"] for e in every}
    return [(files.tables[name], column) for name, column in found.items()]


def clock_rate(files: Files, rng: Rng) -> Fault | None:
    """A logger whose clock runs too fast or too slow."""
    rate = 1.0 + float(rng.choice([-1.0, 1.0])) * rng.uniform(0.008, 0.03)
    _moved(files, lambda t: rate * t)
    return Fault("clock", files.folder.name, (), f"the logger counts {rate:.4f} s for each second")


def clock_offset(files: Files, rng: Rng) -> Fault | None:
    """A logger that was started at another time than is stated."""
    end = max(float(columns[clock][-1] - columns[clock][0]) for columns, clock in _clocks(files))
    late = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.02, 0.06) * end
    _moved(files, lambda t: t + late)
    return Fault("clock", files.folder.name, (), f"times {late:+.4g} off (begin), of {end:.4g}")


def clock_jump(files: Files, rng: Rng) -> Fault | None:
    """A clock that was set, or stood still, in between."""
    end = max(float(columns[clock][-1] - columns[clock][0]) for columns, clock in _clocks(files))
    at, size = rng.uniform(0.25, 0.75) * end, float(rng.choice([-1.0, 1.0])) * rng.uniform(0.02, 0.06) * end
    _moved(files, lambda t: np.where(t >= at, t + size, t))
    return Fault("clock", files.folder.name, (), f"times {size:+.4g} off from {at:.4g} on, of {end:.4g}")


def stuck(files: Files, rng: Rng) -> Fault | None:
    """A sensor that shows its last value for a while."""
    name = str(rng.choice(sorted(files.channels)))
    values, held = files.values(name).copy(), _stretch(rng, files.times(name))
    values[held] = values[np.argmax(held)]
    files.put(name, values)
    return Fault("sensor", files.folder.name, (name,), f"{name} stuck for {np.mean(held):.0%}")


def offset(files: Files, rng: Rng) -> Fault | None:
    """A sensor that is off for a while."""
    name = str(rng.choice(sorted(files.channels)))
    values, off = files.values(name).copy(), _stretch(rng, files.times(name))
    size = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.3, 1.0) * float(np.nanstd(values))
    values[off] += size
    files.put(name, values)
    return Fault("sensor", files.folder.name, (name,), f"{name} off by {size:.4g} for {np.mean(off):.0%}")


def drift(files: Files, rng: Rng) -> Fault | None:
    """A sensor that drifts over the recording."""
    name = str(rng.choice(sorted(files.channels)))
    values, times = files.values(name), files.times(name)
    size = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.5, 1.5) * float(np.nanstd(values))
    files.put(name, values + size * times / times[-1])
    return Fault("sensor", files.folder.name, (name,), f"{name} drifts by {size:.4g}")


def lag(files: Files, rng: Rng) -> Fault | None:
    """A sensor with a lag of first order."""
    name = str(rng.choice(sorted(files.channels)))
    values, times = files.values(name).copy(), files.times(name)
    tau = rng.uniform(0.02, 0.06) * float(times[-1])
    for i in range(1, len(values)):
        share = 1.0 - np.exp(-(times[i] - times[i - 1]) / tau)
        values[i] = values[i - 1] + share * (values[i] - values[i - 1]) if np.isfinite(values[i - 1]) else values[i]
    files.put(name, values)
    return Fault("sensor", files.folder.name, (name,), f"{name} lags by {tau:.4g}, of {times[-1]:.4g}")


def clipped(files: Files, rng: Rng) -> Fault | None:
    """A sensor whose range ends within the readings."""
    name = str(rng.choice(sorted(files.channels)))
    top = float(np.nanquantile(files.values(name), rng.uniform(0.65, 0.85)))
    files.put(name, np.minimum(files.values(name), top))
    return Fault("sensor", files.folder.name, (name,), f"{name} ends at {top:.4g}")


def _level(text: str) -> tuple[float, str]:
    number, _, unit = text.partition(" ")
    return float(number), unit


def _text(number: float, unit: str) -> str:
    return f"{number:.10g} {unit}".strip()


def size_of_input(files: Files, rng: Rng) -> Fault | None:
    """An input of which other levels are stated than acted."""
    courses = files.courses()
    name = _one(rng, [n for n, rows in courses.items() if len({_level(v)[0] for _, v in rows}) > 1])
    if name is None:
        return None
    factor = float(rng.choice([rng.uniform(0.6, 0.85), rng.uniform(1.18, 1.6)]))
    for row in courses[name]:
        number, unit = _level(row[1])
        row[1] = _text(factor * number, unit)
    return Fault("input", files.folder.name, (name,), f"{name} is stated {factor:.3f} times too large")


def pause_of_input(files: Files, rng: Rng) -> Fault | None:
    """An input that acted otherwise than is stated between two of its rows."""
    courses = files.courses()
    name = _one(rng, [n for n, rows in courses.items() if len(rows) >= 5 and len({v for _, v in rows}) > 2])
    if name is None:
        return None
    rows = courses[name]
    first = int(rng.integers(1, len(rows) - 2))
    levels = [_level(v)[0] for _, v in rows]
    number, unit = _level(rows[first][1])
    span = max(levels) - min(levels)
    other = max(levels) if number < np.mean(levels) else min(levels)
    if abs(other - number) < 0.3 * span:
        return None
    rows[first][1] = _text(other, unit)
    return Fault(
        "input", files.folder.name, (name,), f"{name} at {number:.4g} from {rows[first][0]}, stated {other:.4g} {unit}"
    )


def other_course(files: Files, rng: Rng) -> Fault | None:
    """An input of which the course of another recording is stated."""
    name = _one(rng, list(files.courses()))
    others = [read(p.parent) for p in sorted(files.folder.parent.glob("*/recording.yaml")) if p.parent != files.folder]
    own = [o.courses()[name] for o in others if name in o.courses()] if name else []
    if name is None or not own:
        return None
    files.courses()[name][:] = own[0]
    return Fault("input", files.folder.name, (name,), f"the course of {name} is that of another recording")


#: Every fault, in the order in which cases take turns.
FAULTS: tuple[Callable[[Files, Rng], Fault | None], ...] = (
    other_unit,
    clock_rate,
    size_of_input,
    exchanged,
    clock_jump,
    stuck,
    reversed_sign,
    pause_of_input,
    gain,
    clock_offset,
    offset,
    other_course,
    drift,
    lag,
    clipped,
)
