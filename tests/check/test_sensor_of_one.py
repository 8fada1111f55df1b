"""One recording in which one sensor is not as in the others: nothing of the rig is said to be another there."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.beside import compare
from diagnosis.check.check import check_recordings
from diagnosis.check.sensor_of_one import sensor_of_one
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.check.test_other_course import COUNT, STEP
from tests.check.test_other_number import _fanned, _recordings

TIMES: Array = STEP * np.arange(COUNT, dtype=np.float64)
END = float(TIMES[-1])


def _doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return list(check_recordings(load_scenario(folder / "scenario.yaml"), [load_recording(r) for r in recordings]))


def _plain(run: int, x: Array) -> float:
    """The loss of every run."""
    return 0.79


def _drifting(values: Array) -> Array:
    return values + 6.0 * TIMES / END


def _off(values: Array) -> Array:
    return values + 6.0 * ((TIMES > 0.3 * END) & (TIMES < 0.6 * END))


def _behind(values: Array) -> Array:
    found = values.copy()
    for n in range(1, COUNT):
        found[n] = found[n - 1] + (1.0 - np.exp(-STEP / 200.0)) * (values[n] - found[n - 1])
    return found


@pytest.mark.parametrize(
    ("sensor", "words"),
    [
        (_drifting, r"drifted in proportion to time, by ([\d.]+) K \(([\d.]+) to ([\d.]+)\) from begin to end"),
        (_off, r"was off by ([\d.]+) K \(([\d.]+) to ([\d.]+)\) from about ([\d.]+) to ([\d.]+) s"),
    ],
    ids=["drift", "offset"],
)
def test_a_sensor_that_explains_the_recording_is_told_and_no_number(
    sensor: Callable[[Array], Array], words: str, tmp_path: Path
) -> None:
    every = _doubts(tmp_path, _recordings(tmp_path, _plain, sensor=sensor))
    assert not [d for d in every if d.is_serious or d.kind == "number"]
    (told,) = [d for d in every if "as if this sensor" in d.statement]
    assert (told.recording, told.subject, told.kind) == ("run_2", "stack.bottom", "sensor")
    found = re.search(words, told.statement)
    assert found is not None, told.statement
    size, least, most, *numbers = (float(n) for n in found.groups())
    assert least < size < most
    assert least <= 6.0 <= most  # the numbers of the model are off too
    if sensor is _off:
        assert numbers == pytest.approx([0.3 * END, 0.6 * END], rel=0.02)
        assert (told.begin, told.end) == pytest.approx(numbers, rel=0.01)


def test_a_lag_explains_what_is_behind_one(tmp_path: Path) -> None:
    """The check says before that a clock and a lag cannot be told apart there."""
    recordings = _recordings(tmp_path, _plain, sensor=_behind)
    every = [compare(load_scenario(tmp_path / "scenario.yaml"), load_recording(r)) for r in recordings]
    told = sensor_of_one(every[1], [every[0], every[2]])
    assert told is not None
    found = re.search(r"as if this sensor had a lag of about ([\d.]+) s", told.statement)
    assert found is not None, told.statement
    assert float(found[1]) == pytest.approx(200.0, rel=0.1)
    assert sensor_of_one(every[0], every[1:]) is None


def test_a_sensor_that_stands_still_twice_is_told_with_both_stretches(tmp_path: Path) -> None:
    recordings = _recordings(tmp_path, _plain)
    table = pd.read_csv(recordings[1] / "data.csv")
    for begin, end in ((0.2, 0.35), (0.6, 0.8)):
        rows = slice(int(begin * COUNT), int(end * COUNT))
        table.loc[rows, "stack.bottom"] = table["stack.bottom"].iloc[rows.start]
    table.to_csv(recordings[1] / "data.csv", index=False)
    every = [compare(load_scenario(tmp_path / "scenario.yaml"), load_recording(r)) for r in recordings]
    told = sensor_of_one(every[1], [every[0], every[2]])
    assert told is not None
    found = re.search(r"stood still from ([\d.]+) to ([\d.]+) s and from ([\d.]+) to ([\d.]+) s", told.statement)
    assert found is not None, told.statement
    assert [float(n) / END for n in found.groups()] == pytest.approx([0.2, 0.35, 0.6, 0.8], abs=0.01)
    assert (told.begin, told.end) == (pytest.approx(0.2 * END, rel=0.02), pytest.approx(0.8 * END, rel=0.02))


def test_readings_that_repeat_where_the_rig_rests_explain_nothing(tmp_path: Path) -> None:
    """A few equal readings beside a sensor that is off: the offset is reported, and no sensor that stands still."""
    recordings = _recordings(tmp_path, _plain, sensor=_off)
    table = pd.read_csv(recordings[1] / "data.csv")
    table.loc[:12, "stack.bottom"] = table["stack.bottom"].iloc[0]
    table.to_csv(recordings[1] / "data.csv", index=False)
    every = [compare(load_scenario(tmp_path / "scenario.yaml"), load_recording(r)) for r in recordings]
    told = sensor_of_one(every[1], [every[0], every[2]])
    assert told is not None
    assert "was off by" in told.statement


def test_a_number_that_moves_both_channels_is_no_sensor(tmp_path: Path) -> None:
    (told,) = [d for d in _doubts(tmp_path, _recordings(tmp_path, _fanned)) if d.is_serious]
    assert told.kind == "number"


def test_what_no_fault_of_a_sensor_explains_stands_out(tmp_path: Path) -> None:
    """It shows the square of what is there, about its mean, from largest to least."""

    def folded(values: Array) -> Array:
        return np.asarray(values.mean() - 0.5 * (values - values.mean()) ** 2)

    every = _doubts(tmp_path, _recordings(tmp_path, _plain, sensor=folded))
    assert not [d for d in every if "as if this sensor" in d.statement]
    assert "run_2" in {d.recording for d in every}
