"""A clock that is a few seconds off on a slow rig, and a programme whose switches are not the readings' edges."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario, load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.beside import Compared, compare, lagged
from diagnosis.check.clock_doubts import _size, shift_doubts
from diagnosis.check.clock_shift import Shift, clock_shift, direct_gain, event_gain, timed_channel
from diagnosis.check.edges import edge_doubts, edges
from diagnosis.check.timing import _factors, _interval, _own, leading, resolution, timing_doubts
from diagnosis.recording.recording import load_recording
from tests.check import rig


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("tclab")


def beside(
    scenario: Scenario, folder: Path, points: Sequence[Sequence[float]], values: Array, late: float = 0.0
) -> Compared:
    return compare(scenario, load_recording(rig.write(folder, points, values, times=rig.instants() + late)))


def with_noise(compared: Compared, seed: int) -> Compared:
    """The same recording with other noise."""
    rng = np.random.default_rng(seed)
    channels = {}
    for name, one in compared.channels.items():
        values = one.channel.values + rig.NOISE * rng.standard_normal(len(one.channel.values))
        channels[name] = replace(one, channel=replace(one.channel, values=values))
    return replace(compared, channels=channels)


@pytest.mark.parametrize("points", [rig.FIRST, rig.SECOND], ids=["first", "second"])
def test_40_clean_recordings_raise_no_doubt(
    scenario: Scenario, tmp_path: Path, points: Sequence[Sequence[float]]
) -> None:
    clean = beside(scenario, tmp_path / "a", points, rig.temperatures(points))
    for seed in range(20):
        noisy = with_noise(clean, seed)
        assert shift_doubts(noisy) == []
        assert edge_doubts(noisy) == []


def test_a_response_that_grows_is_no_clock_that_runs_wrong(
    scenario: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Sensors that read more while the power is on, by up to 6 K at the end: a clock 2 % slow would gain 100."""
    share = rig.instants()[:, None] / rig.SPAN
    starts = np.array([p[0] for p in rig.FIRST])
    power = np.array([p[1:] for p in rig.FIRST])[np.searchsorted(starts, rig.instants(), side="right") - 1]
    values = rig.readings(rig.FIRST) + 6.0 * (power > 0.5) * np.expm1(2.0 * share) / np.expm1(2.0)
    one = beside(scenario, tmp_path / "a", rig.FIRST, values)
    monkeypatch.setattr("diagnosis.check.clock_doubts.direct_gain", lambda compared: 0.0)
    monkeypatch.setattr("diagnosis.check.clock_doubts.event_gain", lambda compared: 0.0)
    assert shift_doubts(one) == []
    monkeypatch.setattr("diagnosis.check.clock_doubts.growth_gain", lambda compared, is_late=False: 0.0)
    assert shift_doubts(one) != []


@pytest.mark.parametrize("rate", [0.03, -0.03])
def test_a_clock_that_runs_wrong_is_no_response_that_grows(scenario: Scenario, tmp_path: Path, rate: float) -> None:
    times = rig.instants() * (1.0 + rate)
    one = compare(
        scenario, load_recording(rig.write(tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), times=times))
    )
    (doubt,) = [*timing_doubts(one, [])] or [d for d in shift_doubts(one) if d.is_serious]
    assert doubt.kind == "clock"
    assert f"too {'fast' if rate > 0 else 'slow'}" in doubt.statement


@pytest.mark.parametrize("late", [8.0, 15.0, -8.0, -15.0])
def test_a_clock_that_is_seconds_off(scenario: Scenario, tmp_path: Path, late: float) -> None:
    """The sensors lag by 12 s, which the scenario lacks."""
    one = beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), late)
    found = clock_shift(one)
    assert found is not None
    assert found.size == pytest.approx(late, abs=2.5)
    (doubt,) = shift_doubts(one)
    assert doubt.kind == "dead time"
    assert f"s {'later' if late > 0.0 else 'earlier'} than its programme" in doubt.statement
    assert "95 %" in doubt.statement
    if late < 0.0:  # nothing in a rig makes a response earlier
        assert doubt.is_serious
    else:
        assert (doubt.is_serious, doubt.is_far) == (False, True)
        assert "cannot be told apart" in doubt.statement


