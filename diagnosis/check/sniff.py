"""Tables as loggers and spreadsheets write them: separators, decimal commas, lines before the header."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.yaml_file import refuse_pipe
from diagnosis.recording.cells import COMMA, POINT, has_thousands, how_to_write, instant

#: Lines before the header that are looked through.
_MOST_HEADER = 60
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
        instants: Columns that held dates; their values are seconds since the first.
        texts: Columns that hold text and no numbers, with an example.
    """

    names: tuple[str, ...]
    columns: Array
    header_lines: int
    separator: str
    is_decimal_comma: bool
    instants: tuple[str, ...]
    texts: dict[str, str]


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
    for number in range(min(len(lines) - 3, _MOST_HEADER)):
        names = _split(lines[number], separator)
        following = [_split(line, separator) for line in lines[number + 1 : number + 4]]
        if len(names) < 2 or any(len(row) != len(names) for row in following):
            continue
        if not all(names) or any(_is_value(n) for n in names):
            continue
        if all(sum(_is_value(cell) for cell in row) >= 2 for row in following):
            return _table(path, lines, number, separator)
    return None


def _is_value(cell: str) -> bool:
    return bool(POINT.match(cell) or COMMA.match(cell)) or instant(cell) is not None


def _table(path: Path, lines: list[str], header: int, separator: str | None) -> Sniffed:
    names = tuple(_split(lines[header], separator))
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
    columns = np.full((len(names), len(rows)), np.nan)
    instants, texts = [], {}
    for k, name in enumerate(names):
        cells = [row[k] for row in rows]
        values, example = _column(path, name, cells, is_comma)
        columns[k] = values
        if example is not None:
            texts[name] = example
        elif any(instant(c) is not None for c in cells):
            instants.append(name)
    return Sniffed(names, columns, header, separator or " ", is_comma, tuple(instants), texts)


def _uses_comma(path: Path, rows: list[list[str]], separator: str | None) -> bool:
    """Whether numbers have a decimal comma; both signs in one file are refused."""
    if separator == ",":
        cells = [c for row in rows for c in row if "," in c]
        return bool(cells) and all(COMMA.match(c) for c in cells)
    comma = next((c for row in rows for c in row if "," in c and COMMA.match(c)), None)
    point = next((c for row in rows for c in row if "." in c and POINT.match(c)), None)
    if comma is not None and point is not None:
        raise InputError(
            path,
            "",
            f"it has decimal commas (`{comma}`) and decimal points (`{point}`)",
            "write all numbers with one of them",
        )
    return comma is not None


def _column(path: Path, name: str, cells: list[str], is_comma: bool) -> tuple[Array, str | None]:
    """Values of a column, and an example where it holds text instead."""
    found = np.full(len(cells), np.nan)
    known = [(n, c) for n, c in enumerate(cells) if c.lower() not in _NOTHING]
    pattern = COMMA if is_comma else POINT
    bad: tuple[int, str] | None = None
    good, kind = 0, set()
    for n, cell in known:
        if pattern.match(cell):
            found[n] = float(cell.replace(",", "."))
            kind.add("number")
            good += 1
            continue
        moment = instant(cell)
        if moment is not None:
            found[n] = moment
            kind.add("date")
            good += 1
        elif bad is None:
            bad = n, cell
    if bad is not None and good:
        raise InputError(
            path,
            name,
            f"`{bad[1]}` in row {bad[0] + 1} of this column is no number",
            how_to_write(bad[1]),
        )
    if len(kind) > 1:
        raise InputError(path, name, "this column holds dates and numbers", "write all its times in one way")
    if bad is not None:
        if has_thousands(bad[1]):
            raise InputError(
                path, name, f"`{bad[1]}` in row {bad[0] + 1} of this column is no number", how_to_write(bad[1])
            )
        return found, bad[1]
    if kind == {"date"}:
        found = found - found[np.isfinite(found)][0]
    return found, None
