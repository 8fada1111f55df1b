"""Closed loops around the FMU of the paper's coil, driven by power: no circuit, so that closed forms hold exactly."""

from __future__ import annotations

import textwrap
from pathlib import Path

import yaml

from cosim.scenario import Scenario, parse_scenario

#: h A and C of the paper's coil.
CONDUCTANCE, CAPACITY = 90 * 97.85e-6, 6450 * 837 * 7.328e-9

LOOP = """
title: loop
time: {stop: STOP s, macro_step: 100 ms, output_step: 100 ms, checkpoint_step: 1 s}
algorithm: {kind: gauss_seidel, order: [room, sensor, controller, actuator]}
components:
  room:
    kind: programme
    outputs: {temperature: {unit: K, constant: 22 degC}}
  sensor: {kind: sensor, unit: K, sample: 100 ms, start: {quantity: 22 degC}}
  controller:
    kind: controller
    groups: [1]
    command_unit: W
    sample: 100 ms
    lowest: 0 W
    highest: 2 W
    setpoint: 60 degC
    law: {kind: pi, gain: 0.05 W/K, integral_time: 4 s}
  actuator:
    kind: fmu
    fmu: thermal_stiffness
    structure: {coils: 1}
    parameter_set: niti_paper
    parameters: {use_regressed_cooling_rate: false}
connections:
  - actuator.temperature -> sensor.quantity
  - sensor.reading -> controller.measured
  - controller.command -> actuator.power
  - room.temperature -> actuator.ambient_temperature
"""


def loop(changes: dict[str, object] | None = None, stop: float = 10.0, folder: Path = Path(".")) -> Scenario:
    """The loop with other values; keys are paths as in a sweep."""
    from cosim.sweep.keys import changed

    data = yaml.safe_load(textwrap.dedent(LOOP).replace("STOP", str(stop)))
    return parse_scenario(yaml.safe_dump(changed(data, changes or {}), sort_keys=False), folder / "loop.yaml")
