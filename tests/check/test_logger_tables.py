"""Tables as common loggers write them: separators at the end of lines, a line of units, times of day."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.unit.errors import InputError
from diagnosis.check.sniff import read_table
from diagnosis.recording.cells import time_of_day

ROWS = [(2.0 * n, 21.0 + 0.1 * n, 5.0 - 0.2 * n) for n in range(12)]


def table(folder: Path, *head: str, row: str = "{:.1f},{:.2f},{:.2f}") -> Path:
    path = folder / "raw.csv"
    path.write_text("\n".join([*head, *(row.format(*values) for values in ROWS)]) + "\n", encoding="utf-8")
    return path


def test_a_separator_at_the_end_of_every_line_begins_no_column(tmp_path: Path) -> None:
    found = read_table(table(tmp_path, "time_s,T_degC,U_V,", row="{:.1f},{:.2f},{:.2f},"))
    assert found.names == ("time_s", "T_degC", "U_V")
    np.testing.assert_allclose(found.columns.T, ROWS, atol=1e-9)


def test_a_value_beyond_the_header_is_still_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="4 values, the header 3"):
        read_table(table(tmp_path, "time_s,T_degC,U_V", row="{:.1f},{:.2f},{:.2f},").parent / _longer(tmp_path))


def _longer(folder: Path) -> str:
    path = folder / "raw.csv"
    path.write_text(path.read_text() + "24.0,1.0,2.0,7.0\n")
    return path.name


@pytest.mark.parametrize(
    ("head", "names"),
    [
        (("Time,Probe 1,Probe 2", "(s),(degC),(V)"), ("Time [s]", "Probe 1 [degC]", "Probe 2 [V]")),
        (("Time,Probe 1,Probe 2", "[s],[°C],[V]", ""), ("Time [s]", "Probe 1 [°C]", "Probe 2 [V]")),
        (("time,T,U", "s,degC,V"), ("time [s]", "T [degC]", "U [V]")),
        (("Logger 7", "serial 12", "time,T,U", "ms,,mV"), ("time [ms]", "T", "U [mV]")),
        (("time,T,U", "", "s,degC,V", ""), ("time [s]", "T [degC]", "U [V]")),
        (("time,T,U", "s,degC,"), ("time [s]", "T [degC]", "U")),
    ],
    ids=["brackets", "empty line", "bare", "lines before, one without", "empty lines", "the last without"],
)
def test_a_line_of_units_below_the_names_belongs_to_them(
    tmp_path: Path, head: tuple[str, ...], names: tuple[str, ...]
) -> None:
    found = read_table(table(tmp_path, *head))
    assert found.names == names
    np.testing.assert_allclose(found.columns.T, ROWS, atol=1e-9)


@pytest.mark.parametrize("above", ["rig 3,left,new", "A,B,C"])
def test_a_line_above_names_that_are_no_units_is_no_header(tmp_path: Path, above: str) -> None:
    found = read_table(table(tmp_path, above, "time_s,bag,wall"))
    assert found.names == ("time_s", "bag", "wall")


def test_names_that_look_like_units_stay_names_where_nothing_is_above(tmp_path: Path) -> None:
    assert read_table(table(tmp_path, "t,T,V")).names == ("t", "T", "V")


@pytest.mark.parametrize(
    ("cell", "seconds"),
    [
        ("10:00:00", 36000.0),
        ("0:00:02.5", 2.5),
        ("26:10:05", 94205.0),
        ("12:00:01 AM", 1.0),
        ("12:00:01 pm", 43201.0),
        ("13:00:00 PM", None),
        ("10:00", None),
        ("10:00:60", None),
        ("10:0:00", None),
    ],
)
def test_times_of_day(cell: str, seconds: float | None) -> None:
    assert time_of_day(cell) == seconds


def _clocks(begin: int, step: int) -> list[str]:
    every = [(begin + step * n) % 86400 for n in range(12)]
    return [f"{s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}" for s in every]


def test_times_of_day_count_on_over_midnight(tmp_path: Path) -> None:
    path = tmp_path / "raw.csv"
    cells = _clocks(86390, 5)
    cells[4] = ""
    path.write_text("time,T\n" + "".join(f"{c},{n}\n" for n, c in enumerate(cells)))
    found = read_table(path)
    assert found.instants == ("time",)
    expected = np.where(np.arange(12) == 4, np.nan, 5.0 * np.arange(12))
    np.testing.assert_allclose(found.columns[0], expected)


def test_a_date_beside_a_time_of_day_is_another_column(tmp_path: Path) -> None:
    path = tmp_path / "raw.csv"
    path.write_text("Date;Time;T\n" + "".join(f"26.11.2026;{c};{n}\n" for n, c in enumerate(_clocks(3600, 2))))
    found = read_table(path)
    assert found.instants == ("Date", "Time")
    np.testing.assert_allclose(found.columns[1], 2.0 * np.arange(12))


def test_a_time_of_day_is_of_the_date_beside_it(tmp_path: Path) -> None:
    """Over a night in which nothing was logged for more than a day; hours before noon of the next morning."""
    path = tmp_path / "raw.csv"
    days = ["24.11.2026"] * 6 + ["26.11.2026"] * 6
    path.write_text("Date;Time;T\n" + "".join(f"{d};{c};1\n" for d, c in zip(days, _clocks(3600, 2))))
    times = read_table(path).columns[1]
    np.testing.assert_allclose(times, 2.0 * np.arange(12) + 172800.0 * (np.arange(12) > 5))


def test_one_way_to_write_times_in_a_column(tmp_path: Path) -> None:
    path = tmp_path / "raw.csv"
    cells = [*_clocks(0, 1)[:6], *(str(n) for n in range(6))]
    path.write_text("time,T\n" + "".join(f"{c},{n}\n" for n, c in enumerate(cells)))
    with pytest.raises(InputError, match="holds a number and a time of day"):
        read_table(path)
