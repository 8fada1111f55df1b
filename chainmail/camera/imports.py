"""Tables of other trackers: DeepLabCut, OptiTrack, and plain ones; their columns as tracks with names."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Literal

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.yaml_file import refuse_pipe

Kind = Literal["deeplabcut", "optitrack", "plain"]
#: Fields that stand for no value.
_EMPTY = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--"})
#: How Motive calls units of length.
_LENGTHS = {"millimeters": "mm", "centimeters": "cm", "meters": "m"}
#: Names of a column of times in a plain table.
_TIMES = re.compile(r"^(time|t|zeit|timestamp|datetime|date)\s*(\[(?P<unit>[^\]]*)\]|\((?P<other>[^)]*)\))?$", re.I)
#: `p1.x`, `p1_x`, `p1 x`, `p1-x`, `x_p1`, each with a unit behind it.
_AXIS = re.compile(r"^(?P<name>.+?)[\s._:-]+(?P<axis>[xyz])\s*([\[(].*[\])])?$", re.I)
_AXIS_FIRST = re.compile(r"^(?P<axis>[xyz])[\s._:-]*(?P<name>.+?)\s*([\[(].*[\])])?$", re.I)


@dataclass(frozen=True)
class Table:
    """Tracks of another tool.

    Args:
        kind: Which tool's table it is.
        times: [s], shape (rows,); None where it has frame numbers alone.
        places: Name of a point to its coordinates by axis, each of shape (rows,), in the unit of the file.
        likelihood: Name of a point to how sure the tool is, from 0 to 1; only DeepLabCut says that.
        notes: What was found, in sentences.
        unit: Of its lengths, as the file says; empty where it does not.
    """

    kind: Kind
    times: Array | None
    places: dict[str, dict[str, Array]]
    likelihood: dict[str, Array]
    notes: tuple[str, ...] = ()
    unit: str = ""


def read_tracks(file: Path) -> Table:
    """Read a table of tracks; which tool wrote it is told from its header.

    Raises:
        InputError: It cannot be read, holds no coordinates, or a field is no number.
    """
    rows = _rows(file)
    if len(rows) > 3 and rows[0][0].strip().lower() == "scorer":
        return _deeplabcut(file, rows)
    if rows and rows[0][0].strip().lower() == "format version":
        return _optitrack(file, rows)
    return _plain(file, rows)


def _rows(file: Path) -> list[list[str]]:
    refuse_pipe(file, "give a CSV file in UTF-8")
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError(file, "", f"it cannot be read: {why}", "give a CSV file in UTF-8") from error
    lines = [line for line in text.splitlines() if line.strip()]
    if len(lines) < 2:
        raise InputError(file, "", "it has fewer than two lines", "give a table with a header")
    head = lines[min(len(lines) - 1, 2)]
    separator = max((";", "\t", ","), key=lambda s: (head.count(s) > 0, s == ";" and head.count(s) > 0, head.count(s)))
    return [[field.strip() for field in row] for row in csv.reader(lines, delimiter=separator)]


def _deeplabcut(file: Path, rows: Sequence[Sequence[str]]) -> Table:
    """Three rows of header (scorer, bodyparts, coords), or four with individuals; then frame number and values."""
    names = [row[0].lower() for row in rows[:4]]
    count = 4 if "individuals" in names else 3
    try:
        parts, coords = rows[names.index("bodyparts")], rows[names.index("coords")]
    except ValueError as error:
        raise InputError(
            file,
            "",
            "a header of DeepLabCut has the rows scorer, bodyparts and coords",
            "give the CSV as DeepLabCut wrote it",
        ) from error
    who = rows[names.index("individuals")] if count == 4 else None
    values = _numbers(file, rows, count)
    places: dict[str, dict[str, Array]] = {}
    likelihood: dict[str, Array] = {}
    for column in range(1, len(parts)):
        name = parts[column] if who is None else f"{who[column]}.{parts[column]}"
        if coords[column] == "likelihood":
            likelihood[name] = values[:, column]
        else:
            places.setdefault(name, {})[coords[column].lower()] = values[:, column]
    return _found(file, Table("deeplabcut", None, places, likelihood, (f"DeepLabCut: {len(places)} points",)))


def _optitrack(file: Path, rows: Sequence[Sequence[str]]) -> Table:
    """Motive's export: a line of settings, then rows of types, names, ids and quantities above X, Y, Z."""
    settings = dict(zip(rows[0][0::2], rows[0][1::2]))
    at = next((i for i, row in enumerate(rows) if row[0].lower() == "frame"), None)
    if at is None or at < 2:
        raise InputError(
            file,
            "",
            "a table of OptiTrack has a row that begins with Frame, below the names",
            "export it from Motive as CSV with its header",
        ) from None
    head = rows[1:at]
    types = next((r for r in head if any(f in ("Marker", "Rigid Body Marker") for f in r)), None)
    names = next((r for r in head if "Name" in r[:2]), None)
    if names is None and types is not None and head.index(types) + 1 < len(head):
        names = head[head.index(types) + 1]  # up to version 1.21 the rows of the header are not labelled
    kinds = next((r for r in head if any(f == "Position" for f in r)), None)
    if names is None or kinds is None:
        raise InputError(
            file, "", "its header has no row of names, or none of positions", "export positions of markers"
        )
    values = _numbers(file, rows, at + 1)
    places: dict[str, dict[str, Array]] = {}
    for column in range(2, min(len(names), len(kinds), len(rows[at]))):
        is_marker = types is None or types[column] in ("Marker", "Rigid Body Marker")
        if kinds[column] == "Position" and is_marker and rows[at][column].lower() in "xyz":
            places.setdefault(names[column], {})[rows[at][column].lower()] = values[:, column]
    unit = settings.get("Length Units", "")
    notes = (f"OptiTrack: {len(places)} markers" + (f", length unit of the file: {unit}" if unit else ""),)
    found = _found(file, Table("optitrack", values[:, 1], places, {}, notes))
    return replace(found, unit=_LENGTHS.get(unit.strip().lower(), ""))


