"""Megavolts are read as such: a cavity has them; where they are a slip for millivolts, the readings show it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.check import check_recordings
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import built, write_recording

TAU, STEP, COUNT, HOLD = 0.5, 0.1, 400, 20
CAVITY = OdeModel(
    "cavity", {"tau": (TAU, "s")}, {"drive": "V"}, {"x": ("V", "0", "(drive - x)/tau")}, {"probe": ("V", "x")}
)
SCENARIO = f"""\
title: A cavity
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  klystron: {{kind: programme, outputs: {{drive: {{unit: V, constant: 0 V}}}}}}
  cavity: {{kind: fmu, fmu: cavity.fmu, integrator: cvode}}
connections: [klystron.drive -> cavity.drive]
"""


@pytest.mark.parametrize(
    ("size", "unit", "written"), [(5e6, "MV", 1e6), (0.5, "MV", 1e-3), (0.5, "mV", 1e-3)], ids=["MV", "slip", "mV"]
)
def test_the_size_of_readings_tells_a_slip(tmp_path: Path, size: float, unit: str, written: float) -> None:
    """Readings of `size` volts at most stand in the column as multiples of `written`."""
    built(CAVITY, SCENARIO, tmp_path)
    found = []
    for run in (1, 2):
        rng = np.random.default_rng(run)
        drive = np.repeat(rng.uniform(0.0, size, COUNT // HOLD), HOLD)
        x, kept = np.zeros(COUNT), np.exp(-STEP / TAU)
        for n in range(COUNT - 1):
            x[n + 1] = drive[n] + kept * (x[n] - drive[n])
        probe = x + 0.01 * size * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "u": drive, "x": probe / written}
        channels = {"cavity.probe": ("x", unit, f"{0.01 * size / written:g} {unit}")}
        path = write_recording(tmp_path / f"run_{run}", columns, {"klystron.drive": ("u", "V")}, channels)
        found.append(load_recording(path))
    doubts = [d for d in check_recordings(load_scenario(tmp_path / "scenario.yaml"), found) if d.is_serious]
    is_slip = size < 1.0 and unit == "MV"
    assert [(d.subject, d.kind) for d in doubts] == [("cavity.probe", "unit")] * (2 if is_slip else 0)
    assert all("mV" in d.statement + d.remedy for d in doubts), [d.statement for d in doubts]
