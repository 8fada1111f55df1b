"""A recording under whose inputs an FMU that integrates itself is unstable: one error, and no warnings of numpy."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.check.beside import compare
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import built, write_recording

#: Time from which the input is so large that steps of 1 ms of the classical Runge-Kutta method are unstable [s];
#: its rate then: beyond 2.785 over the step, by so little that no number overflows.
SINCE, UNSTABLE = 30.0, 2790.0
LAMP = OdeModel(
    "lamp",
    {"rest": (0.5, "")},
    {"pull": "1/s"},
    {"x": ("", "0", "pull*(1 - x) + 0.1*(rest - x)")},
    {"level": ("", "x")},
)
SCENARIO = """\
title: A lamp
time: {stop: 100 s, macro_step: 500 ms, output_step: 500 ms}
components:
  source: {kind: programme, outputs: {pull: {unit: 1/s, constant: 0 1/s}}}
  lamp: {kind: fmu, fmu: lamp.fmu}
connections: [source.pull -> lamp.pull]
"""


def _recording(folder: Path, pull: float) -> Path:
    times = 0.5 * np.arange(200)
    columns = {"t": times, "u": np.where(times >= SINCE, pull, 0.2), "x": np.linspace(0.0, 0.9, 200)}
    inputs, channels = {"source.pull": ("u", "1/s")}, {"lamp.level": ("x", "1", "0.01")}
    return write_recording(folder, columns, inputs, channels)


def test_it_is_told_when_and_what_to_do(tmp_path: Path) -> None:
    built(LAMP, SCENARIO, tmp_path)
    scenario, recording = (
        load_scenario(tmp_path / "scenario.yaml"),
        load_recording(_recording(tmp_path / "day", UNSTABLE)),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError) as told:
            compare(scenario, recording)
    text = str(told.value)
    assert "channels.lamp.level" in text
    seconds = float(text.split("runs away: from ")[1].split(" s on")[0])
    assert SINCE < seconds < 99.0
    assert "a shorter `time.macro_step`" in text + told.value.remedy


def test_a_run_that_stays_is_compared(tmp_path: Path) -> None:
    built(LAMP, SCENARIO, tmp_path)
    recording = load_recording(_recording(tmp_path / "day", 0.3))
    beside = compare(load_scenario(tmp_path / "scenario.yaml"), recording).channels["lamp.level"]
    assert np.isfinite(beside.simulated_there).all()
