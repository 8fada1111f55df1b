"""A channel that one recording states in another unit than the others, by a factor that is no odd size."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.check.unit_of_one import OF_ONE, units_near
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.systems.rigs import oscillator, oscillator_recordings


def doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return list(check_recordings(load_scenario(str(folder / "scenario.yaml")), [load_recording(r) for r in recordings]))


@pytest.fixture
def rig(tmp_path: Path) -> tuple[Path, list[Path], str]:
    """Folder, three null recordings, and the column of the displacement."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    return tmp_path, recordings, pd.read_csv(recordings[1] / "data.csv").columns[-1]


def scaled(recording: Path, column: str, factor: float) -> None:
    table = pd.read_csv(recording / "data.csv")
    table[column] *= factor
    table.to_csv(recording / "data.csv", index=False)


def test_feet_stated_as_metres_are_told_beside_the_other_recordings(rig: tuple[Path, list[Path], str]) -> None:
    folder, recordings, column = rig
    assert doubts(folder, recordings) == []
    scaled(recordings[1], column, 1.0 / 0.3048)
    (told,) = [d for d in doubts(folder, recordings) if d.is_serious]
    assert told.kind == "unit"
    assert told.recording == "run_2"
    assert "as if they were in ft and not in m" in told.statement


def test_a_rig_that_answers_more_in_all_recordings_and_a_gain_that_is_no_unit_raise_no_such_doubt(
    rig: tuple[Path, list[Path], str],
) -> None:
    folder, recordings, column = rig
    for recording in recordings:
        scaled(recording, column, 1.0 / 0.3048)  # in all of them: the scenario may be off by that
    assert not [d for d in doubts(folder, recordings) if d.kind == "unit"]
    for recording in recordings:
        scaled(recording, column, 0.3048)
    scaled(recordings[1], column, 1.5)
    assert not [d for d in doubts(folder, recordings) if d.kind == "unit"]
    scaled(recordings[1], column, 2.0)
    assert not [d for d in doubts(folder, recordings[:2]) if d.kind == "unit"]  # of two, either may be the wrong one


def test_nanometres_stated_as_metres_are_told(rig: tuple[Path, list[Path], str]) -> None:
    folder, recordings, column = rig
    scaled(recordings[2], column, 1e9)
    (told,) = [d for d in doubts(folder, recordings) if d.is_serious]
    assert "as if they were in nm and not in m" in told.statement


@pytest.mark.parametrize(
    ("unit", "stated", "base", "factor"),
    [
        ("mrad", "deg", "rad", 1000.0 * 3.14159265 / 180.0),
        ("ml/min", "m^3/s", "m^3/s", 6e7),
        ("kV", "V", "V", 1e-3),
        ("g/min", "kg/s", "kg/s", 6e4),
        ("mW/cm^2", "W/m^2", "W/m^2", 0.1),
        ("cm/s", "m/s", "m/s", 100.0),
    ],
)
def test_units_of_laboratories_are_known_by_their_factor(unit: str, stated: str, base: str, factor: float) -> None:
    assert unit in units_near(factor, stated, base, more=OF_ONE[base])
