"""A recording that the scenario misses while it meets its siblings, and recordings that it misses alike."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.systems.rigs import COUNT, drive, oscillator, oscillator_recordings


def _doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return [d for d in _all_doubts(folder, recordings) if d.kind == "odd one out"]


def _all_doubts(folder: Path, recordings: list[Path]) -> tuple[Doubt, ...]:
    return check_recordings(load_scenario(str(folder / "scenario.yaml")), [load_recording(r) for r in recordings])


def test_the_recording_with_another_run_s_input_is_named_and_nulls_and_missing_laws_are_not(tmp_path: Path) -> None:
    oscillator(tmp_path)
    null = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    assert _doubts(tmp_path, null) == []
    assert _doubts(tmp_path, null[:2]) == []  # of two, either may be the odd one
    table = pd.read_csv(null[1] / "data.csv")
    table["u"] = drive(17, 0.4)  # the input of a run that is none of these
    table.to_csv(null[1] / "data.csv", index=False)
    assert len(table) == COUNT
    (told,) = _doubts(tmp_path, null)
    assert told.recording == "run_2"
    assert told.is_serious  # nothing of its course is explained, and all of the others' is
    assert "of the variance of each other recording" in told.statement


@pytest.mark.parametrize("size", [1.0, 3.0])
def test_where_numbers_are_off_in_all_it_has_to_move_within_what_the_others_move_within(
    tmp_path: Path, size: float
) -> None:
    """All readings 40 % too large: none is met as it is, and two are when they are scaled."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    for number, recording in enumerate(recordings):
        table = pd.read_csv(recording / "data.csv")
        table["x"] *= 1.4
        if number == 1:
            table["u"] = drive(17, 0.4)
            table[["u", "x"]] *= size
        table.to_csv(recording / "data.csv", index=False)
    (told,) = _doubts(tmp_path, recordings)
    assert told.recording == "run_2"
    assert "scaled and shifted as suits each channel best" in told.statement
    assert told.is_serious == (size == 1.0)  # at three times their size a law may act in it alone


def test_recordings_that_are_met_within_their_noise_are_all_alike(tmp_path: Path) -> None:
    """Nothing is left of any: ten times nothing is no more than nothing."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    for recording in recordings:
        sidecar = yaml.safe_load((recording / "recording.yaml").read_text(encoding="utf-8"))
        for channel in sidecar["channels"].values():
            channel["noise"] = f"0.1 {channel['unit']}"  # far more than what numbers that are off leave
        (recording / "recording.yaml").write_text(yaml.safe_dump(sidecar), encoding="utf-8")
    assert _doubts(tmp_path, recordings) == []


def test_a_law_that_is_missing_in_all_recordings_makes_none_of_them_odd(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -4.0 * float(np.tanh(v / 0.02)))
    assert _doubts(tmp_path, recordings) == []


def test_a_recording_that_is_met_but_for_a_sensor_is_searched_all_the_same(tmp_path: Path) -> None:
    """A sensor that is off for a while leaves a recording of this experiment: what is off is looked for."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    table = pd.read_csv(recordings[1] / "data.csv")
    last = table.columns[-1]
    offset = 1.0 * float(np.std(table[last]))
    table.loc[COUNT // 2 : 3 * COUNT // 4, last] += offset
    table.to_csv(recordings[1] / "data.csv", index=False)
    assert _doubts(tmp_path, recordings) == []
    (told,) = _all_doubts(tmp_path, recordings)
    assert (told.recording, told.kind, told.is_serious) == ("run_2", "sensor", False)
    sizes = re.search(r"this sensor was off by ([\d.]+) m \(([\d.]+) to ([\d.]+)\) from about", told.statement)
    assert sizes is not None, told.statement
    size, least, most = (float(n) for n in sizes.groups())
    assert least < size < most
    assert least <= offset <= most


@pytest.mark.parametrize(("count", "is_told"), [(4, False), (1, False), (40, True)])
def test_single_wild_readings_make_no_odd_one(count: int, is_told: bool, tmp_path: Path) -> None:
    """Four of 400 readings by a metre or so; forty are a fault."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    table = pd.read_csv(recordings[1] / "data.csv")
    rng, last = np.random.default_rng(3), table.columns[-1]
    rows = rng.choice(np.arange(5, COUNT - 5), count, replace=False)
    table.loc[rows, last] += rng.choice([-1.0, 1.0], count) * rng.uniform(2.0, 4.0, count) * float(np.std(table[last]))
    table.to_csv(recordings[1] / "data.csv", index=False)
    assert {d.recording for d in _doubts(tmp_path, recordings)} == ({"run_2"} if is_told else set())


def test_a_recording_in_which_little_moves_is_no_odd_one(tmp_path: Path) -> None:
    """Friction that the model lacks takes most of a small motion: no more of its unit than of a large one."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -0.5 * float(np.tanh(v / 0.02)))
    table = pd.read_csv(recordings[1] / "data.csv")
    for name in table.columns[1:]:
        table[name] *= 0.1
    table.to_csv(recordings[1] / "data.csv", index=False)
    assert [d for d in _doubts(tmp_path, recordings) if d.is_serious] == []


@pytest.mark.parametrize("factor", [1.0, 1.4], ids=["as it is", "numbers are off in all"])
def test_a_recording_that_is_met_at_first_is_of_this_experiment(tmp_path: Path, factor: float) -> None:
    """From half of it on the rig does what the stated input does not make it do: something happened there."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    tables = [pd.read_csv(r / "data.csv") for r in recordings]
    half = COUNT // 2
    tables[1].loc[half:, "x"] = -tables[2]["x"][half:]
    for recording, table in zip(recordings, tables):
        table["x"] *= factor
        table.to_csv(recording / "data.csv", index=False)
    (told,) = _doubts(tmp_path, recordings)
    assert (told.recording, told.is_serious) == ("run_2", False)
    until = re.search(r"; until ([\d.]+) s it does not stand out$", told.statement)
    assert until is not None, told.statement
    times = tables[1]["t"].to_numpy()
    assert times[0] + 0.3 * (times[-1] - times[0]) < float(until[1]) <= times[half] + 0.11 * (times[-1] - times[0])
