"""Write a recording folder: tables by clock, and recording.yaml with what a laboratory knows of its sensors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]
import yaml

from cosim.run_folder import write_atomically, writing
from cosim.unit.errors import InputError
from diagnosis.recording.sensor import Reading, Sensor


@dataclass(frozen=True)
class Recorded:
    """One channel as it was read.

    Args:
        reading: Times and values.
        sensor: What read it.
    """

    reading: Reading
    sensor: Sensor


@dataclass(frozen=True)
class Notes:
    """What is written beside the readings.

    Args:
        title: One line.
        source: Who measured it, or how it was made.
        overrides: Keys of the scenario that this recording replaces.
    """

    title: str
    source: str = ""
    overrides: Mapping[str, Any] = field(default_factory=dict)


def write_recording(folder: Path, channels: Mapping[str, Recorded], notes: Notes) -> None:
    """Write a recording that `load_recording` reads; channels that were read at the same instants share a table.

    Args:
        folder: New or empty of recordings.
        channels: Name to what was read.
        notes: Title, source, overrides.

    Raises:
        InputError: The folder already holds a recording, or cannot be written.
    """
    file = folder / "recording.yaml"
    if file.exists():
        raise InputError(folder, "", "this folder already holds a recording", "give another folder with `--out`")
    tables = _tables(channels)
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        for table, columns in tables.items():
            write_atomically(folder / table, pd.DataFrame(columns).to_csv(index=False).encode())
        text = yaml.safe_dump(_sidecar(channels, tables, notes), sort_keys=False, allow_unicode=True, width=110)
        write_atomically(file, text.encode())


def _tables(channels: Mapping[str, Recorded]) -> dict[str, dict[str, np.ndarray[Any, Any]]]:
    """Table to its columns; a column is named after its channel."""
    tables: dict[str, dict[str, np.ndarray[Any, Any]]] = {}
    for name, recorded in channels.items():
        times = recorded.reading.times
        for columns in tables.values():
            if np.array_equal(columns["time"], times):
                columns[name] = recorded.reading.values
                break
        else:
            table = "data.csv" if not tables else f"data_{len(tables) + 1}.csv"
            tables[table] = {"time": times, name: recorded.reading.values}
    return tables


def _sidecar(channels: Mapping[str, Recorded], tables: Mapping[str, Mapping[str, Any]], notes: Notes) -> dict[str, Any]:
    main = next(iter(tables))
    table_of = {name: table for table, columns in tables.items() for name in columns if name != "time"}
    sidecar: dict[str, Any] = {"title": notes.title}
    if notes.source:
        sidecar["source"] = notes.source
    sidecar |= {"table": main, "time": {"column": "time", "unit": "s", "zero": 0.0}}
    if notes.overrides:
        sidecar["overrides"] = dict(notes.overrides)
    sidecar["channels"] = {n: _entry(n, r, table_of[n], main) for n, r in channels.items()}
    return sidecar


def _entry(name: str, recorded: Recorded, table: str, main: str) -> dict[str, Any]:
    sensor = recorded.sensor
    entry: dict[str, Any] = {"column": name, "unit": recorded.reading.unit}
    if sensor.is_noise_stated and sensor.noise is not None and sensor.noise.number > 0:
        entry["noise"] = str(sensor.noise)
    for key in ("quantum", "minimum", "maximum", "bias_bound"):
        value = getattr(sensor, key)
        if value is not None:
            entry[key] = str(value)
    if sensor.lag_bound.number:
        entry["lag_bound"] = str(sensor.lag_bound)
    if table != main:
        entry["table"] = table
    if sensor.offset_bound.number:
        entry["time"] = {"column": "time", "unit": "s", "zero": 0.0, "offset_bound": str(sensor.offset_bound)}
    return entry
