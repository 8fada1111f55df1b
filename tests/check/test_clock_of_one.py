"""A clock that is off in one recording alone, and rigs that only seem to have one."""

from __future__ import annotations

import re
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from diagnosis import diagnose as asked
from diagnosis.candidates.registry import catalogue
from diagnosis.check import clock_of_one
from diagnosis.check.beside import Compared, compare
from diagnosis.check.check import check_recordings
from diagnosis.check.clock_of_one import clocks_of_one
from diagnosis.clocks import clocks_once_recalibrated
from diagnosis.diagnose import Options
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.judge.headline import headline
from diagnosis.models.build import models_of
from diagnosis.recording.recording import load_recording
from diagnosis.refitted import Refitted
from tests.systems.rigs import COUNT, STEP, oscillator, oscillator_recordings

SIZES = (0.4, 0.5, 0.45)


def _compared(folder: Path, recordings: list[Path]) -> list[Compared]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return [compare(scenario, load_recording(r)) for r in recordings]


def _doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return clocks_of_one(_compared(folder, recordings))


def _own_table(recording: Path, fast: float, late: float, since: float = 0.0) -> None:
    """The channel in a table of its own, whose clock runs so much too fast and is ahead by so much from then on [s]."""
    about = yaml.safe_load((recording / "recording.yaml").read_text(encoding="utf-8"))
    table = pd.read_csv(recording / "data.csv")
    channel = about["channels"]["rig.position"]
    ahead = late * (table["t"] >= since)
    own = pd.DataFrame({"t": (1.0 + fast) * table["t"] + ahead, channel["column"]: table.pop(channel["column"])})
    own = own[own["t"] > own["t"].cummax().shift(fill_value=-1.0)]  # nothing is written twice where it is set back
    own.to_csv(recording / "own.csv", index=False)
    table.to_csv(recording / "data.csv", index=False)
    channel |= {"table": "own.csv", "time": {"column": "t", "unit": "s", "zero": 0.0}}
    (recording / "recording.yaml").write_text(yaml.safe_dump(about, sort_keys=False), encoding="utf-8")


@pytest.mark.parametrize(
    ("fast", "late", "words"),
    [(0.02, 0.0, "fast"), (-0.015, 0.01, "slow"), (0.0, 0.05, "ahead"), (0.0, -0.05, "behind")],
)
def test_the_recording_whose_clock_is_off_is_named_with_how_far(
    fast: float, late: float, words: str, tmp_path: Path
) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _own_table(recordings[1], fast, late)
    (told,) = _doubts(tmp_path, recordings)
    assert told.recording == "run_2"
    assert told.is_serious
    assert words in told.statement
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    every = check_recordings(scenario, [load_recording(r) for r in recordings])
    assert {d.recording for d in every if d.is_serious} == {"run_2"}
    if fast:
        low, high = (float(v) / 100.0 for v in re.findall(r"([\d.]+) to ([\d.]+) %", told.statement)[0])
        assert low <= abs(fast) <= high
        assert high - low < 0.2 * abs(fast)
    else:
        assert float(re.findall(r"is ([\d.]+) s", told.statement)[0]) == pytest.approx(abs(late), rel=0.05)


