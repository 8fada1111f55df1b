"""Recordings that fit their scenario raise no serious doubt; sabotaged ones raise the right one."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cosim.scenario import Scenario, load_scenario
from diagnosis.check import check
from diagnosis.check.check import check_recordings
from diagnosis.check.readings import _least_step, level_shifts
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from tests.check import rig


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("tclab")


def doubts(scenario: Scenario, *folders: Path) -> list[Doubt]:
    return list(check_recordings(scenario, [load_recording(f) for f in folders]))


def serious(scenario: Scenario, *folders: Path) -> list[tuple[str, str]]:
    return [(d.kind, d.subject) for d in doubts(scenario, *folders) if d.is_serious]


@pytest.mark.parametrize("seed", [1, 2])
def test_missing_physics_and_wrong_numbers_are_no_doubt(scenario: Scenario, tmp_path: Path, seed: int) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST, seed))
    b = rig.write(tmp_path / "b", rig.SECOND, rig.readings(rig.SECOND, seed + 10))
    assert doubts(scenario, a, b) == []


def test_programme_of_another_day(scenario: Scenario, tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.SECOND, rig.readings(rig.FIRST))
    b = rig.write(tmp_path / "b", rig.FIRST, rig.readings(rig.SECOND))
    found = [d for d in doubts(scenario, a, b) if d.is_serious]
    assert {(d.kind, d.recording) for d in found} == {("other run", "a"), ("other run", "b")}
    told = next(d for d in found if d.recording == "a").statement
    assert "the programme of `b` explains" in told
    assert "% of the variance of these readings" in told


def test_scenario_s_programme_is_not_what_was_done(scenario: Scenario, tmp_path: Path) -> None:
    pulse = ((0.0, 0.0, 0.0), (60.0, 1.0, 1.0), (150.0, 0.0, 0.0), (300.0, 1.0, 1.0), (350.0, 0.0, 0.0))
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(pulse))
    assert [kind for kind, _ in serious(scenario, a)] == ["programme"]


@pytest.mark.parametrize("highest", [30.0, 40.0, 50.0])
def test_sensors_that_clip_follow_their_programme(scenario: Scenario, tmp_path: Path, highest: float) -> None:
    """They change at fewer instants than it, and nowhere else; their range may be told, and nothing of a programme."""
    steps = ((0, 0, 0), (12, 0, 3.6), (80, 4, 0), (170, 0.8, 3.6), (240, 4, 0), (290, 0, 4), (370, 3.6, 0))
    short = tuple((float(t), float(p), float(q)) for t, p, q in steps)
    values = np.minimum(rig.readings(short), highest)
    assert {kind for kind, _ in serious(scenario, rig.write(tmp_path / "a", short, values))} <= {"range"}


def test_exchanged_columns(scenario: Scenario, tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST)[:, ::-1])
    assert serious(scenario, a) == [("swapped", "coil[1].temperature, coil[2].temperature")]


def test_what_is_exchanged_is_named_with_all_that_leaves_the_same_readings(scenario: Scenario, tmp_path: Path) -> None:
    """Columns, sensors and drives exchanged: the same numbers in the same table, so the same sentence, true of each."""
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST)[:, ::-1])
    (found,) = [d for d in doubts(scenario, a) if d.is_serious]
    assert found.same_as == ("wrong_identity",)
    for what in ("columns in the recording", "sensors on the rig (wrong identity)", "what drives these elements"):
        assert what in found.statement
    assert "no reading of them tells which" in found.statement


def test_alike_driven_channels_cannot_be_told_apart(scenario: Scenario, tmp_path: Path) -> None:
    both = tuple((t, p, p) for t, p, _ in rig.FIRST)
    values = rig.readings(both)
    values[:, 0] = 21.0 + 1.3 * (values[:, 0] - 21.0)  # so they are not equal
    a = rig.write(tmp_path / "a", both, values[:, ::-1])
    assert serious(scenario, a) == []


@pytest.mark.parametrize(
    ("stated", "factor", "offset"),
    [("degC", 1.8, 32.0), ("degC", 1.0, 273.15), ("K", 1.0, 0.0)],
    ids=["degF written", "K written", "degC written"],
)
def test_unit_of_a_column(scenario: Scenario, tmp_path: Path, stated: str, factor: float, offset: float) -> None:
    values = factor * rig.readings(rig.FIRST) + offset
    a = rig.write(tmp_path / "a", rig.FIRST, values, channel={"unit": stated})
    found = [d for d in doubts(scenario, a) if d.is_serious]
    assert {(d.kind, d.subject) for d in found} == {("unit", f"coil[{k}].temperature") for k in (1, 2)}
    right = {32.0: "degF", 273.15: "K", 0.0: "degC"}[offset]
    assert f"as `unit: {right}` they are of its size" in found[0].statement


@pytest.mark.parametrize("excess", [20.0, 31.5, 45.0])
def test_a_rig_that_is_warm_from_before_has_no_other_unit(scenario: Scenario, tmp_path: Path, excess: float) -> None:
    """Numbers of another unit stay off; what was left of the run before is forgotten with the rig's time constant."""
    values = rig.readings(rig.FIRST)
    times = np.linspace(0.0, 1.0, len(values))
    values[:, 1] = 21.0 + 0.9 * (values[:, 1] - 21.0) + excess * np.exp(-times / 0.15)
    found = doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values))
    assert not [d for d in found if d.kind == "unit"]
    assert [d.subject for d in found if d.kind == "start"] == ["coil[2].temperature"]