@pytest.mark.parametrize("is_rate", [False, True])
def test_a_clock_that_is_off_is_told_with_its_interval(is_rate: bool) -> None:
    found = Shift(-8.0, (-10.0, -5.5), 3.0, 50.0, 40.0, 1.0, 30.0, True, 0.002 if is_rate else 0.0)
    assert _size(found) == ("1.6 % (1.1 to 2 %, 95 %)" if is_rate else "8 s (5.5 to 10 s, 95 %)")


def test_the_interval_of_a_shift_holds_what_the_likelihood_allows_and_reaches_the_next_that_were_tried() -> None:
    tried = [(50.0 - (size - 10.0) ** 2, size) for size in (2.0, 4.0, 7.0, 8.5, 9.5, 10.0, 11.0, 13.0, 20.0)]
    assert _interval([*tried, (40.0, -3.0)], 10.0) == (7.0, 13.0)  # 8.5 to 11 are within 3.84
    assert _interval([(-g, -s) for g, s in [(-5.0, 2.0), (-9.0, 3.0), (-1.0, 4.0)]], -3.0) == (2.0, 4.0)


@pytest.mark.parametrize("lags", [(10.0, 10.0), (5.0, 5.0, 5.0), (20.0, 20.0), (4.0, 8.0, 30.0)])
def test_lags_in_series_are_no_clock(scenario: Scenario, tmp_path: Path, lags: Sequence[float]) -> None:
    """Each behind the 12 s of the sensors: nothing is wrong with these recordings but the model."""
    values = rig.readings(rig.SECOND)
    for lag in lags:
        values = np.stack([lagged(rig.instants(), row, lag) for row in values.T], axis=1)
    assert not any(d.is_serious for d in shift_doubts(beside(scenario, tmp_path / "a", rig.SECOND, values)))


@pytest.mark.parametrize("size", [2.0, 8.0])
def test_a_reading_that_answers_the_power_at_once_is_no_clock(scenario: Scenario, tmp_path: Path, size: float) -> None:
    """A thermometer on the heater's leads reads up to `size` kelvins more while power is on."""
    points = np.array(rig.SECOND)
    power = points[np.searchsorted(points[:, 0], rig.instants(), side="right") - 1, 1:]
    values = rig.readings(rig.SECOND) + size * power**1.5
    one = beside(scenario, tmp_path / "a", rig.SECOND, values)
    assert direct_gain(one) > 100.0
    assert not any(d.is_serious for d in (*shift_doubts(one), *timing_doubts(one, [])))


def test_gains_do_not_depend_on_the_unit_and_sum_over_blocks(scenario: Scenario, tmp_path: Path) -> None:
    one = beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), -8.0)
    channel = next(iter(one.channels.values()))
    moves, lags = np.array([[0.0, 0.0], [-8.0, 0.0]]), np.array([0.0, 10.0])
    timed = timed_channel(channel, moves, lags)
    gain = timed.deviance[0].min() - timed.deviance[1].min()
    assert gain > 30.0
    assert timed.steps(0, 1).sum() == pytest.approx(gain, rel=0.1)
    measured, series = channel.channel, channel.simulated
    assert series is not None
    larger = replace(
        channel,
        channel=replace(measured, values=1e3 * measured.values, deviation=1e3 * measured.deviation),
        simulated=replace(series, values=1e3 * series.values),
    )
    again = timed_channel(larger, moves, lags)
    assert again.deviance[0].min() - again.deviance[1].min() == pytest.approx(gain, rel=1e-6)


def test_an_event_gains_the_same_in_any_unit(scenario: Scenario, tmp_path: Path) -> None:
    one = beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND))
    scaled = {}
    for name, old in one.channels.items():
        assert old.simulated is not None
        channel = replace(old.channel, values=1e3 * old.channel.values, deviation=1e3 * old.channel.deviation)
        scaled[name] = replace(
            old, channel=channel, simulated=replace(old.simulated, values=1e3 * old.simulated.values)
        )
    assert event_gain(replace(one, channels=scaled)) == pytest.approx(event_gain(one), rel=1e-6)


