"""Courses and readings of the fifth set of foreign rigs; what all sets have in common: `test_foreign_sets`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario
from evaluation.fmus.model import OdeModel
from evaluation.strangers import fifth_set
from evaluation.strangers.lab import Steps


def test_courses_of_a_first_order_lag_are_the_closed_form() -> None:
    """Changes of the input off the grid of times, two of them a rounding error apart."""
    inputs = (Steps((0.0, 0.33), (1.0, 3.0)), Steps((0.0, 0.33 + 1e-13), (0.0, 0.0)))
    times, states = fifth_set.integrated(lambda t, x, u: [(u[0] - x[0]) / 0.2], (0.0,), inputs, 1.0, 0.1)
    early = 1.0 - np.exp(-times / 0.2)
    late = 3.0 + (1.0 - np.exp(-0.33 / 0.2) - 3.0) * np.exp(-(times - 0.33) / 0.2)
    np.testing.assert_allclose(states[:, 0], np.where(times < 0.33, early, late), rtol=1e-6)


def test_readings_of_a_rig_with_the_stated_numbers_are_the_fmu_and_noise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stated(rng: np.random.Generator, model: OdeModel, known: Mapping[str, float]) -> list[float]:
        return [value for value, _ in model.parameters.values()]

    monkeypatch.setattr(fifth_set, "drawn", stated)
    fifth_set.tanks_null(tmp_path, np.random.default_rng(9))
    scenario = yaml.safe_load((tmp_path / "scenario.yaml").read_text(encoding="utf-8"))
    conditions = yaml.safe_load((tmp_path / "first" / "recording.yaml").read_text(encoding="utf-8"))["overrides"]
    for name, output in conditions["components"]["amplifier"]["outputs"].items():
        scenario["components"]["amplifier"]["outputs"][name] = {"unit": "V", **output}
    (tmp_path / "run.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
    simulated = run(load_scenario(tmp_path / "run.yaml"))
    table = np.genfromtxt(tmp_path / "first" / "data.csv", delimiter=",", names=True)
    level = np.interp(table["time_s"], np.asarray(simulated["time"], dtype=np.float64), simulated["rig.level1"])
    left = (table["h1_cm"] - 100.0 * level)[np.isfinite(table["h1_cm"])]
    assert np.std(left) == pytest.approx(0.12, rel=0.15)
    assert abs(np.mean(left)) < 4 * 0.12 / np.sqrt(len(left))
