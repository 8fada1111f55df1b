"""A dead time of one input among several: it is no clock of the readings."""

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

STEP, COUNT = 30.0, 450
#: Air and wall of a room with a heater; it is warmed and cooled through the wall.
ROOM = OdeModel(
    "room",
    {"C_a": (4e4, "J/K"), "C_w": (4e5, "J/K"), "g": (120.0, "W/K"), "k": (40.0, "W/K"), "T_0": (293.15, "K")},
    {"power": "W", "outside": "K"},
    {
        "T_a": ("K", "T_0", "(power - g*(T_a - T_w))/C_a"),
        "T_w": ("K", "T_0", "(g*(T_a - T_w) - k*(T_w - outside))/C_w"),
    },
    {"air": ("K", "T_a"), "wall": ("K", "T_w")},
)
SCENARIO = """
title: A room
time: {stop: 13470 s, macro_step: 30 s, output_step: 30 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, constant: 0 W}, outside: {unit: K, constant: 285 K}}}
  room: {kind: fmu, fmu: room.fmu, integrator: cvode}
connections: [drive.power -> room.power, drive.outside -> room.outside]
"""


def _doubts(folder: Path, late: float) -> tuple[Doubt, ...]:
    """Of three recordings in which the heater acts `late` s after its column."""
    ROOM.build(folder)
    path = folder / "scenario.yaml"
    path.write_text(SCENARIO, encoding="utf-8")
    every = []
    times = STEP * np.arange(COUNT)
    for number in range(3):
        rng = np.random.default_rng(70 + number)
        ends = np.cumsum(rng.integers(35, 100, 15))
        power = rng.uniform(150.0, 1450.0, 16)[np.searchsorted(ends, np.arange(COUNT), side="right")]
        outside = 278.0 + 6.0 * np.sin(2.0 * np.pi * times / 9000.0 - 1.5)

        def rate(x: Array, u: float, warm: Array = power, cold: Array = outside) -> Array:
            now = min(max(u - late, 0.0), times[-1])
            power_now = warm[int(now / STEP)]
            outdoors = np.interp(u, times, cold)
            return np.array(
                [
                    (power_now - 123.0 * (x[0] - x[1])) / 3.9e4,
                    (123.0 * (x[0] - x[1]) - 39.0 * (x[1] - outdoors)) / 4.1e5,
                ]
            )

        states = held(rate, np.array([293.15, 293.15]), times, STEP)
        columns = {
            "t": times,
            "p": power,
            "o": outside,
            "air": states[:, 0] + 0.03 * rng.standard_normal(COUNT),
            "wall": states[:, 1] + 0.01 * rng.standard_normal(COUNT),
        }
        channels = {"room.air": ("air", "K", "0.03 K"), "room.wall": ("wall", "K", "0.01 K")}
        inputs = {"drive.power": ("p", "W"), "drive.outside": ("o", "K")}
        every.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    return check_recordings(load_scenario(str(path)), every)


@pytest.mark.parametrize("late", [150.0, 210.0, 300.0])
def test_a_heater_that_acts_late_accuses_no_clock(tmp_path: Path, late: float) -> None:
    doubts = _doubts(tmp_path, late)
    assert not [d for d in doubts if d.is_serious]
