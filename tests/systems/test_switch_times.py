"""A heater whose thermostat switches whenever it likes, in a table with a row each two minutes."""

from __future__ import annotations

import itertools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cosim.cli import app
from cosim.loading import load_scenario
from cosim.scenario import Scenario
from diagnosis.faults.programme import with_changes
from diagnosis.models.build import models_of, with_switch_times
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from diagnosis.search.switch_times import MOST, Switch, switch_times
from evaluation.fmus.model import OdeModel

from .rigs import write_recording

HUT = OdeModel(
    "hut",
    {"C": (9e4, "J/K"), "G": (110.0, "W/K")},
    {"power": "W"},
    {"T": ("K", "283.15", "(power - G*(T - 283.15))/C")},
    {"air": ("K", "T")},
)
ROW, COUNT = 120.0, 240
SCENARIO = """
title: A hut
time: {stop: 28800 s, macro_step: 60 s, output_step: 60 s}
components:
  stove: {kind: programme, outputs: {heating: {unit: kW, constant: 0 kW}}}
  hut: {kind: fmu, fmu: hut.fmu, integrator: cvode}
connections: [stove.heating -> hut.power]
"""


def record(
    folder: Path,
    seed: int,
    changes: int = 10,
    is_between: bool = True,
    square: float = 0.0,
    noise: float = 0.05,
) -> np.ndarray:
    """Readings by the closed form between the instants at which the heating changes; the instants [s].

    Args:
        folder: Of the recording.
        seed: Of instants, powers and noise.
        changes: How often the heating changes.
        is_between: Whether it changes between rows of the table.
        square: What the stove gives beside its power, per power squared [1/W].
        noise: Deviation of the readings; 0.05 K is stated [K].
    """
    rng = np.random.default_rng(seed)
    capacity, conductance = 9.4e4, 105.0
    instants = np.sort(rng.uniform(600.0, 28000.0, changes))
    if not is_between:
        instants = ROW * np.round(instants / ROW)
    powers = np.concatenate([[0.0], rng.uniform(200.0, 3000.0, changes).round()])
    times = ROW * np.arange(COUNT)
    every = np.unique(np.concatenate([times, instants]))
    course, value = {0.0: 283.15}, 283.15
    heats = powers + square * powers**2
    for begin, end in itertools.pairwise(every):
        rest = 283.15 + heats[np.searchsorted(instants, begin, side="right")] / conductance
        value = rest + (value - rest) * np.exp(-conductance / capacity * (end - begin))
        course[float(end)] = value
    logged = powers[np.searchsorted(instants, times, side="right")]
    air = np.array([course[float(t)] for t in times]) - 273.15 + noise * rng.standard_normal(COUNT)
    columns = {"t": times, "P": 1e-3 * logged, "T": air}
    write_recording(folder, columns, {"stove.heating": ("P", "kW")}, {"hut.air": ("T", "degC", "0.05 K")})
    return instants


@pytest.fixture
def hut(tmp_path: Path) -> Scenario:
    HUT.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO)
    return load_scenario(tmp_path / "scenario.yaml")


def test_heating_that_changes_between_rows_is_no_fault_of_the_model(hut: Scenario, tmp_path: Path) -> None:
    """2 kW a minute too late are 1.3 K; "the readings reject the model", and once a dead time, were the answers."""
    for n, name in enumerate(("first", "second", "third")):
        record(tmp_path / name, n)
    asked = ["diagnose", str(tmp_path / "scenario.yaml"), "--brief", "--out", str(tmp_path / "answer")]
    asked += ["--recording", str(tmp_path / "first"), "--recording", str(tmp_path / "second")]
    done = CliRunner().invoke(app, [*asked, "--held-out", str(tmp_path / "third")])
    assert done.exit_code == 0, done.output
    answer = json.loads((tmp_path / "answer" / "diagnosis.json").read_text())
    assert answer["verdict"] == "recalibrated", done.output
    assert answer["findings"] == []
    assert "of recorded inputs between two rows of their table" in " ".join(answer["notes"])
    assert not any("change of" in m["name"] for m in answer["recalibration"])  # said once, not one by one


def test_instants_are_found_where_the_readings_show_them(hut: Scenario, tmp_path: Path) -> None:
    """Of ten changes those of 1 kW and more, to a few seconds of the true instant."""
    instants = record(tmp_path / "first", 3)
    recording = load_recording(tmp_path / "first")
    model, _ = models_of(hut, [recording], [], [])

    found = fit(model, Point(np.zeros(len(model.parameters))))
    rows = switch_times([scenario_of(hut, recording)], [recording])
    values = {p.name: p.deviation * z for p, z in zip(model.parameters, found.point.base)}
    large = [(f, f.switch) for f in rows if isinstance(f.switch, Switch) and abs(f.switch.change) > 1.0]
    assert len(large) >= 3
    for free, switch in large:
        told = switch.time - values[free.parameter.name]
        assert np.min(np.abs(instants - told)) < 12.0


def test_changes_that_come_with_their_rows_stay_there(hut: Scenario, tmp_path: Path) -> None:
    """Free instants would double the error of what is held out where every change is where its row says."""
    record(tmp_path / "rows", 7, is_between=False)
    record(tmp_path / "between", 7)
    rows, between = (models_of(hut, [load_recording(tmp_path / n)], [], [])[0] for n in ("rows", "between"))
    assert not any(p.is_within_row for p in rows.parameters)
    assert sum(p.is_within_row for p in between.parameters) >= 5


