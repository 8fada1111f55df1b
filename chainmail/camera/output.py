"""Tracks as a recording folder: one table, and a recording.yaml that says what its columns are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]
import yaml

from chainmail.camera.import_file import ImportFile
from chainmail.camera.measure import Measured
from chainmail.camera.rig import Rig
from chainmail.camera.tracks import STATES
from cosim.run_folder import write_atomically, writing
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array

#: A channel of a recording needs so many readings.
FEWEST_READINGS = 8
#: Digits of a reading in the table [mm]: a hundredth of a micrometre.
_DIGITS = 5


def refuse_recording(folder: Path) -> None:
    """Raise InputError where a folder already holds a recording: nothing is overwritten."""
    for name in ("recording.yaml", "data.csv", "track.html"):
        if (folder / name).exists():
            raise InputError(folder / name, "", "this file exists already", "give another folder with `--out`")


def write_tracks(folder: Path, measured: Measured, rig: Rig | ImportFile, source: str) -> list[str]:
    """Write data.csv and recording.yaml.

    Channels are the places of the markers and, of a fabric, the largest curvature, each with a deviation for every
    reading. Row centres, angles and lengths of links follow from the markers: they are columns without being channels,
    so that nothing is counted twice.

    Args:
        folder: New, or without a recording.
        measured: From a video.
        rig: The rig, or what an imported table is.
        source: What was done, for the recording.

    Returns:
        Names of the channels.

    Raises:
        InputError: No channel has enough readings, or the folder cannot be written.
    """
    refuse_recording(folder)
    table, channels = _markers(measured)
    if measured.links is not None and measured.curvature is not None:
        table |= _of_fabric(measured)
        if np.isfinite(measured.curvature.values).sum() >= FEWEST_READINGS:
            channels["fabric.max_curvature"] = _channel("fabric.max_curvature", "1/m")
    if not channels:
        raise InputError(
            source,
            "",
            f"no marker has {FEWEST_READINGS} readings that are known as well as `largest_noise` asks",
            "look at the rig file, or film longer",
        )
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        write_atomically(folder / "data.csv", pd.DataFrame(table).to_csv(index=False).encode())
        text = yaml.safe_dump(_sidecar(rig, source, channels), sort_keys=False, allow_unicode=True, width=110)
        write_atomically(folder / "recording.yaml", text.encode())
    return list(channels)


def _sidecar(rig: Rig | ImportFile, source: str, channels: dict[str, Any]) -> dict[str, Any]:
    said = source + (f"; {rig.source}" if rig.source else "")
    time: dict[str, Any] = {"column": "time", "unit": "s", "zero": 0.0}
    if rig.clock.offset_bound.number:
        time["offset_bound"] = str(rig.clock.offset_bound)
    found = {"title": rig.title, "source": said, "table": "data.csv", "time": time}
    if rig.overrides:
        found["overrides"] = rig.overrides
    return {**found, "channels": channels}


def _channel(column: str, unit: str) -> dict[str, Any]:
    return {"column": column, "unit": unit, "noise_column": f"noise of {column}"}


def _markers(measured: Measured) -> tuple[dict[str, Any], dict[str, Any]]:
    tracks = measured.tracks
    table: dict[str, Any] = {"time": np.round(tracks.times, 9)}
    channels: dict[str, Any] = {}
    deviation = tracks.deviation
    for marker in range(tracks.markers):
        for axis, letter in enumerate("yz"):
            name = f"marker[{marker + 1}].{letter}"
            table[name] = _mm(tracks.places[:, marker, axis])
            table[f"noise of {name}"] = _mm(deviation[:, marker, axis])
            if np.isfinite(tracks.places[:, marker, axis]).sum() >= FEWEST_READINGS:
                channels[name] = _channel(name, "mm")
        table[f"marker[{marker + 1}] is"] = [STATES[s] for s in tracks.state[:, marker]]
        table[f"share of marker[{marker + 1}]"] = np.round(tracks.share[:, marker], 4)
    table["margin"] = np.round(tracks.margin, 2)
    return table, channels


def _of_fabric(measured: Measured) -> dict[str, Any]:
    links, curvature = measured.links, measured.curvature
    if links is None or curvature is None:
        return {}
    table: dict[str, Any] = {}
    step = links.tracks.places[:, 1::2] - links.tracks.places[:, 0::2]
    for row in range(links.centres.shape[1]):
        table[f"row[{row + 1}].y"] = _mm(links.centres[:, row, 0])
        table[f"row[{row + 1}].z"] = _mm(links.centres[:, row, 1])
        table[f"angle of row[{row + 1}]"] = np.round(np.degrees(links.angles[:, row]), 5)
        table[f"length of row[{row + 1}]"] = _mm(np.hypot(step[:, row, 0], step[:, row, 1]))
    table["fabric.max_curvature"] = np.round(curvature.values, 6)
    table["noise of fabric.max_curvature"] = np.round(curvature.deviation, 6)
    table["most curved row"] = curvature.row
    return table


def _mm(values: Array) -> Array:
    return np.round(1e3 * values, _DIGITS)
