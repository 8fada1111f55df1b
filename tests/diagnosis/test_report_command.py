"""`cosim diagnose` refuses what it cannot use: one error with file, key and remedy, and nothing is written."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim.cli import app
from cosim.unit.errors import InputError

RIG = Path(__file__).resolve().parents[2] / "docs" / "examples" / "rig"


def in_text(file: str, old: str, new: str) -> Callable[[Path], None]:
    def change(monday: Path) -> None:
        text = (monday / file).read_text()
        assert old in text
        (monday / file).write_text(text.replace(old, new))

    return change


def rows(change: Callable[[list[str]], list[str]]) -> Callable[[Path], None]:
    def changed(monday: Path) -> None:
        lines = (monday / "measured.csv").read_text().splitlines()
        (monday / "measured.csv").write_text("".join(f"{line}\n" for line in change(lines)))

    return changed


def without_first_column_of_values(lines: list[str]) -> list[str]:
    parts = [line.split(",") for line in lines]
    return [lines[0], *(",".join([p[0], "nan", *p[2:]]) for p in parts[1:])]


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        (
            in_text("recording.yaml", "T1_degC, unit: degC", "T1_degC, unit: ohm"),
            "channels.coil[1,1].temperature.unit",
            "ohm cannot be converted to K",
        ),
        (in_text("recording.yaml", "T1_degC", "T9_degC"), "channels.coil[1,1].temperature.column", "no column"),
        (in_text("recording.yaml", "coil[1,1]", "coil[5,7]"), "channels.coil[5,7].temperature", "there is no coil 7"),
        (in_text("recording.yaml", "    room:", "    hall:"), "components.hall", "the key `kind` is missing"),
        (rows(without_first_column_of_values), "channels.coil[1,1].temperature", "it has 0 values"),
        (rows(lambda r: [*r[:40], r[50], *r[40:]]), "channels.coil[1,1].temperature", "its times do not rise"),
        (rows(lambda r: r[:5]), "channels.coil[1,1].temperature", "it has 4 values"),
        (rows(lambda r: []), "", "cannot be read as a table"),
    ],
)
def test_a_recording_that_does_not_fit_is_refused(
    change: Callable[[Path], None], key: str, problem: str, tmp_path: Path
) -> None:
    monday = Path(shutil.copytree(RIG / "monday", tmp_path / "monday"))
    change(monday)
    error = refused("--recording", str(monday), "--held-out", str(RIG / "tuesday"), "--out", str(tmp_path / "out"))
    assert error.key.startswith(key)
    assert problem in error.problem
    assert error.remedy
    assert not (tmp_path / "out").exists()


def test_a_folder_that_holds_a_diagnosis_or_is_a_file_keeps_what_it_has(tmp_path: Path) -> None:
    for name, problem in (("diagnosis.json", "already holds a diagnosis"), ("", "a file, not a folder")):
        folder = tmp_path / (name or "file")
        if name:
            folder.mkdir()
        kept = folder / name if name else folder
        kept.write_text("mine")
        error = refused("--recording", str(RIG / "monday"), "--held-out", str(RIG / "tuesday"), "--out", str(folder))
        assert problem in error.problem
        assert kept.read_text() == "mine"


def test_a_recording_cannot_judge_itself(tmp_path: Path) -> None:
    monday = str(RIG / "monday")
    error = refused("--recording", monday, "--held-out", monday, "--out", str(tmp_path / "out"))
    assert "fitted and held out at once" in error.problem


def refused(*arguments: str) -> InputError:
    result = CliRunner().invoke(app, ["diagnose", str(RIG / "scenario.yaml"), *arguments])
    assert isinstance(result.exception, InputError), result.output
    return result.exception