def test_a_clock_that_runs_wrong(scenario: Scenario, tmp_path: Path) -> None:
    """By 4 % over ten minutes; no lag and no event explains as much."""
    folder = rig.write(tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), times=1.04 * rig.instants())
    one = compare(scenario, load_recording(folder))
    (doubt,) = shift_doubts(one)
    assert (doubt.kind, doubt.is_serious) == ("clock", True)
    assert "too fast" in doubt.statement
    found = clock_shift(one)
    assert found is not None
    assert found.is_rate
    low, high = found.interval
    assert low <= 0.04 / found.rate <= high


@pytest.mark.parametrize("share", [0.9, 1.0, 1.13])
def test_a_rate_near_the_least_that_is_tried_lies_in_its_interval(
    scenario: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, share: float
) -> None:
    """The grid that finds a rate begins at one and a half readings over the recording; that is no bound of the rate."""
    monkeypatch.setattr("diagnosis.check.timing.critical", lambda tests: -10.0)  # it is refined though this rig is slow
    points = [[t, *(levels[n % 2] for levels in ((0.9, 0.0), (0.0, 0.9)))] for n, t in enumerate(range(0, 600, 40))]
    plain = beside(scenario, tmp_path / "a", points, rig.temperatures(points))
    least = 1.5 * max(resolution(plain, b.channel) for b in leading(plain)) / (plain.end - plain.begin)
    times = rig.instants() * (1.0 + share * least)
    one = compare(scenario, load_recording(rig.write(tmp_path / "b", points, rig.temperatures(points), times=times)))
    leads = leading(one)
    (rival,) = _factors(one, leads, [_own(one, b) for b in leads])
    rate, low, high = (float(v) for v in re.findall(r"([\d.]+) (?:%|to)", rival.text)[:3])
    assert low <= 100.0 * share * least <= high
    assert low <= rate <= high


def test_a_shift_within_its_bound_is_none(scenario: Scenario, tmp_path: Path) -> None:
    clock = {"column": "time", "zero": 0, "offset_bound": "12 s"}
    values = rig.readings(rig.SECOND)
    folder = rig.write(tmp_path / "a", rig.SECOND, values, times=rig.instants() + 8.0, time=clock)
    assert shift_doubts(compare(scenario, load_recording(folder))) == []


def test_edges_are_the_programme_s(scenario: Scenario, tmp_path: Path) -> None:
    found = edges(beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND)))
    assert found is not None
    assert found.met == (60.0, 190.0, 330.0, 390.0, 520.0)
    assert (found.missed, found.extra) == ((), ())
    assert found.odds < 1.0


def test_edges_of_another_programme(scenario: Scenario, tmp_path: Path) -> None:
    one = beside(scenario, tmp_path / "a", rig.FIRST, rig.readings(rig.SECOND))
    found = edges(one)
    assert found is not None
    assert np.array(found.extra) == pytest.approx([60.0, 190.0, 330.0, 390.0, 520.0], abs=6.0)
    (doubt,) = edge_doubts(one)
    assert (doubt.kind, doubt.is_serious) == ("programme", True)
    assert "odds" in doubt.statement


def test_an_event_is_no_other_programme(scenario: Scenario, tmp_path: Path) -> None:
    """A contact opens at 300 s: an edge without a switch, beside those of the programme."""
    done = tuple((t, p, q) if t < 300.0 else (t, 0.0, q) for t, p, q in rig.SECOND)
    event = sorted([*done, (300.0, 0.0, 0.2)])
    one = beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(event))
    found = edges(one)
    assert found is not None
    assert any(abs(t - 300.0) < 8.0 for t in found.extra)
    assert edge_doubts(one) == []
    assert shift_doubts(one) == []


