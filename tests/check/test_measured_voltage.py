"""The voltage of a source that gives what the coils draw is not that of its programme: numbers that are off move it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.check.beside import compare
from diagnosis.check.input_doubts import voltages
from diagnosis.recording.recording import load_recording
from tests.systems.rigs import write_recording

SCENARIO = """\
title: One coil
time: {stop: 20 s, macro_step: 0.05 s, output_step: 0.1 s}
components:
  bench: {kind: programme, outputs: {voltage: {unit: V, points: [[0 s, 1 V], [5 s, 3 V], [12 s, 2 V]]}}}
  room: {kind: programme, outputs: {temperature: {unit: degC, constant: 20 degC}}}
  circuit:
    kind: ngspice
    strings: [1]
    supply: common
    start: {resistance: 2 ohm}
  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room}
connections: [bench.voltage -> circuit.supply_voltage]
"""


@pytest.mark.parametrize(
    ("more", "count"),
    [
        ("", 1),
        ("    supply_resistance: 0.3 ohm\n", 0),
        ("    elements: [{kind: current_limit, limit: 1 A}]\n", 0),
        ("    elements: [{kind: slow_source, delay: 0.5 s}]\n", 0),
        ("    elements: [{kind: contact, string: 1, resistance: 0.1 ohm}]\n", 1),
    ],
    ids=["stiff", "resistance", "limit", "slow", "contact"],
)
def test_a_source_that_gives_what_is_drawn_is_not_held_against_its_programme(
    tmp_path: Path, more: str, count: int
) -> None:
    (tmp_path / "scenario.yaml").write_text(SCENARIO.replace("    start:", more + "    start:"), encoding="utf-8")
    times = 0.1 * np.arange(200)
    volts = 0.8 * np.select([times < 5.0, times < 12.0], [1.0, 3.0], 2.0)
    folder = write_recording(tmp_path / "run", {"t": times, "u": volts}, {}, {"supply.voltage": ("u", "V", "10 mV")})
    compared = compare(load_scenario(tmp_path / "scenario.yaml"), load_recording(folder))
    assert len([one for one in voltages(compared) if one.kind == "scaled"]) == count