def test_turned_over(scenario: Scenario, tmp_path: Path) -> None:
    values = rig.readings(rig.FIRST)
    values[:, 0] = 42.0 - values[:, 0]
    assert ("sign", "coil[1].temperature") in serious(scenario, rig.write(tmp_path / "a", rig.FIRST, values))


@pytest.mark.parametrize("late", [-60.0, 130.0])
def test_a_clock_that_is_off(scenario: Scenario, tmp_path: Path, late: float) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST), times=rig.instants() + late)
    (found,) = [d for d in doubts(scenario, a) if d.is_serious]
    assert found.kind == "dead time"
    assert f"{'later' if late > 0 else 'earlier'} than its programme (" in found.statement
    low, high = map(float, re.findall(r"\(([\d.]+) to ([\d.]+) s, 95 %\)", found.statement)[0])
    assert low <= abs(late) <= high
    assert high - low < abs(late)


def test_a_clock_within_its_stated_bound_is_no_doubt(scenario: Scenario, tmp_path: Path) -> None:
    clock = {"column": "time", "zero": 0, "offset_bound": "140 s"}
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST), times=rig.instants() + 130.0, time=clock)
    assert serious(scenario, a) == []


def test_milliseconds_taken_for_seconds(scenario: Scenario, tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST), times=rig.instants() * 1000.0)
    (found,) = [d for d in doubts(scenario, a) if d.is_serious]
    assert (found.kind, found.subject) == ("clock", "time")
    assert "with ms taken for s corrected" in found.statement


def test_readings_of_another_time_than_the_simulated_one(scenario: Scenario, tmp_path: Path) -> None:
    """A clock that was never set back: nothing was compared, and no doubt was told."""
    said = {**rig.programme(rig.FIRST), "time": {"stop": f"{rig.SPAN} s"}}
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST), times=rig.instants() + 1e4, overrides=said)
    found = [d for d in doubts(scenario, a) if d.is_serious]
    assert [(d.kind, d.subject) for d in found] == [("clock", f"coil[{k}].temperature") for k in (1, 2)]
    assert "0 of its readings are within the simulated time: they are from 10000 to 10598 s" in found[0].statement


def test_minutes_stated_as_seconds(scenario: Scenario, tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST), times=rig.instants() / 60.0)
    (found,) = [d for d in doubts(scenario, a) if d.is_serious]
    assert "with min taken for s corrected" in found.statement


@pytest.mark.parametrize("size", [1.0, -3.0])
def test_a_sensor_that_is_off_for_a_while(scenario: Scenario, tmp_path: Path, size: float) -> None:
    values = rig.readings(rig.FIRST)
    values[90:150, 1] += size
    (found,) = [d for d in doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values)) if d.is_serious]
    assert (found.kind, found.subject, found.begin, found.end) == ("sensor", "coil[2].temperature", 180.0, 298.0)


def test_a_step_that_stays_is_a_fault_where_nothing_else_is_as_fast(scenario: Scenario, tmp_path: Path) -> None:
    values = rig.readings(rig.FIRST)
    fastest = np.max(np.abs(np.diff(values[:, 1])))
    values[150:, 1] -= 4.0
    (found,) = [d for d in doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values)) if d.is_serious]
    assert (found.kind, found.subject, found.begin) == ("sensor", "coil[2].temperature", 300.0)
    told = re.search(r"step by -(\S+) K from one reading to the next, (\S+) times as much as anywhere", found.statement)
    assert told is not None
    assert float(told[1]) == pytest.approx(4.0, abs=0.3)
    assert float(told[2]) == pytest.approx(4.0 / fastest, rel=0.15)


def test_a_step_that_stays_is_none_where_the_rig_is_as_fast(scenario: Scenario, tmp_path: Path) -> None:
    """A body that is cooled faster than the model knows: readings that change as much are no fault of a sensor."""
    values = rig.readings(rig.FIRST)
    values[100:, 1] += 2.5 * (1.0 - np.exp(-np.arange(len(values) - 100) / 1.5))  # 1.2 K at once and then on
    values[200:, 1] -= 2.0
    found = [d for d in doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values)) if d.is_serious]
    assert not any("from one reading to the next" in d.statement for d in found)


