"""Two inputs of one recording that have each other's numbers, beside what only resembles that."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Doubt, Verdict
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

STEP, COUNT, HOLD, NOISE = 5.0, 600, 20, 0.02
#: A vessel with a strong and a weak feed, a heater in degrees, and a drain: level and concentration.
NUMBERS = {"area": 2.0, "drain": 0.05, "strong": 1.0, "weak": 0.2, "also": 0.0, "trace": 0.02}
VESSEL = OdeModel(
    "vessel",
    {name: (value, "1") for name, value in NUMBERS.items()},
    {"first": "1", "second": "1", "third": "1"},
    {
        "h": ("1", "1", "(first + second + also*third - drain*h)/area"),
        "salt": ("1", "0.3", "(strong*first + weak*second + trace*third - drain*salt)/area"),
    },
    {"level": ("1", "h"), "load": ("1", "salt")},
)
SCENARIO = f"""\
title: A vessel with two feeds
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  desk:
    kind: programme
    outputs:
      first: {{unit: "1", constant: 0}}
      second: {{unit: "1", constant: 0}}
      third: {{unit: "1", constant: 0}}
  vessel: {{kind: fmu, fmu: vessel.fmu, integrator: cvode, parameter_set: numbers.yaml}}
connections: [desk.first -> vessel.first, desk.second -> vessel.second, desk.third -> vessel.third]
"""
INPUTS = ("first", "second", "third")


def feeds(seed: int) -> Array:
    """The three inputs, shape (3, COUNT)."""
    rng = np.random.default_rng(seed)
    most = np.array([0.1, 0.14, 1.0])[:, None]
    return np.repeat(rng.uniform(0.0, most, (3, COUNT // HOLD)), HOLD, axis=1)


def course(given: Array, numbers: dict[str, float]) -> Array:
    """Level and load by the numbers of the rig, shape (COUNT, 2)."""
    area, drain, strong, weak, also, trace = numbers.values()
    level, load = given[0] + given[1] + also * given[2], strong * given[0] + weak * given[1] + trace * given[2]
    steady = np.stack([level, load], axis=1) / drain
    kept, found = np.exp(-drain / area * STEP), np.empty((COUNT, 2))
    found[0] = 1.0, 0.3
    for n in range(COUNT - 1):
        found[n + 1] = steady[n] + kept * (found[n] - steady[n])
    return found


def recordings_of(
    folder: Path, order: tuple[int, int, int], off: float = 1.0, programme: bool = False, is_twin: bool = False
) -> list[Recording]:
    """Three runs; in the second the inputs are stated in another order.

    Args:
        folder: Where they go.
        order: Which course each input is said to have had in the second run.
        off: Factor of the rig's drain.
        programme: Whether courses stand under `overrides` and not in columns.
        is_twin: Whether the third input acts as the second does, and has the course that the second is said to have.
    """
    VESSEL.build(folder)
    numbers = {**NUMBERS, "also": 1.0, "trace": NUMBERS["weak"]} if is_twin else NUMBERS
    own = {n: {"value": v, "unit": "1", "source": "test", "uncertainty": 0.1} for n, v in numbers.items()}
    (folder / "numbers.yaml").write_text(yaml.safe_dump({"title": "vessel", "parameters": own}), encoding="utf-8")
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    found = []
    for run in (1, 2, 3):
        rng, given = np.random.default_rng(50 + run), feeds(run)
        if is_twin:
            given[2] = given[0]
        x = course(given, {**numbers, "drain": off * numbers["drain"]})
        said = given[list(order)] if run == 2 else given
        columns: dict[str, Array] = {"t": STEP * np.arange(COUNT), **dict(zip(INPUTS, said))}
        columns |= {n: x[:, i] + NOISE * rng.standard_normal(COUNT) for i, n in enumerate(("h", "s"))}
        channels = {"vessel.level": ("h", "1", f"{NOISE} 1"), "vessel.load": ("s", "1", f"{NOISE} 1")}
        inputs = {} if programme else {f"desk.{n}": (n, "1") for n in INPUTS}
        path = write_recording(folder / f"run_{run}", columns, inputs, channels)
        if programme:
            about = yaml.safe_load((path / "recording.yaml").read_text(encoding="utf-8"))
            points = {
                n: {"points": [[f"{STEP * HOLD * i:g} s", f"{float(v)!r}"] for i, v in enumerate(row[::HOLD])]}
                for n, row in zip(INPUTS, said)
            }
            about["overrides"] = {"components": {"desk": {"outputs": points}}}
            (path / "recording.yaml").write_text(yaml.safe_dump(about, sort_keys=False), encoding="utf-8")
        found.append(load_recording(path))
    return found


def serious(folder: Path, recordings: list[Recording]) -> list[Doubt]:
    return [d for d in check_recordings(load_scenario(folder / "scenario.yaml"), recordings) if d.is_serious]


def answer(folder: Path, recordings: list[Recording]) -> Diagnosis:
    scenario = load_scenario(folder / "scenario.yaml")
    return diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True)).diagnosis


@pytest.mark.parametrize("programme", [False, True], ids=["columns", "overrides"])
def test_two_inputs_that_are_exchanged_in_one_recording_are_told(tmp_path: Path, programme: bool) -> None:
    recordings = recordings_of(tmp_path, (1, 0, 2), programme=programme)
    (doubt,) = serious(tmp_path, recordings)
    assert (doubt.recording, doubt.kind, doubt.subject) == ("run_2", "exchanged", "desk.first, desk.second")
    assert "with the numbers of desk.first and desk.second exchanged at least 99" in doubt.statement
    found = answer(tmp_path, recordings)
    assert found.verdict is Verdict.RECORDING_FAULT
    assert found.statement.startswith("Inputs are exchanged: in run_2")


def test_they_are_told_where_a_number_is_off_too(tmp_path: Path) -> None:
    recordings = recordings_of(tmp_path, (1, 0, 2), off=1.15)
    found = answer(tmp_path, recordings)
    told = [d for d in found.doubts if d.kind == "exchanged"]
    assert [(d.recording, d.subject) for d in told] == [("run_2", "desk.first, desk.second")]


def test_three_inputs_that_went_round_are_no_pair(tmp_path: Path) -> None:
    recordings = recordings_of(tmp_path, (1, 2, 0))
    assert not [d for d in serious(tmp_path, recordings) if d.kind == "exchanged"]


def test_inputs_as_they_were_are_not_exchanged(tmp_path: Path) -> None:
    assert serious(tmp_path, recordings_of(tmp_path, (0, 1, 2))) == []


def test_with_which_of_two_that_act_alike_one_was_exchanged_is_not_said(tmp_path: Path) -> None:
    assert not [d for d in serious(tmp_path, recordings_of(tmp_path, (1, 0, 2), is_twin=True)) if d.kind == "exchanged"]
