"""Two thermocouples of parts that are much alike, exchanged in one recording of three."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

PLATES = OdeModel(
    "plates",
    {"one": (0.020, "1/s"), "two": (0.021, "1/s"), "heat": (0.05, "K/J")},
    {"power": "W"},
    {"T_1": ("K", "300", "heat*power - one*(T_1 - 300)"), "T_2": ("K", "300", "heat*power - two*(T_2 - 300)")},
    {"left": ("K", "T_1"), "right": ("K", "T_2")},
)
SCENARIO = """\
title: Two plates
time: {stop: 600 s, macro_step: 1 s, output_step: 1 s}
components:
  supply: {kind: programme, outputs: {power: {unit: W, constant: 0 W}}}
  rig: {kind: fmu, fmu: plates.fmu, integrator: cvode}
connections: [supply.power -> rig.power]
"""
STEP, COUNT = 5.0, 120


def recordings(folder: Path, exchanged: tuple[int, ...]) -> list[Path]:
    """Three recordings of plates that answer by 12 % more and 8 % less than the scenario says."""
    found = []
    for number in range(3):
        rng = np.random.default_rng(number)
        power = np.repeat(rng.uniform(0.0, 20.0, COUNT // 12), 12)

        def rate(x: Array, u: float) -> Array:
            return np.array([0.056 * u - 0.02 * x[0], 0.046 * u - 0.021 * x[1]])

        states = 300.0 + held(rate, np.zeros(2), power, STEP) + 0.1 * rng.standard_normal((COUNT, 2))
        if number in exchanged:
            states = states[:, ::-1]
        columns = {"t": STEP * np.arange(COUNT), "P": power, "a": states[:, 0], "b": states[:, 1]}
        channels = {"rig.left": ("a", "K", "0.1 K"), "rig.right": ("b", "K", "0.1 K")}
        found.append(write_recording(folder / f"run_{number + 1}", columns, {"supply.power": ("P", "W")}, channels))
    return found


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    PLATES.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    return tmp_path


def doubts(folder: Path, given: list[Path]) -> list[Doubt]:
    found = check_recordings(load_scenario(str(folder / "scenario.yaml")), [load_recording(r) for r in given])
    return [d for d in found if d.is_serious]


def test_the_recording_with_exchanged_thermocouples_is_named(rig: Path) -> None:
    (told,) = doubts(rig, recordings(rig, (1,)))
    assert (told.recording, told.kind, told.subject) == ("run_2", "swapped", "rig.left, rig.right")
    assert "as the other one is expected to read" in told.statement


def test_no_exchange_and_the_same_exchange_in_all_recordings_are_no_exchange_in_one(rig: Path) -> None:
    assert doubts(rig, recordings(rig, ())) == []
    in_all = doubts(rig, recordings(rig, (0, 1, 2)))
    assert not [d for d in in_all if "as the other one is expected to read" in d.statement]


def test_of_two_recordings_either_may_be_the_wrong_one(rig: Path) -> None:
    given = recordings(rig, (1,))[:2]
    assert not [d for d in doubts(rig, given) if "as the other one is expected to read" in d.statement]
    table = pd.read_csv(given[0] / "data.csv")
    assert abs(table["a"].max() - table["b"].max()) > 2.0  # they differ by far more than their noise