def test_several_faults_at_once(scenario: Scenario, tmp_path: Path) -> None:
    values = rig.readings(rig.FIRST)
    values[40:70, 0] += 2.0
    values[200:230, 0] -= 2.5
    values[80:110, 1] = values[80, 1]
    found = [d for d in doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values)) if d.is_serious]
    stretches = {(d.subject, d.begin, d.end) for d in found}
    assert stretches == {
        ("coil[1].temperature", 80.0, 138.0),
        ("coil[1].temperature", 400.0, 458.0),
        ("coil[2].temperature", 160.0, 218.0),
    }
    assert "the sensor stood still" in next(d for d in found if "[2]" in d.subject).statement


def test_rounded_readings_at_rest_are_not_stuck(scenario: Scenario, tmp_path: Path) -> None:
    values = np.round(rig.temperatures(rig.FIRST) / 0.5) * 0.5
    a = rig.write(tmp_path / "a", rig.FIRST, values, channel={"noise": "0.15 K", "quantum": "0.5 K"})
    assert serious(scenario, a) == []


def test_wild_reading_and_gap_are_notes(scenario: Scenario, tmp_path: Path) -> None:
    values = rig.readings(rig.FIRST)
    values[100, 0] += 8.0
    values[180:220, 1] = np.nan
    found = doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values))
    assert not any(d.is_serious for d in found)
    texts = {d.subject: d.statement for d in found}
    assert "one reading is far from both neighbours, the farthest at 200 s by 8" in texts["coil[1].temperature"]
    assert "no readings from 358 to 440 s" in texts["coil[2].temperature"]


@pytest.mark.parametrize(("stated", "word"), [("0.008 K", "times more"), ("0.8 K", "times less")])
def test_noise_as_stated(scenario: Scenario, tmp_path: Path, stated: str, word: str) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST), channel={"noise": stated})
    found = [d for d in doubts(scenario, a) if d.kind == "noise"]
    assert {d.subject for d in found} == {"coil[1].temperature", "coil[2].temperature"}
    assert all(word in d.statement and not d.is_serious for d in found)


@pytest.mark.parametrize(("stated", "words"), [(0.008, {"times more"}), (0.8, set())])
def test_noise_of_each_reading_may_hold_what_neighbours_share(
    scenario: Scenario, tmp_path: Path, stated: float, words: set[str]
) -> None:
    """A camera's marker at rest has the same error in all pictures: too little scatter is no doubt, too much is."""
    folder = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST))
    table, sidecar = folder / "data.csv", folder / "recording.yaml"
    lines = table.read_text().splitlines()
    table.write_text("\n".join([f"{lines[0]},own", *(f"{line},{stated}" for line in lines[1:])]) + "\n")
    sidecar.write_text(sidecar.read_text().replace(f"noise: {rig.NOISE} K", "noise_column: own"))
    found = [d.statement for d in doubts(scenario, folder) if d.kind == "noise"]
    assert len(found) == 2 * len(words)
    assert all(word in statement for word in words for statement in found)


def test_start_of_one_coil(scenario: Scenario, tmp_path: Path) -> None:
    values = rig.readings(rig.FIRST)
    values[:, 1] += 3.0
    found = [d for d in doubts(scenario, rig.write(tmp_path / "a", rig.FIRST, values)) if d.kind == "start"]
    assert [(d.subject, d.is_serious) for d in found] == [("coil[2].temperature", False)]
    assert "begins at 24" in found[0].statement
    assert "where 21 degC is simulated" in found[0].statement


def test_a_start_of_another_day_is_far_and_one_within_a_day_is_not(scenario: Scenario, tmp_path: Path) -> None:
    """Of the start 0.3 K are doubted where nothing is stated: 3 K are ten times that, 1.15 K less than four times."""
    for size, is_far in ((3.0, True), (1.15, False)):
        values = rig.readings(rig.FIRST)
        values[:, 1] += size
        (found,) = [
            d for d in doubts(scenario, rig.write(tmp_path / f"{size}", rig.FIRST, values)) if d.kind == "start"
        ]
        assert found.is_far == is_far


def test_a_recording_that_begins_while_the_rig_is_hot_has_no_start_to_compare(
    scenario: Scenario, tmp_path: Path
) -> None:
    """From 200 s on both heaters have been on for long: what the readings begin with is the model's doing."""
    folder = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST))
    text = (folder / "recording.yaml").read_text()
    (folder / "recording.yaml").write_text(text + "begin: 200 s\n")
    assert [d for d in doubts(scenario, folder) if d.kind == "start"] == []


