"""The column of one input is late in one recording, while the other input is not: said with its size."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

STEP, COUNT, NOISE = 5.0, 600, 0.05
KITE = OdeModel(
    "tent",
    {"tau": (120.0, "s"), "chill": (6.0, "K*s/m/W"), "sway": (60.0, "s")},
    {"power": "W", "wind": "m/s"},
    {"x": ("W", "0", "(power - chill*wind*x/10 - x)/tau"), "y": ("m/s", "0", "(wind - y)/sway")},
    {"warmth": ("W", "x"), "pull": ("m/s", "y + 0.02*x")},
)
SCENARIO = f"""\
title: A tent in the wind
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  heater: {{kind: programme, outputs: {{power: {{unit: W, constant: 0 W}}}}}}
  mast: {{kind: programme, outputs: {{wind: {{unit: m/s, constant: 0 m/s}}}}}}
  rig: {{kind: fmu, fmu: tent.fmu, integrator: cvode}}
connections: [heater.power -> rig.power, mast.wind -> rig.wind]
"""


def _wandering(rng: np.random.Generator) -> np.ndarray:
    """A wind between 0 and 10 m/s that changes within a minute."""
    white = rng.standard_normal(COUNT + 40)
    smooth = np.convolve(white, np.exp(-0.5 * (np.arange(-20, 21) / 8.0) ** 2), "same")[20:-20]
    return np.clip(5.0 + 2.5 * smooth / smooth.std(), 0.0, 10.0)


def _doubts(folder: Path, late: dict[str, int]) -> list[Doubt]:
    """About three runs, in the second of which columns are so many rows late."""
    KITE.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    recordings = []
    for run in (1, 2, 3):
        rng = np.random.default_rng([7, run])
        power, wind = np.repeat(rng.uniform(0.0, 20.0, COUNT // 60), 60), _wandering(rng)
        x, y, heat = np.zeros(COUNT), np.zeros(COUNT), 0.0
        for n in range(1, COUNT):
            for _ in range(50):
                heat += STEP / 50.0 * (power[n - 1] - 0.6 * wind[n - 1] * heat - heat) / 120.0
            x[n] = heat
            y[n] = y[n - 1] - (wind[n - 1] - y[n - 1]) * np.expm1(-STEP / 60.0)
        values = {"power": power, "wind": wind, "warmth": x, "pull": y + 0.02 * x}
        for name in ("warmth", "pull"):
            values[name] = values[name] + NOISE * rng.standard_normal(COUNT)
        for name, rows in late.items() if run == 2 else ():
            values[name] = np.concatenate([np.repeat(values[name][:1], rows), values[name][:-rows]])
        columns = {"t": STEP * np.arange(COUNT), **values}
        inputs = {"heater.power": ("power", "W"), "mast.wind": ("wind", "m/s")}
        told = {"rig.warmth": ("warmth", "W", f"{NOISE} W"), "rig.pull": ("pull", "m/s", f"{NOISE} m/s")}
        recordings.append(write_recording(folder / f"run_{run}", columns, inputs, told))
    return list(check_recordings(load_scenario(str(folder / "scenario.yaml")), [load_recording(r) for r in recordings]))


def _of_an_input(doubts: list[Doubt]) -> list[Doubt]:
    return [d for d in doubts if "as if it acted" in d.statement]


def test_a_column_that_is_late_is_said_with_its_size(tmp_path: Path) -> None:
    (found,) = _of_an_input(_doubts(tmp_path, {"wind": 12}))
    assert (found.recording, found.subject, found.kind, found.is_serious) == ("run_2", "mast.wind", "clock", True)
    size = re.search(r"as if it acted (\d+) s earlier than its column says", found.statement)
    assert size is not None
    assert float(size[1]) == pytest.approx(60.0, abs=STEP)


@pytest.mark.parametrize("late", [{}, {"warmth": 12, "pull": 12}], ids=["none", "readings"])
def test_nothing_is_said_of_an_input_where_none_is_late_or_all_readings_are(
    tmp_path: Path, late: dict[str, int]
) -> None:
    assert not _of_an_input(_doubts(tmp_path, late))
