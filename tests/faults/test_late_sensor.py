"""A sensor that is slower, or whose clock is off, in one recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.faults.readings import Readings
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.doubts import OF_TIMES
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.systems.rigs import STEP, drive, held, oscillator, write_recording

COUNT = 400


def _readings(times: Array, values: Array, used: Array | None = None) -> Readings:
    edges = np.concatenate([times[:1] - 0.5, 0.5 * (times[1:] + times[:-1]), times[-1:] + 0.5])
    count = len(times)
    counted = np.ones(count, dtype=bool) if used is None else used.astype(bool)
    return Readings(0, 0, "T", "K", slice(0, count), edges, values, 0.5, counted, 0.0, times)


def test_a_ramp_is_behind_by_the_time_constant() -> None:
    times = np.array([0.0, 1.0, 1.5, 4.0, 5.0, 9.0, 12.0, 13.0, 20.0, 30.0])
    readings = _readings(times, 3.0 * times)
    np.testing.assert_allclose(
        readings.slower(3.0 * times, 2.0, 0.0, 30.0), 3.0 * (times - 2.0 + 2.0 * np.exp(-times / 2.0)), atol=1e-12
    )


def test_an_interval_leaves_what_lies_beside_it_and_readings_that_do_not_count() -> None:
    times = np.arange(20.0)
    used = np.ones(20)
    used[9] = 0.0
    readings = _readings(times, times**2, used)
    for moved in (readings.slower(times**2, 3.0, 5.0, 14.0), readings.shifted(times**2, 3.0, 5.0, 14.0)):
        same = moved == times**2
        assert same[:5].all()
        assert same[15:].all()
        assert same[9]
        assert not same[[7, 8, 10, 11, 12, 13]].any()


def test_a_clock_reads_what_was_before_and_what_comes() -> None:
    times = np.arange(20.0)
    readings = _readings(times, times)
    np.testing.assert_allclose(readings.shifted(times, 2.5, -0.5, 19.5)[3:], times[3:] - 2.5)
    np.testing.assert_allclose(readings.shifted(times, -2.5, -0.5, 19.5)[:17], times[:17] + 2.5)


def test_residuals_are_those_of_readings_that_were_slower() -> None:
    rng, times = np.random.default_rng(0), np.arange(30.0)
    truth = np.cumsum(rng.standard_normal(30))
    readings = _readings(times, truth + 0.5 * rng.standard_normal(30))
    plain = (readings.measured - truth) / 0.5
    slow = readings.slower(truth, 2.0, -0.5, 29.5)
    np.testing.assert_allclose(readings.with_lag(plain, 2.0, -0.5, 29.5), (readings.measured - slow) / 0.5)
    late = readings.shifted(truth, 1.5, -0.5, 29.5)
    np.testing.assert_allclose(readings.with_shift(plain, 1.5, -0.5, 29.5), (readings.measured - late) / 0.5)
    # no lag and no shift change nothing
    np.testing.assert_array_equal(readings.with_lag(plain, 0.0, -0.5, 29.5), plain)
    np.testing.assert_array_equal(readings.with_shift(plain, 0.0, -0.5, 29.5), plain)


def _diagnosed(folder: Path, lag: float, offset: float, count: int = 3) -> Diagnosis:
    """Runs of an oscillator whose numbers are off; the second one's sensor of the position is slower, or late.

    Its own numbers are so far off that the scenario as it is meets no recording: the check before the search asks for
    clocks of recordings that others are met beside.
    """
    oscillator(folder)
    every = []
    for number in range(count):
        rng = np.random.default_rng(40 + number)
        volts = drive(50 + number, 1.0)
        states = held(lambda x, u: np.array([x[1], 112.0 * u - 440.0 * x[0] - 4.4 * x[1]]), np.zeros(2), volts, STEP)
        position = states[:, 0]
        if number == 1:
            times = STEP * np.arange(len(position))
            position = _readings(times, position).shifted(position, offset, times[0], times[-1])
            position = _readings(times, position).slower(position, lag, times[0], times[-1])
        columns = {
            "t": STEP * np.arange(len(position)),
            "U": volts,
            "x": position + 0.003 * rng.standard_normal(len(position)),
            "v": states[:, 1] + 0.06 * rng.standard_normal(len(position)),
        }
        channels = {"rig.position": ("x", "m", "3 mm"), "rig.speed": ("v", "m/s", "0.06 m/s")}
        every.append(
            load_recording(write_recording(folder / f"run_{number}", columns, {"drive.u": ("U", "V")}, channels))
        )
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis


def test_a_sensor_that_is_slower_in_one_recording_is_found(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.03, 0.0)
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("sensor_lag_in_interval", "rig.position (run_1)")
    assert finding.parameters[0].value == pytest.approx(0.03, rel=0.05)
    assert finding.statement == "sensor that was slower, rig.position (run_1)"  # from begin to end, and not for a while
    assert not [d for d in found.doubts if d.kind in OF_TIMES]  # the numbers were off, and no clock


def test_a_clock_that_is_off_in_one_recording_is_reported_by_what_it_is_off(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.0, 0.02)
    assert found.verdict is Verdict.RECORDING_FAULT
    (doubt,) = [d for d in found.doubts if d.is_serious]
    assert "with a clock that is 0.02 s" in doubt.statement


def test_a_clock_without_recordings_to_compare_with_is_found_by_the_search(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.0, 0.02, 2)
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("sensor_clock_in_interval", "rig.position (run_1)")
    assert finding.parameters[0].value == pytest.approx(0.02, rel=0.05)


def test_a_sensor_that_is_in_time_is_not_late(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.0, 0.0)
    assert not [f for f in found.findings if f.is_accepted]
    assert not [d for d in found.doubts if d.kind in OF_TIMES]
