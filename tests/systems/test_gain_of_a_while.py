"""A sensor whose gain was off for a while: told as such, and as an offset where readings hardly differ in size."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.faults.model import FaultyModel, with_faults
from diagnosis.judge.diagnosis import Verdict
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import Point, Term
from tests.systems.rigs import diagnosed, oscillator, oscillator_recordings

GAIN, BEGIN, END = 0.3, 1.2, 2.6


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Path]]:
    """Three runs, the second with an amplifier that gave 30 % more from 1.2 to 2.6 s."""
    folder = tmp_path_factory.mktemp("rig")
    oscillator(folder)
    recordings = oscillator_recordings(folder, lambda x, v: 0.0)
    table = pd.read_csv(recordings[1] / "data.csv")
    inside = (table["t"] > BEGIN) & (table["t"] < END)
    table["x"] *= np.where(inside, 1.0 + GAIN, 1.0)
    table.to_csv(recordings[1] / "data.csv", index=False)
    return folder, recordings


@pytest.fixture(scope="module")
def model(rig: tuple[Path, list[Path]]) -> FaultyModel:
    scenario = load_scenario(str(rig[0] / "scenario.yaml"))
    return with_faults(ClosedLoopModel(scenario, [load_recording(r) for r in rig[1]]))


def _gain(model: FaultyModel) -> Term:
    kind = "sensor_gain_in_interval"
    return next(t for t in model.sensor_terms if t.identifier == kind and t.recording == 1)


def test_a_gain_that_was_off_for_a_while_is_told(rig: tuple[Path, list[Path]]) -> None:
    every = [load_recording(r) for r in rig[1]]
    found = diagnosed(rig[0] / "scenario.yaml", every)
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.effect == "sensor_gain_in_interval"
    assert finding.recording == "run_2"
    gain = finding.parameters[0]
    assert gain.value == pytest.approx(GAIN, abs=0.02)
    assert gain.lower < GAIN < gain.upper
    ((begin, end),) = finding.intervals
    assert (begin, end) == pytest.approx((BEGIN, END), abs=0.06)


def test_it_changes_what_its_sensor_reads_by_that_share(model: FaultyModel) -> None:
    zero = Point(np.zeros(len(model.parameters)))
    clean = model.predict(zero, 1)[0]
    read = model.predict(zero.plus(_gain(model), (GAIN, BEGIN, END)), 1)[0]
    times = model.sensor_terms[_gain(model)].edges
    middle = 0.5 * (times[1:] + times[:-1])
    inside = (middle > BEGIN + 0.01) & (middle < END - 0.01)
    outside = (middle < BEGIN - 0.01) | (middle > END + 0.01)
    np.testing.assert_allclose(read[inside], (1.0 + GAIN) * clean[inside], rtol=1e-9)
    np.testing.assert_allclose(read[outside], clean[outside], rtol=1e-12)


def test_its_derivatives_are_those_of_differences(model: FaultyModel) -> None:
    """By a parameter of the model, which the sensor shows 30 % more of, and by the gain itself; 1 % for their bend."""
    point = Point(np.zeros(len(model.parameters))).plus(_gain(model), (GAIN, BEGIN, END))
    step = 1e-3
    moved = [replace(point, base=point.base + side * step * np.eye(len(point.base))[0]) for side in (1.0, -1.0)]
    high, low = model.residuals(moved)
    expected = (high - low) / (2.0 * step)
    np.testing.assert_allclose(model.base_jacobian(point)[:, 0], expected, atol=0.01 * np.abs(expected).max())


def test_where_readings_hardly_differ_a_gain_is_an_offset(model: FaultyModel) -> None:
    readings = model.readings[0]
    assert readings.has_gain
    assert not replace(readings, measured=readings.measured + 10.0).has_gain
    assert not replace(readings, unit="K").has_gain
