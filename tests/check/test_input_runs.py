"""Runs with other courses of inputs: of the system that stays loaded, and of a scenario that is built anew."""

from __future__ import annotations

from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.run import RunStopped
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.beside import Compared, compare
from diagnosis.check.input_runs import InputRuns, given_as
from diagnosis.models.systems.run import run_quickly
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

STEP, COUNT = 0.5, 200
#: A tank whose level runs away where more than 1 m^3/s flows in.
TANK = OdeModel(
    "tank",
    {"area": (0.5, "m^2"), "outflow": (0.02, "m^2/s")},
    {"inflow": "m^3/s"},
    {"level": ("m", "0.4", "(inflow - outflow*level)/area + (inflow > 1.0 ? exp(50.0*level) : 0.0)")},
    {"depth": ("m", "level")},
)
SCENARIO = """\
title: A tank
time: {{stop: 100 s, macro_step: 500 ms, output_step: 500 ms}}
components:
  pump: {{kind: programme, outputs: {{inflow: {{unit: m^3/s, constant: 0.01 m^3/s, interpolation: {kind}}}}}}}
  tank: {{kind: fmu, fmu: tank.fmu}}
connections: [pump.inflow -> tank.inflow]
"""


def _compared(folder: Path, kind: str) -> Compared:
    TANK.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO.format(kind=kind), encoding="utf-8")
    rng = np.random.default_rng(4)
    columns = {"t": STEP * np.arange(COUNT), "q": np.repeat(rng.uniform(0.005, 0.03, COUNT // 20), 20)}
    columns["h"] = 0.4 + 0.01 * rng.standard_normal(COUNT)
    inputs, channels = {"pump.inflow": ("q", "m^3/s")}, {"tank.depth": ("h", "m", "1 mm")}
    recording = load_recording(write_recording(folder / "run", columns, inputs, channels))
    return compare(load_scenario(str(folder / "scenario.yaml")), recording)


def _anew(one: Compared, times: Array, values: Array) -> Array:
    """Levels by a scenario that is built with the course."""
    assert one.base is not None
    given = given_as(one.courses[0], times, values)
    results = run_quickly(scenario_of(one.base, replace(one.recording, inputs=(given,))))
    return np.asarray(results["tank.depth"].values)


@pytest.mark.parametrize("kind", ["hold", "linear"])
def test_a_course_does_what_it_does_in_a_scenario_of_its_own(tmp_path: Path, kind: str) -> None:
    one = _compared(tmp_path, kind)
    (course,) = one.courses
    rng = np.random.default_rng(5)
    courses = [
        (np.asarray(course.times) + 7.3, np.asarray(course.values)),  # late, off the grid
        (np.sort(rng.uniform(0.0, 100.0, 300)), rng.uniform(0.0, 0.05, 300)),  # several values in one macro-step
        (np.array([0.0, 40.0]), np.array([0.05, 0.0])),
    ]
    with closing(InputRuns(one)) as runs:
        plain = np.asarray(runs.results(())["tank.depth"].values)
        for times, values in courses:
            found = np.asarray(runs.results([given_as(course, times, values)])["tank.depth"].values)
            np.testing.assert_allclose(found, _anew(one, times, values), rtol=1e-9)
            assert np.max(np.abs(found - plain)) > 0.01
        again = np.asarray(runs.results(())["tank.depth"].values)
    np.testing.assert_array_equal(plain, again)  # nothing of another course stays
    assert one.results is not None
    np.testing.assert_allclose(plain, one.results["tank.depth"].values, rtol=1e-9)


def test_a_course_with_which_it_runs_away_is_said_and_the_next_one_runs(tmp_path: Path) -> None:
    one = _compared(tmp_path, "hold")
    (course,) = one.courses
    with closing(InputRuns(one)) as runs:
        before = np.asarray(runs.results(())["tank.depth"].values)
        with pytest.raises(RunStopped):
            runs.results([given_as(course, np.array([0.0, 10.0]), np.array([0.01, 2.0]))])
        np.testing.assert_array_equal(np.asarray(runs.results(())["tank.depth"].values), before)


def test_closing_twice_is_safe(tmp_path: Path) -> None:
    runs = InputRuns(_compared(tmp_path, "hold"))
    runs.results(())
    runs.close()
    runs.close()
