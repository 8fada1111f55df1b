"""Writes recordings: a sidecar with what was done and tables with what was read."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from evaluation.proving.rig import Array
from evaluation.proving.sensors import Readings, Sensors

#: Sensors of one kind with what they read.
SensorSet = tuple[Sensors, Readings]
#: All of them in one recording.
SensorSets = Sequence[SensorSet]


#: Changes what recording.yaml says; returns more tables, name to content.
Change = Callable[[dict[str, Any]], Mapping[str, str]]


def write_recording(
    folder: Path,
    title: str,
    overrides: Mapping[str, Any],
    sensor_sets: SensorSets,
    is_noise_told: bool,
    order: int,
    change: Change = lambda sidecar: {},
) -> None:
    """Writes one recording: recording.yaml and a CSV for each kind of sensor.

    Args:
        folder: Made if it is not there.
        title: One line.
        overrides: Keys of the scenario with what was done.
        sensor_sets: Sensors with their readings.
        is_noise_told: Whether the sidecar gives the noise.
        order: Place among the recordings of the case in time, from 1.
        change: What a sabotage makes of the sidecar.
    """
    folder.mkdir(parents=True, exist_ok=True)
    channels: dict[str, Any] = {}
    for sensors, readings in sensor_sets:
        table = f"{sensors.kind.quantity}.csv"
        columns = _write_table(folder / table, sensors, readings)
        channels |= {name: _entry(sensors, table, c, is_noise_told) for name, c in columns.items()}
    first = f"{sensor_sets[0][0].kind.quantity}.csv"
    sidecar = {
        "title": title,
        "table": first,
        "time": dict(_CLOCK),
        "order": order,
        "switch_margin": "0.3 s",
        "overrides": dict(overrides),
        "channels": channels,
    }
    for name, content in change(sidecar).items():
        (folder / name).write_text(content)
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False, width=120, default_flow_style=None))


_CLOCK = {"column": "time", "unit": "s", "zero": 0, "offset_bound": "0.2 s"}


def _entry(sensors: Sensors, table: str, column: str, is_noise_told: bool) -> dict[str, Any]:
    kind = sensors.kind
    unit = "K" if kind.unit == "degC" else kind.unit  # differences of temperature
    entry: dict[str, Any] = {"column": column, "unit": kind.unit, "table": table, "time": dict(_CLOCK)}
    if is_noise_told:
        entry["noise"] = f"{kind.factor * sensors.noise:.3g} {unit}"
    entry["quantum"] = f"{kind.factor * kind.quantum:.6g} {unit}"
    entry["lag_bound"] = "0.2 s"
    return entry


def _write_table(file: Path, sensors: Sensors, readings: Readings) -> dict[str, str]:
    kind = sensors.kind
    kept = sensors.kept or tuple(range(len(sensors.names)))
    columns = {sensors.names[c]: _column(sensors.names[c]) for c in kept}
    values = kind.factor * (readings.values[:, kept] - kind.zero)
    lines = [",".join(["time", *columns.values()])]
    lines += [_row(time, row) for time, row in zip(readings.stamps.tolist(), values)]
    file.write_text("\n".join(lines) + "\n")
    return columns


def _row(time: float, values: Array) -> str:
    cells = ["" if v != v else f"{v:.6g}" for v in values.tolist()]
    return ",".join([f"{time:.6g}", *cells])


def _column(name: str) -> str:
    """`coil[2,5].temperature` -> `temperature_2_5`."""
    place, _, quantity = name.partition(".")
    digits = "".join(c if c.isdigit() else " " for c in place).split()
    return "_".join([quantity, *digits])


def write_clean(file: Path, recordings: Mapping[str, SensorSets]) -> None:
    """Writes what the sensors would have read without noise, rounding and loss; for scoring alone.

    Args:
        file: An .npz file; arrays `<recording>/<kind>/stamps` and `<recording>/<kind>/clean`.
        recordings: Name to sensors and readings.
    """
    arrays: dict[str, Any] = {}
    for name, sensor_sets in recordings.items():
        for sensors, readings in sensor_sets:
            kept = list(sensors.kept or range(len(sensors.names)))
            arrays[f"{name}/{sensors.kind.quantity}/stamps"] = readings.stamps
            arrays[f"{name}/{sensors.kind.quantity}/clean"] = readings.clean[:, kept].astype(np.float32)
    np.savez_compressed(file, **arrays)
