"""A slow rig in one recording with another course of its input, beside what only looks like that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check import input_runs
from diagnosis.check.check import check_recordings
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import built, held, write_recording

#: Heat capacities of a plate and of a block under it [J/K], conductance between them and from the block [W/K].
C_1, C_2, G, G_OUT = 400.0, 900.0, 1.2, 0.8
#: Interval of the readings and of the FMU [s], their number, readings for which a power is held, noise [K].
STEP, COUNT, HOLD, NOISE = 20.0, 600, 60, 0.05
STACK = OdeModel(
    "stack",
    {"C_1": (C_1, "J/K"), "C_2": (C_2, "J/K"), "G": (G, "W/K"), "G_out": (G_OUT, "W/K")},
    {"power": "W"},
    {
        "plate": ("K", "295", "(power - G*(plate - block))/C_1"),
        "block": ("K", "295", "(G*(plate - block) - G_out*(block - 295))/C_2"),
    },
    {"top": ("K", "plate"), "bottom": ("K", "block")},
)
SCENARIO = f"""\
title: A plate on a block
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  heater: {{kind: programme, outputs: {{power: {{unit: W, constant: 10 W}}}}}}
  stack: {{kind: fmu, fmu: stack.fmu, integrator: cvode}}
connections: [heater.power -> stack.power]
"""
CHANNELS = {name: (name, "K", f"{NOISE} K") for name in ("stack.top", "stack.bottom")}


def _power(seed: int) -> Array:
    return np.repeat(np.random.default_rng(seed).uniform(0.0, 40.0, COUNT // HOLD), HOLD)


def _recordings(folder: Path, stated: Sequence[int], names: Sequence[str] = tuple(CHANNELS)) -> list[Path]:
    """Recordings of runs 1, 2 and 3, each with the column of power of the run that is stated."""
    return recordings_of(folder, lambda run: (_power(stated[run - 1]), temperatures(_power(run))), names)


def recordings_of(
    folder: Path, made: Callable[[int], tuple[Array, Array]], names: Sequence[str] = tuple(CHANNELS)
) -> list[Path]:
    """The scenario, and recordings of runs 1, 2 and 3.

    Args:
        folder: Where they go.
        made: Number of a run to the column of its power, shape (COUNT,), and its temperatures [K], shape (COUNT, 2).
        names: Channels that are recorded.
    """
    built(STACK, SCENARIO, folder)
    return [recorded(folder / f"run_{run}", *made(run), np.random.default_rng(100 + run), names) for run in (1, 2, 3)]


def temperatures(power: Array) -> Array:
    """Of plate and block [K] by the numbers of the scenario, shape (steps, 2)."""

    def rate(x: Array, u: float) -> Array:
        through = G * (x[0] - x[1])
        return np.array([(u - through) / C_1, (through - G_OUT * (x[1] - 295.0)) / C_2])

    return held(rate, np.array([295.0, 295.0]), power, STEP)


def recorded(folder: Path, power: Array, course: Array, rng: np.random.Generator, names: Sequence[str]) -> Path:
    """A recording of both temperatures, shape (COUNT, 2), with noise, or of one of them."""
    columns: dict[str, Array] = {"t": STEP * np.arange(COUNT), "P": power}
    columns |= {n: course[:, i] + NOISE * rng.standard_normal(COUNT) for i, n in enumerate(CHANNELS)}
    return write_recording(folder, columns, {"heater.power": ("P", "W")}, {n: CHANNELS[n] for n in names})


def _doubts(folder: Path, recordings: Sequence[Path]) -> list[Doubt]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return list(check_recordings(scenario, [load_recording(r) for r in recordings]))


def _of_power(doubts: Sequence[Doubt]) -> list[Doubt]:
    return [d for d in doubts if d.kind == "programme"]


@pytest.mark.parametrize("told", [11, 12, 13])
def test_a_column_of_another_run_is_told_and_nothing_is_searched(tmp_path: Path, told: int) -> None:
    recordings = _recordings(tmp_path, (1, told, 3))
    (doubt,) = _of_power(_doubts(tmp_path, recordings))
    assert (doubt.recording, doubt.subject, doubt.is_serious) == ("run_2", "heater.power", True)
    every = [load_recording(r) for r in recordings]
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.RECORDING_FAULT
    assert found.findings == ()
    assert "heater.power" in found.statement


def test_a_programme_that_was_not_played_is_told_of_the_recording_that_states_it(tmp_path: Path) -> None:
    recordings = _recordings(tmp_path, (1, 2, 3))
    for number, recording in enumerate(recordings):
        sidecar = yaml.safe_load((recording / "recording.yaml").read_text(encoding="utf-8"))
        del sidecar["inputs"]
        levels = _power(17 if number == 1 else number + 1)[::HOLD].tolist()
        points = [[f"{STEP * HOLD * i:g} s", f"{v:.9g} W"] for i, v in enumerate(levels)]
        sidecar["overrides"] = {"components": {"heater": {"outputs": {"power": {"unit": "W", "points": points}}}}}
        (recording / "recording.yaml").write_text(yaml.safe_dump(sidecar), encoding="utf-8")
    (doubt,) = _of_power(_doubts(tmp_path, recordings))
    assert (doubt.recording, doubt.subject, doubt.is_serious) == ("run_2", "heater.power", True)
    assert "stated course" in doubt.statement


def test_where_it_would_take_minutes_the_recording_stands_out_and_no_input_is_accused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(input_runs, "MOST", COUNT // 2)
    doubts = _doubts(tmp_path, _recordings(tmp_path, (1, 12, 3)))
    assert _of_power(doubts) == []
    assert [d.recording for d in doubts if d.kind == "odd one out"] == ["run_2"]


def test_numbers_of_the_model_that_are_off_hide_no_other_run(tmp_path: Path) -> None:
    """As it is the scenario meets no recording to 95 %; scaled and shifted it meets the others."""
    recordings = _recordings(tmp_path, (1, 12, 3))
    scenario = tmp_path / "scenario.yaml"
    text = scenario.read_text(encoding="utf-8")
    off = text.replace("integrator: cvode", "integrator: cvode, parameters: {G_out: 0.9 W/K, C_2: 1000 J/K}")
    scenario.write_text(off, encoding="utf-8")
    (doubt,) = _of_power(_doubts(tmp_path, recordings))
    assert (doubt.recording, doubt.subject, doubt.is_serious) == ("run_2", "heater.power", True)


def test_nothing_is_told_of_inputs_that_acted(tmp_path: Path) -> None:
    assert _of_power(_doubts(tmp_path, _recordings(tmp_path, (1, 2, 3)))) == []


def test_one_channel_that_another_input_would_explain_accuses_no_input(tmp_path: Path) -> None:
    """Any course of one channel is that of some input; which of both is wrong, one channel cannot show."""
    recordings = _recordings(tmp_path, (1, 11, 3), names=("stack.bottom",))
    assert _of_power(_doubts(tmp_path, recordings)) == []


def test_a_sensor_that_shows_something_else_accuses_no_input(tmp_path: Path) -> None:
    recordings = _recordings(tmp_path, (1, 2, 3))
    table = pd.read_csv(recordings[1] / "data.csv")
    table["stack.bottom"] = 0.5 * (pd.read_csv(recordings[2] / "data.csv")["stack.top"] + 295.0)
    table.to_csv(recordings[1] / "data.csv", index=False)
    assert _of_power(_doubts(tmp_path, recordings)) == []


def test_a_power_that_was_shared_with_a_sink_for_a_while_is_the_stated_one_for_the_rest(tmp_path: Path) -> None:
    """Half of the power went elsewhere for a third of one recording: the course is alike, and no other run's."""
    recordings = _recordings(tmp_path, (1, 2, 3))
    power = _power(2)
    power[COUNT // 3 : 2 * COUNT // 3] *= 0.3

    def rate(x: Array, u: float) -> Array:
        through = G * (x[0] - x[1])
        return np.array([(u - through) / C_1, (through - G_OUT * (x[1] - 295.0)) / C_2])

    course = held(rate, np.array([295.0, 295.0]), power, STEP)
    table = pd.read_csv(recordings[1] / "data.csv")
    for i, name in enumerate(CHANNELS):
        table[name] = course[:, i]
    table.to_csv(recordings[1] / "data.csv", index=False)
    doubts = _doubts(tmp_path, recordings)
    assert not [d for d in _of_power(doubts) if "unlike" in d.statement]