@pytest.mark.parametrize(("late", "words"), [(0.08, "late: the clock was set forward"), (-0.04, "early: the clock")])
def test_a_clock_that_jumps_does_not_run_wrong(late: float, words: str, tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    at = 0.55 * COUNT * STEP
    _own_table(recordings[1], 0.0, late, at)
    (told,) = _doubts(tmp_path, recordings)
    assert (told.recording, told.kind) == ("run_2", "clock")
    found = re.search(
        rf"from about ([\d.]+) s on the readings are written about ([\d.]+) s too {words}", told.statement
    )
    assert found is not None, told.statement
    assert float(found[1]) == pytest.approx(at, abs=0.3)
    assert float(found[2]) == pytest.approx(abs(late), rel=0.1)
    assert "%" not in told.statement.split("but", 1)[1].replace(found[0], "").split("if")[1]


def test_where_the_best_clock_is_the_stated_one_no_jump_is_looked_for(tmp_path: Path) -> None:
    """As of a sensor with the opposite sign: no clock makes it better."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    beside = _compared(tmp_path, recordings)[1].channels["rig.position"]
    nothing = clock_of_one._Clock(0.0, 0.0, 1e-6, 4.0, 1.0, 1.0)
    assert clock_of_one._jumped(beside, nothing, 1.0) is None


def test_of_two_recordings_none_is_named_and_of_good_ones_none(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    assert _doubts(tmp_path, recordings) == []
    _own_table(recordings[1], 0.02, 0.0)
    assert _doubts(tmp_path, recordings[:2]) == []


def _lightly_damped(folder: Path) -> None:
    path = oscillator(folder)
    text = path.read_text(encoding="utf-8").replace("cvode}", "cvode, parameters: {c: 0.3 1/s}}")
    path.write_text(text, encoding="utf-8")


def test_a_resonance_that_moves_with_its_amplitude_is_no_clock(tmp_path: Path) -> None:
    """A spring that softens: the recording that is driven hardest runs 1.3 % slow, all of it, and no other."""
    _lightly_damped(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 3.75 * v - 4.0 * x - 0.4 * x**3, (0.15, 0.2, 1.2))
    assert _doubts(tmp_path, recordings) == []


def test_a_number_that_is_off_in_all_recordings_is_no_clock_of_the_longest(tmp_path: Path) -> None:
    """A frequency that is a little off: what short recordings hardly show, a long one does."""
    _lightly_damped(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 3.75 * v - 16.0 * x, (0.4, 0.5, 0.1))
    for short in recordings[:2]:
        table = pd.read_csv(short / "data.csv")
        assert len(table) == COUNT
        table[table["t"] < 0.2 * COUNT * STEP].to_csv(short / "data.csv", index=False)
    assert _doubts(tmp_path, recordings) == []


def test_a_recording_that_is_driven_harder_is_named_only_where_another_of_its_channels_is_met(tmp_path: Path) -> None:
    """A resonance that moves with its amplitude would move the other channel too."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, (0.4, 0.5, 1.2))
    _own_table(recordings[2], 0.02, 0.0)
    every = _compared(tmp_path, recordings)
    assert clocks_of_one(every) == []
    hard = every[2].channels["rig.position"]
    met = replace(hard, channel=replace(hard.channel, values=hard.at(hard.channel.times)))
    every[2] = replace(every[2], channels={**every[2].channels, "rig.other": met})
    (told,) = clocks_of_one(every)
    assert (told.recording, told.subject) == ("run_3", "rig.position")
    late = replace(hard, channel=replace(hard.channel, values=hard.at(1.02 * hard.channel.times)))
    every[2] = replace(every[2], channels={**every[2].channels, "rig.other": late})
    assert clocks_of_one(every) == []  # both are off: it may be the rig


def test_a_shift_within_a_row_of_an_input_is_no_clock(tmp_path: Path) -> None:
    """An input is logged each 0.1 s and held: it changed within the row before, so 0.05 s say nothing."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _own_table(recordings[1], 0.0, 0.05)
    every = _compared(tmp_path, recordings)
    assert [d.recording for d in clocks_of_one(every)] == ["run_2"]
    (course,) = every[1].courses
    assert course.is_recorded
    coarse = replace(course, times=course.times[::20], values=course.values[::20])
    assert clocks_of_one([every[0], replace(every[1], courses=(coarse,)), every[2]]) == []
    joined = replace(coarse, is_linear=True)  # straight lines join its rows: they say when it changed
    assert len(clocks_of_one([every[0], replace(every[1], courses=(joined,)), every[2]])) == 1


@pytest.mark.parametrize(("fast", "late", "count"), [(0.02, 0.0, 1), (0.0, 0.06, 0)], ids=["drift", "shift"])
def test_a_clock_that_is_stated_to_be_off_by_0_1_s_may_be_so_and_may_not_drift(
    fast: float, late: float, count: int, tmp_path: Path
) -> None:
    """2 % of 4 s are 80 ms, within what is stated; no constant shift explains them."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _own_table(recordings[1], fast, late)
    every = _compared(tmp_path, recordings)
    beside = every[1].channels["rig.position"]
    stated = replace(beside, channel=replace(beside.channel, offset_bound=0.1))
    every[1] = replace(every[1], channels={"rig.position": stated})
    assert len(clocks_of_one(every)) == count


@pytest.mark.parametrize(("changes", "count"), [(3, 0), (4, 1)])
def test_a_drift_beside_a_few_changes_of_a_held_input_may_be_its_rows(changes: int, count: int, tmp_path: Path) -> None:
    """Each change was somewhere within a row: a straight line follows two or three of them by chance."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _own_table(recordings[1], 0.02, 0.0)
    every = _compared(tmp_path, recordings)
    (course,) = every[1].courses
    rows = course.times[::20]
    few = np.searchsorted(rows[-1] * np.arange(1, changes + 1) / (changes + 1.0), rows)
    coarse = replace(course, times=rows, values=few.astype(float))
    found = clocks_of_one([every[0], replace(every[1], courses=(coarse,)), every[2]])
    assert len(found) == count


def test_readings_at_switches_are_no_clock(tmp_path: Path) -> None:
    """An output that follows its input at once: two readings of one recording are of the other side of a switch."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    every = _compared(tmp_path, recordings)
    beside = every[1].channels["rig.position"]
    assert beside.simulated is not None
    steps = np.sign(np.sin(4.0 * beside.simulated.times))
    moved = []
    for number, one in enumerate(every):
        own = one.channels["rig.position"]
        assert own.simulated is not None
        series = replace(own.simulated, values=steps)
        values = np.sign(np.sin(4.0 * own.channel.times))
        if number == 1:
            values[np.flatnonzero(np.diff(values))[[0, -1]] + 1] *= -1.0
        channel = replace(own.channel, values=values)
        moved.append(replace(one, channels={"rig.position": replace(own, channel=channel, simulated=series)}))
    assert clocks_of_one(moved) == []


def _once_recalibrated(folder: Path, recordings: list[Path], held_out: int = 1) -> list[Doubt]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    every = [compare(scenario, load_recording(r)) for r in recordings]
    read = [one.recording for one in every]
    model, judge = models_of(scenario, read[:-held_out], read[-held_out:], catalogue())
    return clocks_once_recalibrated(Refitted(model, judge, every))


@pytest.mark.parametrize("order", [(0, 1, 2), (0, 2, 1)], ids=["fitted", "held out"])
def test_numbers_that_are_off_hide_no_clock(order: tuple[int, ...], tmp_path: Path) -> None:
    """A spring 6 % stiffer than stated moves every recording by more than a clock that runs 0.6 % fast."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -24.0 * x, SIZES)
    _own_table(recordings[1], 0.006, 0.0)
    assert _doubts(tmp_path, recordings) == []
    (told,) = _once_recalibrated(tmp_path, [recordings[n] for n in order])
    assert told.recording == "run_2"
    assert "the scenario with its numbers fitted" in told.statement
    low, high = (float(v) for v in re.findall(r"([\d.]+) to ([\d.]+) %", told.statement)[0])
    assert low <= 0.6 <= high


def test_what_moves_freely_has_a_clock_beside_motions_of_its_size_alone(tmp_path: Path) -> None:
    """A tilt or a spring that is not linear makes each size of a free swing faster or slower by another share."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    (own,) = _compared(tmp_path, recordings[1:2])
    _own_table(recordings[1], 0.02, 0.0)
    free = [replace(one, courses=()) for one in _compared(tmp_path, recordings)]
    assert clocks_of_one(free) == []
    titles = [replace(own, courses=(), recording=replace(own.recording, title=title)) for title in ("a", "b")]
    (told,) = clocks_of_one([*titles, free[1]])
    assert (told.recording, told.kind) == ("run_2", "clock")


def test_a_held_out_recording_stands_beside_recordings_that_were_not_fitted_either(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A law that is missing is spread over the recordings that are fitted, and not over the one that is held out."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -24.0 * x - 60.0 * x**3, (0.5, 0.45, 0.48))
    left: list[dict[str, float]] = []

    def asked(every: list[Compared], simulated: str) -> list[Doubt]:
        channels = {one.recording.title: one.channels["rig.position"] for one in every}
        left.append({title: float(np.mean((b.measured - b.simulated_there) ** 2)) for title, b in channels.items()})
        doubt = Doubt("run_3", "rig.position", "clock", "runs fast", "set it", True, 0.0, 4.0, 9.0)
        return [doubt] if len(left) == 1 else []

    monkeypatch.setattr("diagnosis.clocks.clocks_of_one", asked)
    assert _once_recalibrated(tmp_path, recordings) == []
    fitted, foreseen = left[0], left[-1]
    assert foreseen["run_3"] == fitted["run_3"]
    assert foreseen["run_1"] > 1.2 * fitted["run_1"]
    assert foreseen["run_2"] > 1.2 * fitted["run_2"]


@pytest.mark.parametrize("fast", [0.02, -0.015])
def test_a_clock_that_bends_the_fitted_numbers_is_told_by_those_of_the_others(fast: float, tmp_path: Path) -> None:
    """Fitted to both recordings the spring takes a part of the clock: its interval would not hold the true rate."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -24.0 * x, SIZES)
    _own_table(recordings[1], fast, 0.0)
    (told,) = _once_recalibrated(tmp_path, recordings)
    assert told.recording == "run_2"
    low, high = (float(v) / 100.0 for v in re.findall(r"([\d.]+) to ([\d.]+) %", told.statement)[0])
    assert low <= abs(fast) <= high
    assert high - low < 0.2 * abs(fast)


def test_once_recalibrated_good_recordings_have_good_clocks_and_two_are_not_asked(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -24.0 * x, SIZES)
    assert _once_recalibrated(tmp_path, recordings) == []
    _own_table(recordings[1], 0.02, 0.0)
    assert _once_recalibrated(tmp_path, recordings[:2]) == []


def test_a_law_that_shows_in_the_recording_that_is_driven_hardest_is_no_clock(tmp_path: Path) -> None:
    _lightly_damped(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 3.75 * v - 4.0 * x - 0.4 * x**3, (0.15, 0.2, 1.2))
    assert _once_recalibrated(tmp_path, recordings) == []


def _behind_a_lag(recording: Path, lag: float) -> None:
    """The readings of a recording behind a first-order lag [s], at equal steps, from rest."""
    table = pd.read_csv(recording / "data.csv")
    found, share = [float(table["x"][0])], 1.0 - np.exp(-STEP / lag)
    for value in table["x"][1:]:
        found.append(found[-1] + share * (float(value) - found[-1]))
    table["x"] = np.array(found) + 1e-3 * np.random.default_rng(9).standard_normal(COUNT)
    table.to_csv(recording / "data.csv", index=False)


@pytest.mark.parametrize("lag", [0.03, 0.06, 0.2])
def test_a_sensor_that_is_slower_in_one_recording_is_no_clock(lag: float, tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _behind_a_lag(recordings[1], lag)
    (told,) = _doubts(tmp_path, recordings)
    assert (told.recording, told.subject, told.kind) == ("run_2", "rig.position", "sensor")
    assert told.is_serious
    (found,) = re.findall(r"behind a lag of ([\d.]+) s: the sensor answered more slowly", told.statement)
    assert float(found) == pytest.approx(lag, rel=0.1)


def test_of_few_readings_neither_a_clock_nor_a_lag_is_claimed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both stand in one sentence, and in the headline neither."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _own_table(recordings[1], 0.0, 0.03)
    monkeypatch.setattr(clock_of_one, "APART", 1e9)
    (told,) = _doubts(tmp_path, recordings)
    assert told.kind == "late"
    assert "cannot be told apart" in told.statement
    assert "with a clock that is 0.03" in told.statement
    assert headline(Verdict.RECORDING_FAULT, (), None, doubts=[told]).startswith("Readings come later than the")


@pytest.mark.parametrize("has_speed", [True, False], ids=["another channel is met", "alone"])
def test_rows_that_were_written_late_explain_no_channel_that_is_late_alone(
    has_speed: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A row of an input may be late by its length; then all that follows the input is."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    for recording in recordings:
        table = pd.read_csv(recording / "data.csv")
        noise = 0.02 * np.random.default_rng(7).standard_normal(COUNT)
        table["v"] = np.gradient(table["x"].rolling(5, center=True, min_periods=1).mean(), STEP) + noise
        if has_speed:
            table.to_csv(recording / "data.csv", index=False)
            about = yaml.safe_load((recording / "recording.yaml").read_text(encoding="utf-8"))
            about["channels"]["rig.speed"] = {"column": "v", "unit": "m/s", "noise": "50 mm/s"}
            (recording / "recording.yaml").write_text(yaml.safe_dump(about, sort_keys=False), encoding="utf-8")
    _own_table(recordings[1], 0.0, 0.05)
    monkeypatch.setattr(clock_of_one, "_row", lambda one: 1.0)
    told = _doubts(tmp_path, recordings)
    assert [(d.recording, d.subject, d.kind) for d in told] == ([("run_2", "rig.position", "clock")] * has_speed)


def test_a_doubt_that_is_seen_twice_is_told_once_beside_the_fitted_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    first = Doubt("run_2", "rig.position", "sensor", "behind a lag of 0.05 s", "leave it out", True, 0.0, 4.0, 9.0)
    again, other = replace(first, statement="behind a lag of 0.06 s"), replace(first, subject="rig.speed")
    monkeypatch.setattr(asked, "clocks_once_recalibrated", lambda *given: [again])
    assert asked._doubts((first, other), (), None, None, Options()) == (again, other)  # type: ignore[arg-type]


def test_a_lag_is_of_time_and_not_of_readings(tmp_path: Path) -> None:
    """Readings with jitter and a gap; a straight line behind a lag tau is t - tau (1 - exp(-t / tau))."""
    oscillator(tmp_path)
    (beside,) = _compared(tmp_path, oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES[:1]))[0].channels.values()
    rng, lag = np.random.default_rng(4), 0.3
    times = np.sort(np.concatenate([rng.uniform(0.0, 1.0, 400), rng.uniform(2.5, 4.0, 100)]))
    times[0], times[-1] = 0.0, 4.0
    assert beside.simulated is not None
    uneven = replace(beside, simulated=replace(beside.simulated, times=times, values=times))
    behind = uneven.behind(lag)
    expected = uneven.times - lag * (1.0 - np.exp(-uneven.times / lag))
    np.testing.assert_allclose(behind, expected, atol=0.01)


def _stepped(tmp_path: Path, late: float) -> list[Compared]:
    """An ammeter of coils whose voltage steps; readings of the second recording are so much later than it says [s]."""
    base = yaml.safe_load((Path(__file__).parents[1] / "amend" / "two_by_two.yaml").read_text(encoding="utf-8"))
    base["time"] |= {"stop": "40 s"}
    rng, folders = np.random.default_rng(8), []
    for number in range(3):
        steps = [[f"{4.0 * n:g} s", f"{v:.2f} V"] for n, v in enumerate(rng.uniform(0.3, 2.5, 10))]
        own = {"components": {"supply": {"outputs": {"voltage": {"points": steps}}}}}
        whole = deepcopy(base)
        whole["components"]["supply"]["outputs"]["voltage"] |= {"points": steps}
        results = run(parse_scenario(yaml.safe_dump(whole), tmp_path / "scenario.yaml"))
        times = np.arange(0.15, 39.0, 0.1)
        seen = np.searchsorted(results["time"].values, times + (late if number == 1 else 0.0))
        current = 1.03 * results["circuit.string_current"].values[seen, 0]  # a number of the rig is 3 % off
        current += 1e-3 * rng.standard_normal(len(times))
        folder = tmp_path / f"run_{number}"
        folder.mkdir()
        pd.DataFrame({"t": times, "I": current}).to_csv(folder / "data.csv", index=False)
        about = {
            "title": f"run {number}",
            "table": "data.csv",
            "time": {"column": "t", "unit": "s", "zero": 0},
            "overrides": own,
            "channels": {"string[1].current": {"column": "I", "unit": "A", "noise": "1 mA"}},
        }
        (folder / "recording.yaml").write_text(yaml.safe_dump(about), encoding="utf-8")
        folders.append(folder)
    (tmp_path / "scenario.yaml").write_text(yaml.safe_dump(base), encoding="utf-8")
    return _compared(tmp_path, folders)


@pytest.mark.usefixtures("_shipped")
def test_the_clock_of_what_steps_with_its_input_is_told_by_the_readings_at_steps(tmp_path: Path) -> None:
    """A twentieth of the readings is at the wrong side of a step, and the others do not move."""
    (doubt,) = clocks_of_one(_stepped(tmp_path, 0.3))
    assert (doubt.recording, doubt.subject, doubt.kind) == ("run 1", "string[1].current", "clock")
    told = re.search(r"with a clock that is ([0-9.]+) s behind, told by readings 0.1 s apart$", doubt.statement)
    assert told is not None, doubt.statement
    assert float(told[1]) == pytest.approx(0.3, abs=0.1)


@pytest.mark.usefixtures("_shipped")
@pytest.mark.parametrize("late", [0.0, 0.05])
def test_a_clock_within_the_distance_of_readings_is_no_doubt(late: float, tmp_path: Path) -> None:
    assert clocks_of_one(_stepped(tmp_path, late)) == []


@pytest.fixture
def _shipped(shipped_fmus: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COSIM_FMU_PATH", str(shipped_fmus))


@pytest.mark.parametrize(("miss", "is_told"), [(3.0, True), (600.0, False)])
def test_what_other_channels_show_more_of_elsewhere_is_no_clock(miss: float, is_told: bool, tmp_path: Path) -> None:
    """Another channel that the scenario misses in the other recordings by more than a clock explains here."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0, SIZES)
    _own_table(recordings[1], 0.02, 0.0)
    every = _compared(tmp_path, recordings)
    for number, one in enumerate(every):
        beside = one.channels["rig.position"]
        times = beside.channel.times
        readings = beside.at(times) + miss * beside.floor * np.sin(7.0 * times) * (number != 1)
        other = replace(beside, channel=replace(beside.channel, values=readings))
        every[number] = replace(one, channels={**one.channels, "rig.other": other})
    told = [(d.recording, d.subject) for d in clocks_of_one(every)]
    assert told == ([("run_2", "rig.position")] if is_told else [])
