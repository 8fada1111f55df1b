"""First readings of outputs that numbers of the rig work out, beside those of states that begin elsewhere."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

STEP, COUNT, NOISE = 0.1, 400, 0.5
#: Fuel that reaches the flame late, so that no output jumps with an input; gas that it heats; metal that follows it;
#: a probe that begins in the gas: its start is worked out from a number.
BURNER = OdeModel(
    "burner",
    {"rise": (600.0, "K"), "late": (2.0, "s"), "slow": (8.0, "s"), "T_0": (640.0, "K")},
    {"fuel": "1"},
    {
        "w": ("1", "0.5", "(fuel - w)/late"),
        "metal": ("K", "T_0", "(300 + rise*w - metal)/slow"),
        "tip": ("K", "300 + 0.5*rise", "(300 + rise*w - tip)/0.3"),
    },
    {"gas": ("K", "300 + rise*w"), "wall": ("K", "metal"), "probe": ("K", "tip")},
)
SCENARIO = f"""\
title: A burner
time: {{stop: {STEP * COUNT:g} s, macro_step: {STEP:g} s, output_step: {STEP:g} s}}
components:
  valve: {{kind: programme, outputs: {{fuel: {{unit: "1", constant: 0.5}}}}}}
  burner: {{kind: fmu, fmu: burner.fmu, integrator: INTEGRATOR}}
connections: [valve.fuel -> burner.fuel]
"""


def starts(folder: Path, rise: float, metal: float, integrator: str) -> list[Doubt]:
    """Doubts about starts of three runs of a burner.

    Args:
        folder: For its files.
        rise: In truth; 600 K is stated.
        metal: Temperature with which the metal begins in the second run [K]; 640 K is stated.
        integrator: Of the FMU.
    """
    BURNER.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO.replace("INTEGRATOR", integrator), encoding="utf-8")
    recordings = []
    for run in (1, 2, 3):
        rng = np.random.default_rng(40 + run)
        fuel = np.concatenate([np.full(40, 0.5), np.repeat(rng.uniform(0.3, 0.9, (COUNT - 40) // 40), 40)])

        def rate(x: Array, u: float) -> Array:
            hot = 300.0 + rise * x[0]
            return np.array([(u - x[0]) / 2.0, (hot - x[1]) / 8.0, (hot - x[2]) / 0.3])

        course = held(rate, np.array([0.5, metal if run == 2 else 640.0, 300.0 + 0.5 * rise]), fuel, STEP)
        gas = 300.0 + rise * course[:, 0] + NOISE * rng.standard_normal(COUNT)
        wall = course[:, 1] + NOISE * rng.standard_normal(COUNT)
        probe = course[:, 2] + NOISE * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "u": fuel, "gas": gas, "wall": wall, "probe": probe}
        channels = {f"burner.{n}": (n, "K", f"{NOISE} K") for n in ("gas", "wall", "probe")}
        path = write_recording(folder / f"run_{run}", columns, {"valve.fuel": ("u", "1")}, channels)
        recordings.append(load_recording(path))
    doubts = check_recordings(load_scenario(str(folder / "scenario.yaml")), recordings)
    return [d for d in doubts if d.kind == "start"]


def test_an_output_that_a_number_works_out_begins_nowhere_else(tmp_path: Path) -> None:
    """The gas is 30 K hotter from the begin on, for the fuel heats more: no run began otherwise than it says."""
    assert [d.subject for d in starts(tmp_path, 660.0, 640.0, "cvode")] == []


def test_of_hidden_states_it_is_not_known(tmp_path: Path) -> None:
    assert {d.subject for d in starts(tmp_path, 660.0, 640.0, "internal")} == {"burner.gas", "burner.probe"}


@pytest.mark.parametrize("integrator", ["cvode", "internal"])
def test_a_state_that_begins_elsewhere_is_told_though_a_parameter_states_its_start(
    integrator: str, tmp_path: Path
) -> None:
    """The parameter of the start is the start itself, and no number that works it out."""
    told = starts(tmp_path, 600.0, 560.0, integrator)
    assert [(d.recording, d.subject) for d in told] == [("run_2", "burner.wall")]
    assert told[0].is_far
