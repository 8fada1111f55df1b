"""A clock that is a few seconds off on a slow rig, and a programme whose switches are not the readings' edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario, load_scenario
from cosim.unit import Array
from diagnosis.check.beside import Compared, compare
from diagnosis.check.clock_shift import clock_shift, event_gain, shift_doubts
from diagnosis.check.edges import edge_doubts, edges
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


@pytest.mark.parametrize("late", [8.0, 15.0, -8.0, -15.0])
def test_a_clock_that_is_seconds_off(scenario: Scenario, tmp_path: Path, late: float) -> None:
    """The sensors lag by 12 s, which the scenario lacks."""
    one = beside(scenario, tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), late)
    found = clock_shift(one)
    assert found is not None
    assert found.size == pytest.approx(late, abs=2.5)
    (doubt,) = shift_doubts(one)
    assert doubt.kind == "dead time"
    if late < 0.0:  # no lag makes a response earlier
        assert doubt.is_serious
        assert "earlier than its programme" in doubt.statement
        assert "95 %" in doubt.statement
    else:  # two lags in series do as much
        assert not doubt.is_serious
        assert "a clock shift of" in doubt.statement
        assert "cannot be told apart" in doubt.statement


def test_a_clock_that_runs_wrong(scenario: Scenario, tmp_path: Path) -> None:
    """By 4 % over ten minutes: on a slow rig a response that changes its size from some instant on does as much."""
    folder = rig.write(tmp_path / "a", rig.SECOND, rig.readings(rig.SECOND), times=1.04 * rig.instants())
    (doubt,) = shift_doubts(compare(scenario, load_recording(folder)))
    assert (doubt.kind, doubt.is_serious) == ("clock", False)
    assert "clock seems to run" in doubt.statement
    assert "cannot be told apart" in doubt.statement


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
