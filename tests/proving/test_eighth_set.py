"""Loggers of the eighth set of foreign rigs; what all sets have in common: `test_foreign_sets`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from evaluation.strangers import eighth_set
from evaluation.strangers.__main__ import make


def test_second_table_has_a_clock_of_its_own_and_the_same_instants(tmp_path: Path) -> None:
    make(eighth_set.clamp_null, tmp_path, 4)
    folder = tmp_path / "task" / "first"
    channels = yaml.safe_load((folder / "recording.yaml").read_text(encoding="utf-8"))["channels"]
    clock = channels["animal.plasma"]["time"]
    table = np.genfromtxt(folder / channels["animal.plasma"]["table"], delimiter=",", names=True)
    assert "time" not in channels["animal.glucose"]
    assert (clock["unit"], 7.0 <= clock["zero"] <= 10.0) == ("h", True)
    assert 3600.0 * (table[clock["column"]] - clock["zero"]) == pytest.approx(np.arange(121) * 300.0, abs=1e-3)


def test_idle_column_is_in_the_table_alone(tmp_path: Path) -> None:
    make(eighth_set.engine_null, tmp_path, 4)
    folder = tmp_path / "task" / "first"
    rows = (folder / "data.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0].split(",") == ["time_ms", "MAP_kPa", "U_batt"]
    assert {row.count(",") for row in rows} == {2}
    assert "U_batt" not in (folder / "recording.yaml").read_text(encoding="utf-8")


def test_wild_readings_are_few_and_of_one_column() -> None:
    spoil = eighth_set.tailed(np.random.default_rng(2), "a", 0.1, 0.02, 0.01)
    times, values = np.arange(5000.0), np.zeros(5000)
    wild = spoil("a", times, values)
    assert np.mean(wild != 0.0) == pytest.approx(0.02, abs=0.006)
    assert np.max(np.abs(wild)) > 30 * 0.1
    assert wild == pytest.approx(np.round(wild, 2), abs=1e-9)
    assert np.array_equal(spoil("b", times, values), values)