def test_one_channel_whose_times_are_off_is_no_other_experiment(scenario: Scenario, tmp_path: Path) -> None:
    """A logger that stores one thermometer 15 s too early."""
    values = rig.readings(rig.SECOND)
    early = rig.readings(rig.SECOND)
    early[:, 0] = np.interp(rig.instants() + 15.0, rig.instants(), values[:, 0])
    found = shift_doubts(beside(scenario, tmp_path / "a", rig.SECOND, early))
    assert not any(d.is_serious for d in found)


def test_a_heater_that_opens_is_no_clock(scenario: Scenario, tmp_path: Path) -> None:
    """Both heaters open at 180 s of a programme that goes on: what is left cools, and no clock explains that."""
    done = (*(p for p in rig.SECOND if p[0] < 180.0), (180.0, 0.0, 0.0))
    one = beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(done))
    found = clock_shift(one)
    assert event_gain(one) > (found.gained if found is not None else 0.0)
    assert not any(d.is_serious for d in shift_doubts(one))


def jumped(scenario: Scenario, folder: Path, at: float, late: float) -> Compared:
    """A recording whose clock runs right but for a jump; nothing is written twice where it is set back."""
    times = rig.instants()
    written = np.where(times >= at, times + late, times)
    keep = np.concatenate([[True], np.diff(np.maximum.accumulate(written)) > 0.0])
    path = rig.write(folder, rig.SECOND, rig.readings(rig.SECOND)[keep], times=written[keep])
    return compare(scenario, load_recording(path))


@pytest.mark.parametrize(("at", "late"), [(310.0, 14.0), (310.0, -25.0), (420.0, 20.0), (250.0, 6.0)])
def test_a_clock_that_jumps_is_told_with_when_and_by_how_much(
    scenario: Scenario, tmp_path: Path, at: float, late: float
) -> None:
    """A logger whose clock stood still or was set: it runs right before and after."""
    (doubt,) = shift_doubts(jumped(scenario, tmp_path / "a", at, late))
    assert (doubt.kind, doubt.is_serious) == ("clock", True)
    words = "late: the clock was set forward" if late > 0.0 else "early: the clock stood still or was set back"
    found = re.search(
        rf"from about ([\d.]+) s on the readings are written about ([\d.]+) s too {words}", doubt.statement
    )
    assert found is not None, doubt.statement
    assert float(found[1]) == pytest.approx(at, abs=0.07 * rig.SPAN)
    assert float(found[2]) == pytest.approx(abs(late), rel=0.2)


@pytest.mark.parametrize("rate", [0.02, -0.02, 0.03])
def test_a_clock_that_runs_wrong_does_not_jump(scenario: Scenario, tmp_path: Path, rate: float) -> None:
    path = rig.write(tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), times=(1.0 + rate) * rig.instants())
    for doubt in shift_doubts(compare(scenario, load_recording(path))):
        assert "from about" not in doubt.statement or "cannot be told apart" in doubt.statement


@pytest.mark.parametrize(("at", "late"), [(200.0, -80.0), (300.0, -80.0)])
def test_a_clock_that_jumps_far_does_not_run_wrong_either(
    scenario: Scenario, tmp_path: Path, at: float, late: float
) -> None:
    (doubt,) = timing_doubts(jumped(scenario, tmp_path / "a", at, late), [])
    found = re.search(r"from about ([\d.]+) s on the readings are written about ([\d.]+) s too", doubt.statement)
    assert found is not None, doubt.statement
    assert float(found[1]) == pytest.approx(at, abs=0.07 * rig.SPAN)
    assert float(found[2]) == pytest.approx(abs(late), rel=0.25)
    assert ("too fast" in doubt.statement or "too slow" in doubt.statement) <= (
        "cannot be told apart" in doubt.statement
    )


@pytest.mark.parametrize("rate", [0.12, -0.12])
def test_a_clock_that_runs_far_wrong_does_not_jump(scenario: Scenario, tmp_path: Path, rate: float) -> None:
    path = rig.write(tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), times=(1.0 + rate) * rig.instants())
    for doubt in timing_doubts(compare(scenario, load_recording(path)), []):
        assert "from about" not in doubt.statement or "cannot be told apart" in doubt.statement
