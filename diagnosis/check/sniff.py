"""Tables as loggers and spreadsheets write them: separators, decimal commas, lines before the header."""

from __future__ import annotations

import csv
import itertools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.yaml_file import refuse_pipe
from diagnosis.check.heading import known_unit
from diagnosis.recording.cells import COMMA, POINT, has_thousands, how_to_write, instant, time_of_day, uses_comma

#: Lines before the header that are looked through.
_MOST_HEADER = 60
#: Seconds of a day, and by how many a time of day must fall to be one of the next day.
_DAY, _MIDNIGHT = 86400.0, 43200.0
_TIMES = ("date", "time of day")
#: What loggers write where nothing was measured.
_NOTHING = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--", "inf", "-inf", "#n/a", "#div/0!"})


@dataclass(frozen=True)
class Sniffed:
    """A table with plain numbers.

    Args:
        names: Of the columns, as they stand in the header, without spaces around them.
        columns: Values, not a number where there is none; shape (columns, rows).
        header_lines: Lines of the file before its header.
        separator: Between columns.
        is_decimal_comma: Whether numbers are written 1,5.
        instants: Columns that held dates or times of day; their values are seconds since the first.
        texts: Columns that hold text and no numbers, with an example.
    """

    names: tuple[str, ...]
    columns: Array
    header_lines: int
    separator: str
    is_decimal_comma: bool
    instants: tuple[str, ...]
    texts: dict[str, str]


@dataclass(frozen=True)
class _Column:
    """One column.

    Args:
        values: Numbers, seconds since 1970 of dates, seconds since midnight of times of day; shape (rows,).
        kind: What it holds: number, date, time of day or text; empty: nothing.
        example: Of text.
    """

    values: Array
    kind: str
    example: str


def read_table(path: Path) -> Sniffed:
    """Read a CSV file of unknown make.

    Raises:
        InputError: It cannot be read, holds no table, or a column holds numbers and text.
    """
    lines = _lines(path)
    for separator in (";", "\t", ",", None):
        found = _parsed(path, lines, separator)
        if found is not None:
            return found
    raise InputError(
        path,
        "",
        "no table with a header row and numbers is found in it",
        "give a CSV file with one line of column names above the numbers",
    )


def _lines(path: Path) -> list[str]:
    refuse_pipe(path, "give a CSV file")
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise InputError(path, "", f"it cannot be read: {error.strerror}", "give a CSV file") from error
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        encodings = ["utf-16"]
    elif b"\x00" in raw[:4096]:
        raise InputError(path, "", "this is no text", "export the sheet as CSV")
    else:
        encodings = ["utf-8-sig", "latin-1"]  # the mark at the begin is left out; degree signs of old loggers
    for encoding in encodings:
        try:
            text = raw.decode(encoding)
        except UnicodeDecodeError:
            continue
        lines = text.splitlines()
        while lines and not lines[-1].strip():
            lines.pop()
        return lines
    raise InputError(path, "", "its text cannot be decoded", "save it as UTF-8")


def _split(line: str, separator: str | None) -> list[str]:
    if separator is None:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]


def _parsed(path: Path, lines: list[str], separator: str | None) -> Sniffed | None:
    """The table, if this is its separator: three rows of numbers or dates in a row, names above them."""
    before: list[str] = []
    for number in range(min(len(lines) - 3, _MOST_HEADER)):
        cells = _names(lines[number], separator)
        names = _with_units(before, cells) if _are_units(cells, before) else cells
        # Some loggers leave a line empty between the header and the numbers.
        rows = [line for line in lines[number + 1 : number + 6] if line.strip()][:3]
        if _is_header(names, [_split(line, separator) for line in rows]):
            return _table(path, lines, number, names, separator)
        before = cells if len(cells) > 1 and all(cells) else before if not any(cells) else []
    return None


def _names(line: str, separator: str | None) -> list[str]:
    """Cells of a header; a separator at its end begins no column."""
    names = _split(line, separator)
    while names and not names[-1]:
        names.pop()
    return names


def _is_header(names: list[str], following: list[list[str]]) -> bool:
    """Whether these are names, and numbers or dates stand in their columns, three rows of them."""
    if len(names) < 2 or len(following) < 3 or not all(names) or any(_is_value(n) for n in names):
        return False
    if any(len(row) < len(names) or any(row[len(names) :]) for row in following):
        return False
    return all(sum(_is_value(cell) for cell in row) >= 2 for row in following)


def _with_units(names: list[str], units: list[str]) -> list[str]:
    """Names with the units of the line below them; what has none there stays as it is."""
    both = itertools.zip_longest(names, map(_bare, units), fillvalue="")
    return [f"{name} [{unit}]" if unit else name for name, unit in both]


