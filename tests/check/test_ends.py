"""The range of a sensor that ends where nobody stated it, beside a rig that ends there itself."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check import ends
from diagnosis.check.check import check_recordings
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Doubt, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.systems.rigs import oscillator, oscillator_recordings

NOISE, END = 1e-3, 0.15


def _changed(folder: Path, change: Callable[[Array], Array]) -> list[Path]:
    """Recordings of the oscillator, the readings of the second changed."""
    oscillator(folder)
    recordings = oscillator_recordings(folder, lambda x, v: 0.0)
    table = pd.read_csv(recordings[1] / "data.csv")
    assert table["x"].max() > 1.3 * END
    table["x"] = change(table["x"].to_numpy())
    table.to_csv(recordings[1] / "data.csv", index=False)
    return recordings


def _ends(folder: Path, recordings: list[Path]) -> list[Doubt]:
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return [d for d in check_recordings(scenario, [load_recording(r) for r in recordings]) if d.kind == "range"]


@pytest.mark.parametrize(
    ("change", "name"),
    [(lambda x: np.minimum(x, END), "largest"), (lambda x: np.maximum(x, -END), "smallest")],
)
def test_a_range_that_ends_before_the_rig_does_is_told(
    change: Callable[[Array], Array], name: str, tmp_path: Path
) -> None:
    (told,) = _ends(tmp_path, _changed(tmp_path, change))
    assert told.is_serious
    assert told.recording == "run_2"
    assert f"repeat its {name} value, " in told.statement


def test_both_ends_are_told(tmp_path: Path) -> None:
    told = _ends(tmp_path, _changed(tmp_path, lambda x: np.clip(x, -END, END)))
    assert [d.is_serious for d in told] == [True, True]


@pytest.mark.parametrize(("lower", "is_serious"), [(-END, True), (-0.9 * END, False)])
def test_a_range_ends_at_the_opposite_of_its_other_end(
    lower: float, is_serious: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the simulation says of the lower end: numbers that are off make it come late."""
    monkeypatch.setattr(ends, "_beyond", lambda beside, end, free: 0.05 if end.is_upper else None)
    told = _ends(tmp_path, _changed(tmp_path, lambda x: np.clip(x, lower, END)))
    assert {d.is_serious for d in told if "smallest" in d.statement} == {is_serious}
    assert {d.is_serious for d in told if "largest" in d.statement} == {True}
    assert any("as far from zero as the other end" in d.statement for d in told) == is_serious


def test_such_readings_are_left_out_and_the_fault_is_the_verdict(tmp_path: Path) -> None:
    every = [load_recording(r) for r in _changed(tmp_path, lambda x: np.clip(x, -END, END))]
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    assert f"repeat its smallest value, -{END:.3f} m" in found.statement
    assert found.findings == ()  # nothing is made of readings that say where the quantity is not
    assert found.adequacy is not None
    assert not found.adequacy.is_rejected


def test_a_rig_that_ends_there_itself_is_no_sensor(tmp_path: Path) -> None:
    """A stop of the rig: its readings go on to scatter."""
    noise = NOISE * np.random.default_rng(5).standard_normal(800)
    assert _ends(tmp_path, _changed(tmp_path, lambda x: np.minimum(x, END) + noise)) == []


def test_a_sensor_that_holds_its_largest_value_where_the_rig_goes_down_is_a_question(tmp_path: Path) -> None:
    def held(x: Array) -> Array:
        top = int(np.argmax(x))
        return np.asarray(np.where((np.arange(len(x)) >= top) & (np.arange(len(x)) < top + 60), x[top], x))

    told = _ends(tmp_path, _changed(tmp_path, held))
    assert not any(d.is_serious for d in told)
    assert all("may end there" in d.statement for d in told)


def test_a_model_that_does_not_meet_the_other_readings_tells_nothing(tmp_path: Path) -> None:
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 250.0 * x - 8.0 * v)
    table = pd.read_csv(recordings[1] / "data.csv")
    table["x"] = np.minimum(table["x"], 0.4 * table["x"].max())
    table.to_csv(recordings[1] / "data.csv", index=False)
    told = _ends(tmp_path, recordings)
    assert len(told) == 1
    assert not told[0].is_serious