def test_readings_that_stood_still_say_nothing_of_the_programme(
    scenario: Scenario, tmp_path: Path, monkeypatch: Any
) -> None:
    """Where a sensor stands still, switches at other instants describe its readings better than the programme does."""
    values = rig.readings(rig.FIRST)
    values[130:170, 0] = values[130, 0]
    folder = rig.write(tmp_path / "a", rig.FIRST, values)
    title = load_recording(folder).title
    other = Doubt(title, "drive.power_1", "programme", "the readings change elsewhere", "", True, 0.0, 600.0, 99.0)
    monkeypatch.setattr(check, "_relation", lambda one, others: [other])
    assert [d.kind for d in doubts(scenario, folder) if d.is_serious] == ["sensor"]


@pytest.mark.parametrize(("over", "is_step"), [(1, True), (6, False)])
def test_a_course_that_goes_over_within_some_readings_is_no_step(over: int, is_step: bool) -> None:
    """10 deviations, from one reading to the next or within six; 20 drawn noises each."""
    index = np.arange(600.0)
    course = 10.0 * np.clip((index - 299.5) / over + 0.5, 0.0, 1.0)
    found = [
        bool(level_shifts(course + np.random.default_rng(seed).standard_normal(600), 1.0, 400.0)) for seed in range(20)
    ]
    assert all(found) if is_step else not any(found)


def test_order_of_recordings_and_channels_changes_nothing(scenario: Scenario, tmp_path: Path) -> None:
    values = rig.readings(rig.FIRST)
    values[90:150, 1] += 2.0
    a = rig.write(tmp_path / "a", rig.FIRST, values)
    b = rig.write(tmp_path / "b", rig.SECOND, rig.readings(rig.SECOND))
    assert doubts(scenario, a, b) == doubts(scenario, b, a)


def test_results_that_are_known_are_not_simulated_again(scenario: Scenario, tmp_path: Path, monkeypatch: Any) -> None:
    from cosim.run import run
    from diagnosis.check import beside
    from diagnosis.recording.conditions import scenario_of

    recording = load_recording(rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST)))
    results = run(scenario_of(scenario, recording))
    monkeypatch.setattr(beside, "run_quickly", None)
    assert check_recordings(scenario, [recording], {str(recording.path): results}) == ()


def test_one_wild_reading_is_no_step() -> None:
    """The reading next to a step moves the end of its line by 1 / 12 + 6 * 5.5 / 143 of its own size."""
    window = np.zeros(24)
    window[12] = -6.5
    line = np.polyval(np.polyfit(np.arange(12) + 0.5, window[12:], 1), 0.0)
    assert line == pytest.approx(-6.5 * (1.0 / 12.0 + 6.0 * 5.5 / 143.0))
    assert _least_step(window) == pytest.approx(0.0, abs=1e-9)
    stepped = np.where(np.arange(24) < 12, 0.0, 9.0)
    assert _least_step(stepped) == pytest.approx(9.0)


@pytest.mark.parametrize(
    ("places", "is_step"), [(slice(-2, None), False), (slice(0, 2), False), (slice(-30, None), True)]
)
def test_two_wild_readings_at_an_end_are_no_step_that_stays(
    scenario: Scenario, tmp_path: Path, places: slice, is_step: bool
) -> None:
    readings = rig.readings(rig.FIRST).copy()
    readings[places, 0] -= 6.0
    a = rig.write(tmp_path / "a", rig.FIRST, readings)
    told = [d for d in doubts(scenario, a) if d.kind == "sensor" and "step" in d.statement]
    assert bool(told) is is_step


def test_a_rig_that_is_driven_from_the_begin_has_moved_before_three_readings(
    scenario: Scenario, tmp_path: Path
) -> None:
    """Full power from 0 s on, and a heat capacity that is 40 % off: the third reading is no other start."""
    points = ((0.0, 3.0, 0.0), (300.0, 0.0, 0.5))
    times = np.arange(0.0, rig.SPAN, 0.1)
    starts, power = np.array([0.0, 300.0]), np.array([[3.0, 0.0], [0.0, 0.5]])
    body = np.full((len(times), 2), 21.0)
    for n in range(len(times) - 1):
        given = power[np.searchsorted(starts, times[n], side="right") - 1]
        body[n + 1] = body[n] + 0.1 * (given - 0.012 * (body[n] - 21.0)) / 1.4
    values = body[::20] + rig.NOISE * np.random.default_rng(4).standard_normal((len(times[::20]), 2))
    found = doubts(scenario, rig.write(tmp_path / "a", points, values))
    assert [d for d in found if d.kind == "start"] == []
