"""A channel in another unit than all recordings state, and rigs that are only larger than their scenario."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.systems.rigs import held, tank, write_recording

STEP, COUNT = 0.5, 200
#: Numbers in feet for each in metres.
FEET = 1.0 / 0.3048


def _recordings(
    folder: Path, factor: float, start: float = 0.4, pump: float = 1.0, seeds: tuple[int, ...] = (0, 1)
) -> list[Path]:
    """Levels in steps of the inflow, 5 % off; written as so many times what they are, and stated in m."""
    tank(folder, "100 s", "500 ms")
    found = []
    for one, seed in enumerate(seeds):
        rng = np.random.default_rng(seed)
        inflow = np.repeat(rng.uniform(0.002, 0.03, 10), COUNT // 10)
        level = held(lambda h, q: (pump * q - 0.021 * h) / 0.49, np.array([start]), inflow, STEP)[:, 0]
        columns = {
            "t": STEP * np.arange(COUNT),
            "q": inflow,
            "h": factor * (level + 1e-3 * rng.standard_normal(COUNT)),
        }
        inputs, channels = {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
        found.append(write_recording(folder / f"run_{one + 1}", columns, inputs, channels))
    return found


def _doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    found = check_recordings(load_scenario(str(folder / "scenario.yaml")), [load_recording(r) for r in recordings])
    return [d for d in found if d.kind == "unit"]


def test_feet_that_all_recordings_state_as_metres_are_asked_about(tmp_path: Path) -> None:
    found = _doubts(tmp_path, _recordings(tmp_path, FEET))
    assert {d.recording for d in found} == {"run_1", "run_2"}
    assert all(d.is_serious for d in found)
    assert "as if it were in ft and not in m" in found[0].statement
    assert "first readings are 3.28 times" in found[0].statement


@pytest.mark.parametrize(
    "about",
    [
        {"factor": 1.0},
        {"factor": 1.0, "start": 0.4 * FEET},  # a start that is stated wrongly: how far it moves is right
        {"factor": 1.0, "pump": 2.85, "seeds": (0, 0)},  # it moves by 3.3 times as much: where it starts is right
        {"factor": FEET, "start": 0.0},  # no start: a number that is off would do the same
        {"factor": 2.7},  # no unit
        {"factor": FEET, "seeds": (0,)},
    ],
)
def test_what_may_be_the_rig_is_no_unit(about: dict[str, Any], tmp_path: Path) -> None:
    assert _doubts(tmp_path, _recordings(tmp_path, **about)) == []


def test_a_start_near_zero_beside_the_noise_says_nothing_of_the_unit(tmp_path: Path) -> None:
    """A pump 3.3 times as strong, and 16 mm where the scenario says 5 mm: two that are off, and no feet."""
    recordings = _recordings(tmp_path, 1.0, start=0.005 * FEET, pump=3.3, seeds=(0, 0))
    path = tmp_path / "scenario.yaml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("cvode}", "cvode, parameters: {h_0: 5 mm}}"), encoding="utf-8")
    assert _doubts(tmp_path, recordings) == []


def test_one_recording_in_feet_is_asked_about_alone(tmp_path: Path) -> None:
    recordings = _recordings(tmp_path, 1.0, seeds=(0, 1, 2))
    table = pd.read_csv(recordings[1] / "data.csv")
    table["h"] *= FEET
    table.to_csv(recordings[1] / "data.csv", index=False)
    (found,) = _doubts(tmp_path, recordings)
    assert found.recording == "run_2"
    assert "those of the other recordings" in found.statement