def test_a_change_that_comes_earlier_adds_what_it_gives_in_that_time(hut: Scenario, tmp_path: Path) -> None:
    record(tmp_path / "first", 4)
    scenario = scenario_of(hut, load_recording(tmp_path / "first"))
    given = scenario.components["stove"].outputs["heating"]
    time, value = given.points[2]
    change = value.to("kW") - given.points[1][1].to("kW")
    for earlier in (45.0, -45.0):
        moved = with_changes(given, [Switch(time.to("s"), change).moved(earlier)], scenario)

        def energy(output, stop=28800.0):
            times = np.array([t.to("s") for t, _ in output.points])
            return float(np.sum([v.to("kW") for _, v in output.points] * np.diff(np.append(times, stop))))

        assert energy(moved) - energy(given) == pytest.approx(earlier * change, rel=1e-9)


def test_a_noise_that_is_stated_too_small_hides_no_instants(hut: Scenario, tmp_path: Path) -> None:
    """What noise does not explain is mostly noise then: what is left beside instants is white, whatever its size."""
    for n, name in enumerate(("first", "second", "third")):
        record(tmp_path / name, n, noise=0.25)
    recordings = [load_recording(tmp_path / name) for name in ("first", "second", "third")]
    assert ClosedLoopModel(hut, recordings).has_instants
    for n, name in enumerate(("one", "two", "three")):
        record(tmp_path / name, n, is_between=False, noise=0.25)
    recordings = [load_recording(tmp_path / name) for name in ("one", "two", "three")]
    assert not ClosedLoopModel(hut, recordings).has_instants


def test_forty_changes_in_rows_that_mostly_hold_have_instants(hut: Scenario, tmp_path: Path) -> None:
    """A share of the rows tells a course from an input that holds its values, and no count of its changes alone."""
    record(tmp_path / "many", 8, changes=40)
    many = load_recording(tmp_path / "many")
    assert 30 <= len(switch_times([scenario_of(hut, many)], [many])) <= 40
    assert ClosedLoopModel(hut, [many]).has_instants
    (stove,) = many.inputs
    rows = np.concatenate([[True], np.diff(stove.values) != 0.0])
    course = replace(many, inputs=(replace(stove, times=stove.times[rows], values=stove.values[rows]),))
    assert switch_times([scenario_of(hut, course)], [course]) == []


def test_courses_that_change_with_each_row_or_along_lines_have_no_such_instants(hut: Scenario, tmp_path: Path) -> None:
    record(tmp_path / "busy", 5, changes=2 * MOST)
    record(tmp_path / "few", 6, changes=10)
    busy, few = (load_recording(tmp_path / n) for n in ("busy", "few"))
    assert switch_times([scenario_of(hut, busy)], [busy]) == []
    found = switch_times([scenario_of(hut, few)], [few])
    assert 5 <= len(found) <= 10
    assert {f.parameter.deviation for f in found} == {0.5 * ROW}
    text = SCENARIO.replace("constant: 0 kW}", "interpolation: linear, points: [[0 s, 0 kW], [60 s, 0 kW]]}")
    (tmp_path / "line.yaml").write_text(text)
    line = load_scenario(tmp_path / "line.yaml")
    assert switch_times([scenario_of(line, few)], [few]) == []


def test_a_missing_law_is_looked_for_before_instants_are(hut: Scenario, tmp_path: Path) -> None:
    """Twenty free instants take up a bit of anything: they wait until what noise does not explain is mostly theirs."""
    for name, seed in (("one", 11), ("two", 12)):
        record(tmp_path / name, seed, square=-1e-4)
    recordings = [load_recording(tmp_path / name) for name in ("one", "two")]
    model = ClosedLoopModel(hut, recordings)
    assert not model.has_instants
    nothing = Point(np.zeros(len(model.parameters)))
    assert with_switch_times(model, None, {}) is None
    law = next(t for t in model.terms() if t.identifier == "input_square")
    found = fit(model, nothing.plus(law, (law.parameters[0].starts[0],)))
    both = with_switch_times(model, None, found.point.terms)
    assert both is not None
    moved, _ = both
    assert isinstance(moved, ClosedLoopModel)
    assert moved.has_instants
    changes = [p for p in moved.parameters if p.is_within_row]
    assert len(changes) == len(moved.parameters) - len(model.parameters) > 10
    assert with_switch_times(moved, None, found.point.terms) is None  # it has them already


def test_a_fault_of_one_recording_does_not_hide_that_inputs_changed_between_rows(hut: Scenario, tmp_path: Path) -> None:
    """A thermometer that is 8 K off for an hour leaves far more than the rows do: they are asked for beside it."""
    for n, name in enumerate(("first", "second", "third")):
        record(tmp_path / name, n)
    table = (tmp_path / "second" / "data.csv").read_text().splitlines()
    moved = [line.split(",") for line in table]
    column = moved[0].index("T")
    for row in moved[101:131]:
        row[column] = str(float(row[column]) + 8.0)
    (tmp_path / "second" / "data.csv").write_text("\n".join(",".join(row) for row in moved) + "\n")
    recordings = [load_recording(tmp_path / name) for name in ("first", "second")]
    model = ClosedLoopModel(hut, recordings)
    assert not model.has_instants
    asked = ["diagnose", str(tmp_path / "scenario.yaml"), "--brief", "--out", str(tmp_path / "answer")]
    asked += ["--recording", str(tmp_path / "first"), "--recording", str(tmp_path / "second")]
    done = CliRunner().invoke(app, [*asked, "--held-out", str(tmp_path / "third")])
    assert done.exit_code == 0, done.output
    answer = json.loads((tmp_path / "answer" / "diagnosis.json").read_text())
    assert answer["verdict"] == "measurement fault", done.output
    (fault,) = answer["findings"]
    assert fault["effect"] == "sensor_offset_in_interval"
    assert fault["parameters"][0]["value"] == pytest.approx(8.0, abs=0.1)
    assert "of recorded inputs between two rows of their table" in " ".join(answer["notes"])
