"""Columns of numbers from CSV or Parquet files."""

from __future__ import annotations

import csv
import itertools
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.recording.cells import COMMA, NEW, how_to_write, uses_comma

#: What may stand between columns.
_MARKS = (",", ";", "\t")


class Table:
    """The columns of one file.

    Between columns of a CSV stand commas, semicolons or tabs, whichever give the most of the columns that are wanted.
    With semicolons or tabs numbers may have decimal commas; both signs in one table are refused.

    Args:
        file: CSV (with a header row) or Parquet file.
        header_lines: Lines of a CSV before its header row.
        wanted: Columns that may be asked for; only these are held in memory. None: all.

    Raises:
        InputError: It cannot be read or has no rows.
    """

    def __init__(self, file: Path, header_lines: int = 0, wanted: Collection[str] | None = None) -> None:
        self.file = file
        self._names: list[str] = []
        if not file.is_file():
            raise InputError(file, "", "there is no such table", "correct `table` in recording.yaml")
        try:
            self._frame = self._read(header_lines, wanted)
        except InputError:
            raise
        except UnicodeError as error:
            what = "it is not saved as UTF-8"
            raise InputError(
                file, "", what, f"save it as `CSV UTF-8`, or {NEW} reads it and writes a plain copy"
            ) from error
        except Exception as error:  # pandas and pyarrow raise many unrelated kinds
            raise InputError(
                file,
                "",
                f"it cannot be read as a table: {error}",
                "give a CSV file with one header row (see `header_lines`), or a Parquet file",
            ) from error
        if not len(self._frame):
            raise InputError(file, "", "the table has no rows", "give a table with values")

    def _read(self, header_lines: int, wanted: Collection[str] | None) -> pd.DataFrame:
        if self.file.suffix.lower() in (".parquet", ".pq"):
            from pyarrow.parquet import read_schema  # type: ignore[import-untyped, unused-ignore]

            self._names = [str(n) for n in read_schema(self.file).names]
            columns = self._names if wanted is None else [n for n in self._names if n in wanted] or self._names[:1]
            return pd.read_parquet(self.file, columns=columns)

        how: dict[str, Any] = {"skiprows": header_lines, "skipinitialspace": True, "comment": None}
        mark, self._names = self._columns(wanted, how)
        columns = self._names if wanted is None else [n for n in self._names if n in wanted] or self._names[:1]
        self._check_widths(header_lines, mark)
        self._check_names(header_lines, columns, mark)
        if mark == ",":
            return pd.read_csv(self.file, usecols=columns, **how)
        return self._with_points(pd.read_csv(self.file, usecols=columns, sep=mark, dtype=str, **how))

    def _columns(self, wanted: Collection[str] | None, how: dict[str, Any]) -> tuple[str, list[str]]:
        """What stands between columns, and their names."""
        every = {}
        for mark in _MARKS:
            every[mark] = [str(n) for n in pd.read_csv(self.file, nrows=0, sep=mark, **how).columns]
        best = max(_MARKS, key=lambda m: len(every[m] if wanted is None else set(every[m]) & set(wanted)))
        if wanted is not None and not set(every[best]) & set(wanted):
            best = max(_MARKS, key=lambda m: len(every[m]))  # none of them is there: the error says what is
        return best, every[best]

    def _with_points(self, texts: pd.DataFrame) -> pd.DataFrame:
        """Numbers with decimal points in place of commas.

        Raises:
            InputError: The table has both.
        """
        cells = [c for c in pd.unique(texts.to_numpy().ravel()) if isinstance(c, str)]
        if not uses_comma(self.file, cells):
            return texts
        commas = {c: c.replace(",", ".") for c in cells if COMMA.match(c)}
        return texts.apply(lambda column: column.map(lambda cell: commas.get(cell, cell)))

    def _check_names(self, header_lines: int, columns: Collection[str], mark: str) -> None:
        """Refuse a column that is asked for and stands twice; pandas takes the first and calls the second `T.1`.

        Raises:
            InputError: There are two of that name.
        """
        with self.file.open(encoding="utf-8-sig", newline="") as lines:
            rows = itertools.islice(lines, header_lines, None)
            names = next(csv.reader(rows, skipinitialspace=True, delimiter=mark), [])
        twice = next((name for name in columns if names.count(name) > 1), None)
        if twice is not None:
            what = f"the column `{twice}` is there {names.count(twice)} times"
            raise InputError(self.file, f"line {header_lines + 1}", what, "give every column a name of its own")

    def _check_widths(self, header_lines: int, mark: str) -> None:
        """Refuse rows with more values than there are columns: which are meant, nobody knows.

        pandas takes the first ones, so that `0,5,21,3` with decimal commas under `t,T` was read as 0 and 5.

        Raises:
            InputError: There is such a row.
        """
        width = len(self._names)
        with self.file.open(encoding="utf-8", newline="") as lines:
            for number, line in enumerate(lines):
                if number <= header_lines or line.count(mark) < width:
                    continue
                fields = next(csv.reader([line], delimiter=mark))
                if any(field.strip() for field in fields[width:]):
                    what = f"it has {len(fields)} values under {width} column names"
                    remedy = "correct the line; with decimal commas save the table with `;` between columns"
                    raise InputError(self.file, f"line {number + 1}", what, remedy)

    def column(self, name: str, key: str) -> Array:
        """Values of a column, shape (rows,); what is empty is not a number.

        Args:
            name: Column.
            key: Key of recording.yaml that names it, for errors.

        Raises:
            InputError: No such column, or it holds text.
        """
        if name not in self._frame.columns:
            there = ", ".join(self._names[:12]) + (" ..." if len(self._names) > 12 else "")
            raise InputError(self.file, key, f"there is no column `{name}`", f"there are: {there}")
        values = pd.to_numeric(self._frame[name], errors="coerce").to_numpy(dtype=np.float64)
        text = self._frame[name].notna().to_numpy() & np.isnan(values)
        if text.any():
            row = int(np.flatnonzero(text)[0])
            raise InputError(
                self.file,
                key,
                f"`{self._frame[name].iloc[row]}` in row {row + 1} of column `{name}` is no number",
                how_to_write(str(self._frame[name].iloc[row])),
            )
        return np.asarray(values, dtype=np.float64)
