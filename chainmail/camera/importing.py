"""A table of another tracker as what a video says."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from chainmail.camera.curvature import largest_curvature
from chainmail.camera.import_file import ImportFile
from chainmail.camera.imports import Table
from chainmail.camera.links import Links
from chainmail.camera.measure import Measured
from chainmail.camera.plane import Plane
from chainmail.camera.sight import Sight, camera_of
from chainmail.camera.tracks import GAP, SEEN, Tracks
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array

_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
#: Weights of the third difference, and the root of the sum of their squares.
_THIRD, _SIZE = np.array([-1.0, 3.0, -3.0, 1.0]), float(np.sqrt(20.0))
#: Lengths of links between which a fabric may be [m]: a factor of 10 and more from the paper's.
_SHORTEST, _LONGEST = 2e-3, 0.5
#: Noise of a coordinate that never changes [m]: no tracker reads better.
_LEAST = 1e-6


def imported(table: Table, given: ImportFile, file: Path) -> Measured:
    """Places, deviations and gaps of the markers of a table.

    Args:
        table: As read.
        given: What its columns are.
        file: Of `given`, for errors and for what lies beside it.

    Raises:
        InputError: A marker or axis is not in the table, there are no times, they do not rise, or a marker has too
            few readings for its noise.
    """
    if table.unit not in ("", given.unit):
        raise InputError(
            file, "unit", f"it is `{given.unit}`, and the table says that its lengths are in {table.unit}", "correct it"
        )
    times = _times(table, given, file)
    sight = Sight(None, Plane(np.eye(3))) if given.plane is None else camera_of(given.lens, given.plane, file)
    places = np.stack([_places(table, name, given, sight, file) for name in given.markers], axis=1)
    for number, name in enumerate(given.markers):
        if name in table.likelihood:
            places[~(table.likelihood[name] >= given.least_likelihood), number] = np.nan
    known = np.asarray(np.isfinite(places).all(axis=2))
    places[~known] = np.nan
    covariance = np.full((*known.shape, 2, 2), np.nan)
    for number, name in enumerate(given.markers):
        noise = given.noise.to("m") if given.noise else _noise(places[:, number], name, file)
        covariance[known[:, number], number] = noise**2 * np.eye(2)
    tracks = Tracks(
        times,
        places,
        covariance,
        np.asarray(known, dtype=np.float64),
        np.where(known, SEEN, GAP),
        np.full(len(times), np.nan),
    )
    notes = (*table.notes, *sight.notes, *_pixels_as_lengths(table, given))
    spots = tuple(int(n) for n in known.sum(axis=1))
    if not given.fabric:
        return Measured(tracks, None, None, sight, notes, spots)
    notes = (*notes, _link_lengths(places, file))
    links = Links(tracks, np.zeros((*known[:, 0::2].shape, 2, 2)))
    return Measured(tracks, links, largest_curvature(links.centres, links.centre_covariance), sight, notes, spots)


def _pixels_as_lengths(table: Table, given: ImportFile) -> tuple[str, ...]:
    if table.kind != "deeplabcut" or given.unit == "px":
        return ()
    return (f"unit: DeepLabCut writes pixels; these are taken to be in {given.unit}, as the import file says",)


def _link_lengths(places: Array, file: Path) -> str:
    """Distances of the two markers of each row.

    Raises:
        InputError: They are of no link that anybody weaves.
    """
    far = np.linalg.norm(places[:, 1::2] - places[:, 0::2], axis=2)
    low, middle, high = 1e3 * np.nanquantile(far, [0.0, 0.5, 1.0])
    if not _SHORTEST < 1e-3 * middle < _LONGEST:
        raise InputError(
            file,
            "unit",
            f"the two markers of a row would be {middle:.4g} mm apart (median)",
            "correct `unit`, or the order of `markers`: back and front of row 1, then of row 2",
        )
    return f"distance of the two markers of a row: {low:.4g} to {high:.4g} mm, {middle:.4g} mm in the median"


def _times(table: Table, given: ImportFile, file: Path) -> Array:
    count = len(next(iter(next(iter(table.places.values())).values())))
    if given.clock.rate is not None:
        times = np.arange(count) / given.clock.rate.to("Hz")
    elif table.times is not None:
        times = table.times
    else:
        raise InputError(file, "clock.rate", "the table has no times, only frames", "give the frames per second")
    late = np.flatnonzero(~(np.diff(times) > 0.0))
    if late.size:
        row = int(late[0])
        raise InputError(
            file,
            "clock",
            f"times do not rise: {times[row]:.9g} s, then {times[row + 1]:.9g} s",
            "sort the table, or give `rate`",
        )
    return np.asarray(times + given.clock.offset.to("s"))


def _places(table: Table, name: str, given: ImportFile, sight: Sight, file: Path) -> Array:
    """(y, z) of a marker [m], shape (rows, 2)."""
    if name not in table.places:
        there = ", ".join(list(table.places)[:12])
        raise InputError(file, "markers", f"the table has no point `{name}`", f"it has: {there}")
    own = table.places[name]
    wanted = ("x", "y") if given.unit == "px" else (given.y, given.z)
    columns = []
    for axis in wanted:
        if axis[-1] not in own:
            raise InputError(file, axis, f"`{name}` has no coordinate {axis[-1]}", f"it has: {', '.join(sorted(own))}")
        columns.append(-own[axis[-1]] if axis[0] == "-" else own[axis[-1]])
    stacked = np.stack(columns, axis=1)
    return sight.places(stacked) if given.unit == "px" else _METRES[given.unit] * stacked


def _noise(places: Array, name: str, file: Path) -> float:
    """Deviation of a coordinate [m] from third differences, which hold noise and little motion."""
    difference = sum(w * places[k : len(places) - 3 + k] for k, w in enumerate(_THIRD))
    known = np.abs(np.asarray(difference))
    known = known[np.isfinite(known)]
    if known.size < 8:
        raise InputError(
            file,
            "noise",
            f"`{name}` has too few readings in a row to tell its noise",
            "give `noise`, or leave the marker out",
        )
    return max(float(np.median(known)) / 0.6745 / _SIZE, _LEAST)
