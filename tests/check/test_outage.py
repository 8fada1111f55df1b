"""A recorded input without rows for a while: readings that depend on what it was then are not compared."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from cosim.run import RunStopped
from cosim.scenario import Scenario, load_scenario
from diagnosis.check.beside import compare
from diagnosis.check.check import check_recordings
from diagnosis.check.outage import LOST, outages, without_unknown
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import FEWEST_VALUES, Input, Recording, load_recording
from diagnosis.recording.usage import usage
from diagnosis.search.search import Settings
from tests.systems.rigs import COUNT, STEP, held, oscillator, oscillator_recordings, tank, write_recording

#: Rows of the table that are lost: 0.3 s, in which the drive swings once or twice.
FIRST, LAST = 500, 560


def with_outage(folder: Path) -> Recording:
    table = pd.read_csv(folder / "data.csv")
    table.drop(index=range(FIRST, LAST)).to_csv(folder / "data.csv", index=False)
    return load_recording(folder)


def recorded(times: np.ndarray, values: np.ndarray) -> Input:
    return Input("drive", "u", "V", times, values)


def test_what_acted_in_an_outage_rejects_no_model(tmp_path: Path) -> None:
    """It forgets with a time constant of 0.5 s: until then readings are of a drive that nobody knows."""
    path = oscillator(tmp_path)
    folders = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    recordings = [with_outage(folders[0]), load_recording(folders[1]), load_recording(folders[2])]
    scenario = load_scenario(path)
    one = compare(scenario, recordings[0])
    channel = one.recording.channels["rig.position"]
    count = channel.dropped["unknown input"]
    assert count > 100  # a time constant and more
    lost = set(np.round(recordings[0].channels["rig.position"].times / STEP)) - set(np.round(channel.times / STEP))
    assert min(lost) == LAST  # from the first reading after it, and as long as the oscillator remembers
    assert len(lost) == count
    assert len(one.whole.channels["rig.position"].times) == COUNT - (LAST - FIRST)
    (told,) = usage(one.recording)
    assert f"{count} dependent on what an input was while its column has no rows" in str(told)
    doubts = [d for d in check_recordings(scenario, recordings[:1]) if d.kind in ("input", "sensor")]
    assert {d.subject: d.is_serious for d in doubts} == {"drive.u": False, "rig.position": False}
    by = {d.subject: d.statement for d in doubts}
    assert "no rows from 2.495 to 2.8 s" in by["drive.u"]
    assert f"and {count} readings that depend on such gaps are not compared" in by["drive.u"]
    assert "no readings from 2.495 to 2.8 s" in by["rig.position"]  # readings that are left out were read
    made = diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True))
    assert made.diagnosis.verdict in (Verdict.RECALIBRATED, Verdict.CONSISTENT)


def test_without_an_outage_no_reading_is_left_out(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    one = compare(load_scenario(path), load_recording(oscillator_recordings(tmp_path, lambda x, v: 0.0)[0]))
    assert "unknown input" not in one.recording.channels["rig.position"].dropped


@pytest.mark.parametrize(("lost", "left_out"), [((60, 100), True), ((20, 60), False)])
def test_of_a_rig_that_never_forgets_readings_before_an_outage_are_compared_if_they_are_many(
    lost: tuple[int, int], left_out: bool, tmp_path: Path
) -> None:
    """What flowed into a tank with a small outlet stays: all readings after the outage are of an unknown level."""
    leak = 1e-5
    path = tank(tmp_path, "4000 s", "10 s")
    text = path.read_text(encoding="utf-8")
    own = f"integrator: cvode, parameters: {{leak: {leak} m^2/s}}"
    path.write_text(text.replace("integrator: cvode", own), encoding="utf-8")
    rng = np.random.default_rng(3)
    inflow = np.repeat(rng.choice([0.0, 0.01, 0.02], 40), 10)
    level = held(lambda h, q: (q - leak * h) / 0.5, np.array([0.4]), inflow, 10.0)[:, 0]
    columns = {"t": 10.0 * np.arange(400), "q": inflow, "h": level + 1e-3 * rng.standard_normal(400)}
    folder = write_recording(
        tmp_path / "run", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )
    table = pd.read_csv(folder / "data.csv")
    table.drop(index=range(*lost)).to_csv(folder / "data.csv", index=False)
    scenario, recording = load_scenario(path), load_recording(folder)
    compared = compare(scenario, recording).recording.channels["tank.level"]
    (doubt,) = [d for d in check_recordings(scenario, [recording]) if d.subject == "pump.inflow" and d.kind == "input"]
    if left_out:  # those after it, 300 of 360
        assert compared.dropped["unknown input"] == pytest.approx(300, abs=2)
        assert compared.times[-1] < 10.0 * lost[0] + 10.0
        assert f"{compared.dropped['unknown input']} readings that depend on such gaps" in doubt.statement
    else:
        assert "unknown input" not in compared.dropped
        assert "the last value is held" in doubt.statement


@pytest.mark.parametrize(
    ("times", "values", "count"),
    [
        (np.delete(np.arange(200.0), slice(50, 50 + LOST)), np.resize([1.0, 2.0], 200 - LOST), 1),
        (np.delete(np.arange(200.0), slice(50, 50 + LOST - 1)), np.resize([1.0, 2.0], 200 - LOST + 1), 0),  # by chance
        (np.delete(np.arange(200.0), slice(50, 80)), np.ones(170), 0),  # it never changes
        (
            np.cumsum(np.random.default_rng(1).uniform(1.0, 9.0, 200)),
            np.resize([1.0, 2.0], 200),
            0,
        ),  # a list of changes
        (np.delete(np.arange(40.0), slice(5, 20)), np.resize([1.0, 2.0], 25), 0),  # too few rows to say what is usual
    ],
)
def test_an_outage_is_a_gap_in_what_is_logged_all_the_time(times: np.ndarray, values: np.ndarray, count: int) -> None:
    found = outages(recorded(times, values))
    assert len(found) == count
    if found:
        assert (found[0].begin, found[0].end, found[0].step) == (49.0, 50.0 + LOST, 1.0)


def test_a_channel_of_few_readings_keeps_them(tmp_path: Path) -> None:
    """One reading a second: with those after the outage left out, fewer would stay than a diagnosis needs."""
    path = oscillator(tmp_path)
    recording = with_outage(oscillator_recordings(tmp_path, lambda x, v: 0.0)[0])
    whole = compare(load_scenario(path), recording)
    assert whole.results is not None
    own = recording.channels["rig.position"]
    few = replace(own, times=own.times[::150], values=own.values[::150], is_clipped=own.is_clipped[::150])
    assert len(few.times) < 2 * FEWEST_VALUES
    kept = without_unknown(load_scenario(path), replace(recording, channels={"rig.position": few}), whole.results)
    assert len(kept.channels["rig.position"].times) == len(few.times)


def test_times_of_hours_are_written_without_exponents(tmp_path: Path) -> None:
    path = tank(tmp_path, "40000 s", "100 s")
    rng = np.random.default_rng(3)
    inflow = np.repeat(rng.choice([0.0, 0.01, 0.02], 40), 10)
    level = held(lambda h, q: (q - 0.02 * h) / 0.5, np.array([0.4]), inflow, 100.0)[:, 0]
    columns = {"t": 100.0 * np.arange(400), "q": inflow, "h": level + 1e-3 * rng.standard_normal(400)}
    folder = write_recording(
        tmp_path / "run", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )
    table = pd.read_csv(folder / "data.csv")
    table.drop(index=range(160, 180)).to_csv(folder / "data.csv", index=False)
    doubts = check_recordings(load_scenario(path), [load_recording(folder)])
    told = [d.statement for d in doubts if " from 15900 to 18000 s" in d.statement]
    assert len(told) == 2  # of the input and of the level


def test_runs_that_stop_leave_no_reading_out(tmp_path: Path) -> None:
    """With an input at its extreme a rig may run away: that says nothing of what acted."""
    path = oscillator(tmp_path)
    recording = with_outage(oscillator_recordings(tmp_path, lambda x, v: 0.0)[0])
    one = compare(load_scenario(path), recording)
    assert one.results is not None

    def stops(scenario: Scenario) -> xr.Dataset:
        raise RunStopped("it runs away", one.results, False)

    kept = without_unknown(load_scenario(path), recording, one.results, stops)
    assert len(kept.channels["rig.position"].times) == COUNT - (LAST - FIRST)
