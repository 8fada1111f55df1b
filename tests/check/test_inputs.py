"""Recorded inputs beside the programme: off for a stretch, shifted, scaled, of another run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import Scenario, load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.beside import compare
from diagnosis.check.check import check_recordings
from diagnosis.check.input_doubts import how
from diagnosis.check.inputs import compare_inputs, set_beside
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import of_another_experiment
from diagnosis.recording.recording import load_recording
from tests.check import rig


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("tclab")


def course(points: Sequence[Sequence[float]], late: float = 0.0) -> Array:
    """Power of both heaters at the readings [W], shape (samples, 2)."""
    starts = np.array([p[0] for p in points])
    last = np.searchsorted(starts, rig.instants() - late + 1e-9, side="right") - 1
    return np.asarray(np.array([p[1:] for p in points])[np.maximum(last, 0)])


def with_column(folder: Path, stated: Sequence[Sequence[float]], column: Array, readings: Array) -> Path:
    """A recording that states a programme and has columns of both inputs."""
    inputs = {f"drive.power_{k}": {"column": f"Q{k}", "unit": "W", "table": "q.csv"} for k in (1, 2)}
    rig.write(folder, stated, readings, inputs=inputs)
    data = {"time": rig.instants(), "Q1": column[:, 0], "Q2": column[:, 1]}
    pd.DataFrame(data).to_csv(folder / "q.csv", index=False)
    return folder


def doubts(scenario: Scenario, folder: Path) -> list[Doubt]:
    return list(check_recordings(scenario, [load_recording(folder)]))


def test_a_column_that_is_the_programme_is_no_doubt(scenario: Scenario, tmp_path: Path) -> None:
    a = with_column(tmp_path / "a", rig.FIRST, course(rig.FIRST), rig.readings(rig.FIRST))
    assert doubts(scenario, a) == []


def test_a_noisy_column_of_the_programme_is_no_doubt(scenario: Scenario, tmp_path: Path) -> None:
    column = course(rig.FIRST) + 0.01 * np.random.default_rng(3).standard_normal((300, 2))
    a = with_column(tmp_path / "a", rig.FIRST, column, rig.readings(rig.FIRST))
    assert doubts(scenario, a) == []


def test_off_for_a_stretch_in_the_column_alone(scenario: Scenario, tmp_path: Path) -> None:
    """The wire of the meter slipped off: the rig was heated, and its readings follow the programme."""
    column = course(rig.FIRST)
    column[40:110, 0] = 0.0
    column[150:200, 1] = 0.0
    a = with_column(tmp_path / "a", rig.FIRST, column, rig.readings(rig.FIRST))
    found = {d.subject: d for d in doubts(scenario, a)}
    assert {(d.kind, d.is_serious) for d in found.values()} == {("input", True)}
    one = found["drive.power_1"]
    assert one.stretches[0] == pytest.approx((80.0, 220.0), abs=1.0)
    assert "the recorded input is 0 from 80 to 220" in one.statement
    assert "the simulation uses the recorded one; but the readings follow the programme" in one.statement


def test_off_for_a_stretch_as_it_was(scenario: Scenario, tmp_path: Path) -> None:
    """The supply failed: the column tells it, the readings follow it, and the simulation uses it."""
    later = ((150.0, 1.0, 0.6), (250.0, 0.1, 0.6), (430.0, 0.8, 0.0))
    stated = ((0.0, 0.0, 0.0), (10.0, 1.0, 0.0), *later)
    done = (*stated[:2], (80.0, 0.0, 0.0), *later)
    a = with_column(tmp_path / "a", stated, course(done), rig.readings(done))
    (found,) = doubts(scenario, a)
    assert (found.kind, found.subject, found.is_serious) == ("input", "drive.power_1", False)
    assert "the readings follow the recorded one" in found.statement


@pytest.mark.parametrize("late", [40.0, -30.0])
def test_shifted_column(scenario: Scenario, tmp_path: Path, late: float) -> None:
    points = ((0.0, 0.0, 0.0), *((t + 50.0, a, b) for t, a, b in rig.FIRST[1:]))
    a = with_column(tmp_path / "a", points, course(points, late), rig.readings(points))
    found = [d for d in doubts(scenario, a) if d.kind == "input"]
    assert {d.subject for d in found} == {"drive.power_1", "drive.power_2"}
    assert all(d.is_serious for d in found)
    for one in compare_inputs(compare(scenario, load_recording(a))):
        assert one.kind == "shifted"
        assert one.shift == pytest.approx(late, abs=rig.STEP)
        assert how(one).endswith("later" if late > 0 else "earlier")


def test_scaled_column(scenario: Scenario, tmp_path: Path) -> None:
    a = with_column(tmp_path / "a", rig.FIRST, 0.5 * course(rig.FIRST), rig.readings(rig.FIRST))
    found = doubts(scenario, a)
    assert [d.is_serious for d in found if d.kind == "input"] == [False, False]
    assert "is 0.5 times as high" in found[0].statement
    assert "the readings do not tell which was applied" in found[0].statement


def test_column_of_another_run(scenario: Scenario, tmp_path: Path) -> None:
    a = with_column(tmp_path / "a", rig.FIRST, course(rig.SECOND), rig.readings(rig.FIRST))
    found = [d for d in doubts(scenario, a) if d.is_serious]
    assert {d.subject for d in found} == {"drive.power_1", "drive.power_2"}
    assert of_another_experiment(found)


def test_the_scenario_s_own_programme_is_an_example(scenario: Scenario, tmp_path: Path) -> None:
    """Where a recording has a column and states no programme, the scenario's is no statement about it."""
    a = with_column(tmp_path / "a", rig.SECOND, course(rig.SECOND), rig.readings(rig.SECOND))
    text = (a / "recording.yaml").read_text()
    begin, end = text.index("overrides:"), text.index("uncertain:")
    (a / "recording.yaml").write_text(text[:begin] + text[end:])
    assert doubts(scenario, a) == []
    compared = compare_inputs(compare(scenario, load_recording(a)))
    assert [(c.kind, c.is_stated, c.used) for c in compared] == [("other", False, "recorded")] * 2
    assert how(compared[0]).startswith("has another course")


