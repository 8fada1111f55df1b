"""A programme that was played in none of the recordings, and rigs that only answer badly."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.beside import compare
from diagnosis.check.check import check_recordings
from diagnosis.check.response import followed
from diagnosis.check.unfollowed import unfollowed
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.systems.rigs import oscillator, oscillator_recordings

SIZES = (0.4, 0.5, 0.45)


def _questions(folder: Path, recordings: list[Path]) -> list[Doubt]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    every = check_recordings(scenario, [load_recording(r) for r in recordings])
    return [d for d in every if "in this and in every other recording" in d.statement]


def _exchange_inputs(recordings: list[Path], seed: int = 3) -> None:
    """Inputs that acted in none of them: the stated ones in random pieces."""
    for n, recording in enumerate(recordings):
        table = pd.read_csv(recording / "data.csv")
        pieces = np.array_split(table["u"].to_numpy(), 40)
        order = np.random.default_rng(seed + n).permutation(len(pieces))
        table["u"] = np.concatenate([-pieces[i][::-1] for i in order])
        table.to_csv(recording / "data.csv", index=False)


def test_inputs_that_acted_in_no_recording_are_told(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _exchange_inputs(recordings)
    (told,) = _questions(tmp_path, recordings)
    assert told.recording == "run_1"
    assert told.subject == "rig.position"
    assert told.is_serious
    assert "no response with memory joins these readings to the inputs" in told.statement
    assert "compare the programme" in told.remedy


def test_inputs_that_acted_are_no_others_where_the_model_is_wrong_by_far(tmp_path: Path) -> None:
    """A spring of a twentieth, and more friction: it answers a quarter of a period late, and follows its drive."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 380.0 * x - 20.0 * v, (1.0, 1.5, 1.2))
    (told,) = _questions(tmp_path, recordings)
    assert not told.is_serious
    assert "are the inputs" in told.remedy


def test_a_drive_that_changes_seldom_tells_nothing_of_a_response(tmp_path: Path) -> None:
    """A drift beside it could not be told from an answer."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    for recording in recordings:
        table = pd.read_csv(recording / "data.csv")
        table["u"] = np.where((table["t"] > 1.0) & (table["t"] < 1.3), 0.4, 0.0)
        table.to_csv(recording / "data.csv", index=False)
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    every = [compare(scenario, load_recording(r)) for r in recordings]
    assert followed(every, "rig.position") is None
    assert not any(d.is_serious for d in unfollowed(every))


@pytest.mark.parametrize(
    "law",
    [
        lambda x, v: 0.0,
        lambda x, v: -40.0 * x,  # a tenth stiffer
        lambda x, v: -5.0 * np.tanh(v / 0.1),  # dry friction
    ],
)
def test_a_rig_that_answers_to_its_inputs_is_not_asked(law, tmp_path: Path) -> None:
    oscillator(tmp_path)
    assert _questions(tmp_path, oscillator_recordings(tmp_path, law, SIZES)) == []


def test_one_recording_and_one_that_is_followed_are_not_asked(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _exchange_inputs(recordings[:2])
    assert _questions(tmp_path, recordings) == []  # of the third it explains nearly all
    assert _questions(tmp_path, recordings[:1]) == []


def test_where_something_serious_is_told_it_is_the_reason(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _exchange_inputs(recordings, 2)
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    assert any(d.is_serious for d in check_recordings(scenario, [load_recording(r) for r in recordings]))
    assert _questions(tmp_path, recordings) == []


def test_a_recording_without_the_channel_is_not_spoken_of(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _exchange_inputs(recordings)
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    every = [compare(scenario, load_recording(r)) for r in recordings]
    (told,) = unfollowed([every[0], replace(every[1], channels={}), every[2]])
    assert "in every other recording that has it" in told.statement
    assert unfollowed([every[0], replace(every[1], channels={}), replace(every[2], channels={})]) == []
