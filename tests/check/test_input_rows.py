"""How far a channel is moved by what rows of its inputs do not say: a store, whose answer is a closed form."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario, load_scenario
from diagnosis.check.input_rows import moved_by_rows, with_input_rows, with_instants
from diagnosis.judge.diagnosis import Adequacy, Left
from diagnosis.judge.headline import how_right
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.problem import Own, Parameter
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

STORE = OdeModel("store", {}, {"inflow": "m^3/s"}, {"V": ("m^3", "0", "inflow")}, {"volume": ("m^3", "V")})
SCENARIO = """\
title: A store
time: {stop: 100 s, macro_step: 1 s, output_step: 1 s}
components:
  pump: {kind: programme, outputs: {flow: {unit: m^3/s, constant: 0 m^3/s}}}
  store: {kind: fmu, fmu: store.fmu, integrator: cvode}
connections: [pump.flow -> store.inflow]
"""
ROW = 10.0


@pytest.fixture
def store(tmp_path: Path) -> tuple[Scenario, Recording]:
    """A pump that starts with 2 m^3/s at the row of 50 s, rows of 10 s."""
    STORE.build(tmp_path)
    times = ROW * np.arange(11)
    flow = np.where(times >= 50.0, 2.0, 0.0)
    columns = {"t": times, "q": flow, "V": np.cumsum(np.r_[0.0, flow[:-1]]) * ROW}
    channels = {"store.volume": ("V", "m^3", "0.1 m^3")}
    recording = write_recording(tmp_path / "run", columns, {"pump.flow": ("q", "m^3/s")}, channels)
    (tmp_path / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    return load_scenario(str(tmp_path / "scenario.yaml")), load_recording(recording)


def test_the_volume_is_off_by_the_flow_times_the_part_of_the_row(store: tuple[Scenario, Recording]) -> None:
    """Of a start anywhere in the row before, 2 m^3/s times 0 to 10 s is in the store from then on: rms 11.5 m^3."""
    scenario, recording = store
    found = moved_by_rows(scenario, recording, recording.channels["store.volume"])
    whole = 2.0 * ROW / np.sqrt(3.0) * np.sqrt(6.0 / 11.0)  # uniform, in 6 of 11 readings
    assert 0.4 * whole < found < 1.6 * whole  # four draws


def test_an_input_that_stands_still_moves_nothing(store: tuple[Scenario, Recording]) -> None:
    scenario, recording = store
    (flow,) = recording.inputs
    still = replace(recording, inputs=(replace(flow, values=np.zeros_like(flow.values)),))
    assert moved_by_rows(scenario, still, recording.channels["store.volume"]) == 0.0


def test_the_headline_names_rows_of_inputs_where_they_may_be_the_reason(store: tuple[Scenario, Recording]) -> None:
    scenario, recording = store
    worst = Left(recording.title, "store.volume", "m^3", 12.0, 0.1, 14400.0, 1.2)
    chi = {"before": 15000.0, "recalibrated": 14400.0, "after": 14400.0}
    right = Adequacy("held-out recordings", True, chi, 1.2, 0.1, 0.1, worst, (1, 1), (), 0, True, True, True, False)
    told = how_right(with_input_rows(right, scenario, [recording]), is_amended=False)
    assert "something is missing or wrong, or its inputs changed between rows of their table" in told
    small = replace(right, worst=replace(worst, rmse=1000.0))
    assert "rows" not in how_right(with_input_rows(small, scenario, [recording]), is_amended=False)
    estimated = with_input_rows(right, scenario, [recording], {recording.title})
    assert estimated == right  # what is left is left in spite of it
    told = how_right(with_input_rows(right, scenario, [recording], {"another"}), is_amended=False)
    assert "its inputs changed between rows" in told  # this one has more changes than a model estimates
    met = replace(right, is_rejected=False)
    assert with_input_rows(met, scenario, [recording]) == met


def test_instants_belong_to_the_recordings_that_have_them() -> None:
    own = Own("change of pump.flow before 50 s", 1)
    instant = Parameter("change of pump.flow before 50 s", "s", 0.0, 5.0, False, own=own, is_within_row=True)
    assert with_instants([instant, Parameter("area", "m^2", 0.0, 1.0, False)], ["first", "second"]) == {"second"}