def _are_units(cells: list[str], before: list[str]) -> bool:
    """Whether a line holds the units of the names before it: known ones, in brackets or not, or nothing."""
    if len(cells) < 2 or len(cells) > len(before) or any(map(_is_value, before)):
        return False
    return all(known_unit(_bare(cell))[0] is not None or cell != _bare(cell) for cell in cells if cell)


def _bare(cell: str) -> str:
    """A unit without the brackets around it."""
    return cell[1:-1].strip() if len(cell) > 1 and cell[0] + cell[-1] in ("()", "[]") else cell


def _is_value(cell: str) -> bool:
    is_time = instant(cell) is not None or time_of_day(cell) is not None
    return is_time or bool(POINT.match(cell) or COMMA.match(cell))


def _table(path: Path, lines: list[str], header: int, heads: list[str], separator: str | None) -> Sniffed:
    names = tuple(heads)
    doubled = sorted({n for n in names if names.count(n) > 1})
    if doubled:
        raise InputError(path, doubled[0], "two columns have this name", "rename one of them")
    rows = [_split(line, separator) for line in lines[header + 1 :] if line.strip()]
    for n, cells in enumerate(rows):
        if len(cells) > len(names) and not any(cells[len(names) :]):
            rows[n] = cells[: len(names)]  # a separator at the end of each line
        elif len(cells) != len(names):
            raise InputError(
                path,
                f"row {n + 1}",
                f"it has {len(cells)} values, the header {len(names)}",
                "correct the row; with decimal commas save the table with `;` between columns",
            )
    is_comma = _uses_comma(path, rows, separator)
    every = [_column(path, name, [row[k] for row in rows], is_comma) for k, name in enumerate(names)]
    columns = _from_first(every, len(rows))
    texts = {name: one.example for name, one in zip(names, every) if one.kind == "text"}
    instants = tuple(name for name, one in zip(names, every) if one.kind in _TIMES)
    return Sniffed(names, columns, header, separator or " ", is_comma, instants, texts)


def _from_first(every: Sequence[_Column], rows: int) -> Array:
    """Values of all columns, dates and times of day as seconds since their first; shape (columns, rows).

    A time of day beside a column of dates without one is of that date; alone it counts on over midnight.
    """
    found = np.array([one.values for one in every]).reshape(len(every), rows)
    days = [one.values for one in every if one.kind == "date" and not np.any(one.values % _DAY)]
    for k, one in enumerate(every):
        if one.kind == "time of day":
            found[k] = days[0] + one.values if days else _over_midnight(one.values)
        if one.kind in _TIMES:
            known = found[k][np.isfinite(found[k])]
            found[k] -= known[0] if len(known) else 0.0
    return found


def _uses_comma(path: Path, rows: list[list[str]], separator: str | None) -> bool:
    """Whether numbers have a decimal comma; both signs in one file are refused."""
    if separator == ",":
        cells = [c for row in rows for c in row if "," in c]
        return bool(cells) and all(COMMA.match(c) for c in cells)
    return uses_comma(path, (cell for row in rows for cell in row))


def _column(path: Path, name: str, cells: list[str], is_comma: bool) -> _Column:
    """Values of a column, or an example where it holds text instead."""
    found = np.full(len(cells), np.nan)
    pattern = COMMA if is_comma else POINT
    bad: tuple[int, str] | None = None
    kinds = set()
    for n, cell in enumerate(cells):
        if cell.lower() in _NOTHING:
            continue
        value, kind = _value(cell, pattern)
        if kind:
            found[n] = value
            kinds.add(kind)
        elif bad is None:
            bad = n, cell
    if bad is not None and (kinds or has_thousands(bad[1])):
        what = f"`{bad[1]}` in row {bad[0] + 1} of this column is no number"
        raise InputError(path, name, what, how_to_write(bad[1]))
    if len(kinds) > 1:
        what = f"this column holds a {' and a '.join(sorted(kinds))}"
        raise InputError(path, name, what, "write all its times in one way")
    return _Column(found, "text" if bad is not None else "".join(kinds), "" if bad is None else bad[1])


def _value(cell: str, pattern: re.Pattern[str]) -> tuple[float, str]:
    """Number of a cell and what it is; NaN and nothing where it is none."""
    if pattern.match(cell):
        return float(cell.replace(",", ".")), "number"
    moment, clock = instant(cell), time_of_day(cell)
    if moment is not None:
        return moment, "date"
    return (math.nan, "") if clock is None else (clock, "time of day")


def _over_midnight(seconds: Array) -> Array:
    """Times of day as they rise over the ends of days, shape (rows,); what is empty stays so."""
    known = np.flatnonzero(np.isfinite(seconds))
    falls = np.diff(seconds[known], prepend=seconds[known[0]]) < -_MIDNIGHT
    found = seconds.copy()
    found[known] += _DAY * np.cumsum(falls)
    return found