def test_drops_of_a_moment_that_the_readings_hardly_show_accuse_nobody(scenario: Scenario, tmp_path: Path) -> None:
    """A logger misses four readings of a supply which was on: a slow rig does not tell, and its model errs by more."""
    column = course(rig.FIRST)
    column[[30, 60, 90, 200]] = 0.0
    a = with_column(tmp_path / "a", rig.FIRST, column, rig.readings(rig.FIRST))
    found = [d for d in doubts(scenario, a) if d.subject.startswith("drive.")]
    assert not any(d.is_serious for d in found)
    assert not any("the readings follow" in d.statement for d in found)


@pytest.mark.parametrize(("unit", "constant"), [("A", 0.0), ("W", 800.0), ("K", 278.15)])
def test_a_course_is_not_that_of_a_programme_that_stays(unit: str, constant: float) -> None:
    levels = np.random.default_rng(5).uniform(0.0, 2500.0, 17)
    if unit == "K":
        levels = 278.15 + 4.0 * np.sin(np.arange(17.0))
    elif unit == "A":
        levels = np.random.default_rng(5).uniform(-1.0, 3.0, 17)

    def recorded(at: Array) -> Array:
        return np.asarray(levels[np.minimum((at / 100.0).astype(int), 16)])

    def stays(at: Array) -> Array:
        return np.full(len(at), constant)

    found = set_beside("a", "drive", unit, (recorded, stays), (0.0, 1700.0), 4.0, False)
    assert found.kind == "other"
    assert sum(end - begin for begin, end in found.stretches) > 0.8 * 1700.0


def test_a_course_that_is_the_programme_but_for_a_moment_agrees() -> None:
    """It was told as "1 times as high": a factor of 1 explains as much as the programme itself."""

    def stated(at: Array) -> Array:
        return np.where(at < 50.0, 2.0, 4.0)

    def recorded(at: Array) -> Array:
        return np.where((at > 80.0) & (at < 81.5), 3.0, stated(at))

    found = set_beside("a", "drive", "V", (recorded, stated), (0.0, 100.0), 0.1, True)
    assert 0.0 < found.share < 0.02
    assert (found.kind, how(found)) == ("equal", "agrees")
    twice = set_beside("a", "drive", "V", (lambda at: 2.0 * stated(at), stated), (0.0, 100.0), 0.1, True)
    assert how(twice) == "is 2 times as high"
