"""A lump that radiates, in a room that is a parameter of its FMU: named, with its size, and the amended model runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from diagnosis.write_outputs import write_outputs
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

#: Heat capacity [J/K], loss [W/K], room [K], and what it radiates, which the model does not have [W/K^4].
C, K, ROOM, EMISSION = 50.0, 0.3, 293.0, 1.2e-9
STEP, COUNT, NOISE = 5.0, 500, 0.05
SCENARIO = f"""\
title: A lump in a room
time: {{stop: {STEP * COUNT:g} s, macro_step: 5 s, output_step: 5 s}}
components:
  drive: {{kind: programme, outputs: {{power: {{unit: W, constant: 0 W}}}}}}
  lump: {{kind: fmu, fmu: lump.fmu, integrator: cvode}}
connections: [drive.power -> lump.power]
"""


def test_radiation_is_named_where_the_room_is_a_parameter(tmp_path: Path) -> None:
    numbers = {"C": (C, "J/K"), "K": (K, "W/K"), "T_room": (ROOM, "K")}
    rate = "(power - K*(T - T_room))/C"
    OdeModel("lump", numbers, {"power": "W"}, {"T": ("K", "T_room", rate)}, {"temperature": ("K", "T")}).build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    recordings = []
    for number in range(3):
        rng = np.random.default_rng([11, number])
        power = np.repeat(rng.choice([0.0, 20.0, 45.0, 80.0], COUNT // 50), 50)

        def course(x: np.ndarray, watt: float) -> np.ndarray:
            return (watt - K * (x - ROOM) - EMISSION * (x**4 - ROOM**4)) / C

        values = held(course, np.array([ROOM]), power, STEP)[:, 0] + NOISE * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "P": power, "T": values}
        channels = {"lump.temperature": ("T", "K", f"{NOISE} K")}
        path = write_recording(tmp_path / f"run_{number}", columns, {"drive.power": ("P", "W")}, channels)
        recordings.append(load_recording(path))
    scenario = load_scenario(tmp_path / "scenario.yaml")
    made = diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True))
    answer = made.diagnosis
    assert answer.verdict is Verdict.MISSING_PHYSICS
    (found,) = answer.accepted
    assert found.effect == "radiation"
    assert found.parameters[0].value == pytest.approx(EMISSION / C, rel=0.05)
    assert "surroundings = 293 K" in found.law
    written = write_outputs(made, scenario, recordings[:2], recordings[2:], tmp_path / "answer")
    assert written.amended_model is not None
    results = run(load_scenario(tmp_path / "answer" / "amended" / "scenario.yaml"))
    assert np.isfinite(results["lump.temperature"].values).all()
