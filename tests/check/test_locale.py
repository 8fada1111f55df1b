"""Dates and decimals as German loggers and spreadsheets write them: read, or refused with a remedy that works."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diagnosis.recording.recording import load_recording

COUNT = 40


def table(path: Path, header: str, row: str, separator: str = ";", is_comma: bool = True) -> Path:
    """Two temperatures every 2 s; `{n}` and `{s}` of the row are a number and seconds as 00:00."""
    lines = [header]
    for n in range(COUNT):
        clock = f"{2 * n // 60:02d}:{2 * n % 60:02d}"
        values = [f"{20.5 + 0.25 * n:.2f}", f"{21.0 + 0.5 * n:.2f}"]
        if is_comma:
            values = [v.replace(".", ",") for v in values]
        lines.append(separator.join([row.replace("{s}", clock).replace("{n}", str(2 * n)), *values]))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("row", "header"),
    [
        ("24.11.2026 10:{s}", "Zeit;T1 [°C];T2 [°C]"),
        ("24.11.2026 10:{s},000", "Zeitstempel;T1 [°C];T2 [°C]"),
        ("2026/11/24 10:{s}", "timestamp;T1_degC;T2_degC"),
        ("2026-11-24 10:{s}", "timestamp;T1_degC;T2_degC"),
        ("10:{s}", "time;T1_degC;T2_degC"),
        ("24.11.2026;10:{s}", "Datum;Zeit;T1_degC;T2_degC"),
    ],
)
def test_dates_with_decimal_commas_are_read(command, tmp_path, row, header):
    raw = table(tmp_path / "raw.csv", header, row)
    code, _, said = command("recording", "new", raw, "--scenario", "tclab", "--out", tmp_path / "out")
    assert code == 0, said
    channel = load_recording(tmp_path / "out").channels["coil[2].temperature"]
    np.testing.assert_allclose(channel.times, 2.0 * np.arange(COUNT))
    np.testing.assert_allclose(channel.values, 21.0 + 0.5 * np.arange(COUNT) + 273.15)


@pytest.mark.parametrize(
    ("row", "header", "remedy"),
    [
        ("11/24/2026 10:{s}", "time;T1_degC;T2_degC", "write dates as `2026-11-24 10:00:00`"),
        ("24.11.26 10:{s}", "time;T1_degC;T2_degC", "write dates as `2026-11-24 10:00:00`"),
        ("{s}", "time;T1_degC;T2_degC", "write date and time into one column"),
        ("{n};1.234,5", "time_s;x;T1_degC;T2_degC", "write numbers without a mark between thousands"),
    ],
)
def test_what_cannot_be_read_for_sure_is_refused_with_what_to_write(command, tmp_path, row, header, remedy):
    raw = table(tmp_path / "raw.csv", header, row)
    code, _, said = command("recording", "new", raw, "--scenario", "tclab", "--out", tmp_path / "out")
    assert code == 2
    assert said.startswith(f"error: {raw}: ")
    assert f"remedy: {remedy}" in said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("row", "separator", "is_comma", "what"),
    [
        ("24.11.2026 10:{s}", ",", False, "`24.11.2026 10:00:00` in row 1 of column `time_s` is no number"),
        ("24.11.2026 10:{s}", ";", True, "`24.11.2026 10:00:00` in row 1 of column `time_s` is no number"),
        ("24.11.2026 10:{s}", "\t", False, "`24.11.2026 10:00:00` in row 1 of column `time_s` is no number"),
    ],
)
def test_the_remedy_for_a_raw_table_in_a_recording_works(command, tmp_path, row, separator, is_comma, what):
    """`leave the place empty where nothing was measured` helped nobody."""
    folder = tmp_path / "mine"
    folder.mkdir()
    raw = table(folder / "data.csv", separator.join(["time_s", "T1_degC", "T2_degC"]), row, separator, is_comma)
    (folder / "recording.yaml").write_text(
        "title: t\ntable: data.csv\ntime: {column: time_s, unit: s}\n"
        "channels: {'coil[1].temperature': {column: T1_degC, unit: degC}}\n"
    )
    code, _, said = command("recording", "check", folder, "--scenario", "tclab")
    assert code == 2
    assert f"error: {raw}: " in said
    assert what in said
    assert "remedy: `cosim recording new TABLE --scenario SCENARIO --out FOLDER`" in said
    code, _, said = command("recording", "new", raw, "--scenario", "tclab", "--out", tmp_path / "new")
    assert code == 0, said
    assert len(load_recording(tmp_path / "new").channels["coil[1].temperature"].times) == COUNT