def _plain(file: Path, rows: Sequence[Sequence[str]]) -> Table:
    """One header row: a time, and columns that are named after a point and an axis."""
    header = rows[0]
    times: Array | None = None
    places: dict[str, dict[str, Array]] = {}
    clock = next((i for i, name in enumerate(header) if _TIMES.match(name)), None)
    values = _numbers(file, rows, 1, skip=clock)
    if clock is not None:
        times = _times(file, rows, clock)
    for column, name in enumerate(header):
        found = _AXIS.match(name) or _AXIS_FIRST.match(name)
        if found and column != clock:
            own = places.setdefault(found["name"], {})
            if found["axis"].lower() in own:
                raise InputError(file, name, "this column stands twice", "give each coordinate once")
            own[found["axis"].lower()] = values[:, column]
    return _found(file, Table("plain", times, places, {}, (f"plain table: {len(places)} points",)))


def _found(file: Path, table: Table) -> Table:
    wrong = [name for name, axes in table.places.items() if len(axes) < 2]
    if not table.places or len(wrong) == len(table.places):
        raise InputError(
            file,
            "",
            "no column is a coordinate of a point, such as `p1.x` and `p1.y`",
            "see docs/camera.md for the tables that are read",
        )
    places = {name: axes for name, axes in table.places.items() if name not in wrong}
    left = (f"left out, with one coordinate only: {', '.join(wrong)}",) if wrong else ()
    return Table(table.kind, table.times, places, table.likelihood, (*table.notes, *left))


def _numbers(file: Path, rows: Sequence[Sequence[str]], begin: int, skip: int | None = None) -> Array:
    """Values below the header, shape (rows, columns); what is empty is not a number."""
    wide = max(len(row) for row in rows[:begin])
    found = np.full((len(rows) - begin, wide), math.nan)
    for number, row in enumerate(rows[begin:]):
        if len(row) > wide:
            raise InputError(
                file,
                f"row {begin + number + 1}",
                f"it has {len(row)} fields, the header {wide}",
                "check the separator and the decimal sign",
            )
        for column, field in enumerate(row):
            if column != skip:
                found[number, column] = _number(file, field, begin + number + 1, column + 1)
    if not len(found):
        raise InputError(file, "", "there are no rows below its header", "give a table with values")
    return found


def _number(file: Path, field: str, row: int, column: int) -> float:
    if field.lower() in _EMPTY:
        return math.nan
    try:
        value = float(field.replace(",", "."))
    except ValueError as error:
        raise InputError(
            file,
            f"row {row}, column {column}",
            f"`{field}` is no number",
            "leave the place empty where nothing was tracked",
        ) from error
    if math.isinf(value):
        raise InputError(file, f"row {row}, column {column}", f"`{field}` is infinite", "leave the place empty")
    return value


def _times(file: Path, rows: Sequence[Sequence[str]], column: int) -> Array:
    """Seconds: as numbers in the unit of the header, or ISO 8601 as seconds since the first."""
    fields = [row[column] if column < len(row) else "" for row in rows[1:]]
    if "-" in fields[0][1:] and ":" in fields[0]:
        try:
            instants = [datetime.fromisoformat(field) for field in fields]
            return np.array([(i - instants[0]).total_seconds() for i in instants])
        except (ValueError, TypeError) as error:
            raise InputError(
                file,
                rows[0][column],
                f"a time cannot be read: {error}",
                "write times as 2026-05-01T12:00:00.040, all with a zone or none",
            ) from error
    named = _TIMES.match(rows[0][column])
    unit = ((named["unit"] or named["other"]) if named else None) or "s"
    factor = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0}.get(unit.strip().lower())
    if factor is None:
        raise InputError(
            file, rows[0][column], f"`{unit}` is no unit of time that is read here", "use s, ms, us or min"
        )
    return factor * np.array([_number(file, f, n + 2, column + 1) for n, f in enumerate(fields)])
