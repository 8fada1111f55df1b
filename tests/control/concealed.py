"""Two coils under control, with an effect that the controller hides: recordings of it, and the plant as believed."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import yaml

from cosim.run import run
from cosim.scenario import Scenario, scenario_of_data

PLANT = """
title: Two coils in parallel on one supply, 100 g below each
time: {start: 0 s, stop: 120 s, macro_step: 50 ms, output_step: 100 ms, checkpoint_step: 60 s}
algorithm: {kind: gauss_seidel, order: [supply, room, circuit, actuator, load]}
components:
  supply:
    kind: programme
    outputs:
      voltage: {unit: V, constant: 0 V}
  room:
    kind: programme
    outputs:
      temperature: {unit: K, constant: 22 degC}
  circuit: {kind: ngspice, strings: [1, 1], supply: common, start: {resistance: 2.2 ohm}}
  actuator:
    kind: actuator
    fmu: thermal_stiffness
    electrical: circuit
    ambient: room
    mechanical: load
    parameters: {use_regressed_cooling_rate: false}
  load: {kind: hanging_mass, coils: 2, mass: 100 g}
connections:
  - supply.voltage -> circuit.supply_voltage
"""
CONTROL = """
thermometer:
  {kind: sensor, unit: K, elements: 2, sample: 100 ms, noise: 0.1 K, quantum: 0.05 K, start: {quantity: 22 degC}}
controller:
  kind: controller
  groups: [2]
  supply: common
  sample: 100 ms
  lowest: 0 V
  highest: 1.8 V
  drive: squared
  combine: max
  setpoint: 22 degC
  law: {kind: pi, gain: 0.25 V^2/K, integral_time: 4.5 s, feedforward: 0.0194 V^2/K, ambient: 22 degC}
"""
#: What the truth has and the plant model lacks: a path of the scenario and its value.
EFFECTS = {
    "none": (),
    "resistance": (("actuator.parameters.resistance_temperature_coefficient", "0.0011 1/K"),),
    "contact": (("circuit.string_resistance", "0.15 ohm"),),
    "thermometer": (("thermometer.bias", ["0 K", "3 K"]),),
    "drift": (("thermometer.drift", "0.02 K/s"),),
}
#: Setpoints [degC] from times [s] on.
DAYS = {
    "monday": [(0, 22), (5, 50), (40, 58), (75, 45), (100, 22)],
    "tuesday": [(0, 22), (4, 42), (30, 56), (60, 48), (90, 22)],
    "wednesday": [(0, 22), (6, 54), (35, 40), (70, 60), (95, 22)],
}


def closed_loop(effect: str, day: str) -> Scenario:
    """The truth: plant, thermometers and controller."""
    data = yaml.safe_load(PLANT)
    parts = data["components"]
    parts |= yaml.safe_load(CONTROL)
    del parts["supply"]
    points = [[f"{t} s", f"{v} degC"] for t, v in DAYS[day]]
    parts["request"] = {"kind": "programme", "outputs": {"temperature": {"unit": "K", "points": points}}}
    parts["thermometer"]["seed"] = sorted(DAYS).index(day)
    data["algorithm"]["order"] = ["room", "request", "thermometer", "controller", "circuit", "actuator", "load"]
    data["connections"] = [
        "actuator.temperature -> thermometer.quantity",
        "thermometer.reading -> controller.measured",
        "request.temperature -> controller.setpoint",
        "controller.command -> circuit.supply_voltage",
    ]
    for path, value in EFFECTS[effect]:
        at = parts
        *way, last = path.split(".")
        for key in way:
            at = at.setdefault(key, {})
        at[last] = value
    return scenario_of_data(data, Path("closed_loop.yaml"))


def record(folder: Path, effect: str, day: str) -> None:
    """One day as a folder with recording.yaml and a table; what drove is a recorded input."""
    found = run(closed_loop(effect, day))
    random = np.random.default_rng(100 + sorted(DAYS).index(day))
    time = found["time"].values
    # What drives from a time on is recorded at the end of the step that it drove.
    volts = np.append(found["controller.command"].values[1:], found["controller.command"].values[-1])
    reading = found["thermometer.reading"].values - 273.15
    stretch = 1e3 * found["load.extension"].values
    current = 1e3 * found["circuit.string_current"].values
    rows = [["time_s", "U_V", "T1_degC", "T2_degC", "x1_mm", "x2_mm", "I1_mA", "I2_mA"]]
    for i in range(len(time)):
        row = [f"{time[i]:.1f}", f"{volts[i]:.6f}"]
        if i % 5 == 0:
            x, a = stretch[i] + random.normal(0, 0.1, 2), current[i] + random.normal(0, 2.0, 2)
            row += [f"{v:.2f}" for v in (*reading[i], *x)] + [f"{v:.0f}" for v in a]
        else:
            row += [""] * 6
        rows.append(row)
    folder.mkdir(parents=True)
    with (folder / "measured.csv").open("w", newline="") as stream:
        csv.writer(stream).writerows(rows)
    channels = {}
    for coil in (1, 2):
        channels[f"coil[{coil},1].temperature"] = {
            "column": f"T{coil}_degC",
            "unit": "degC",
            "noise": "0.1 degC",
            "quantum": "0.05 degC",
            "bias_bound": "0.5 degC",
        }
        channels[f"coil[{coil},1].extension"] = {
            "column": f"x{coil}_mm",
            "unit": "mm",
            "noise": "0.1 mm",
            "quantum": "0.01 mm",
        }
        channels[f"string[{coil}].current"] = {
            "column": f"I{coil}_mA",
            "unit": "mA",
            "noise": "2 mA",
            "quantum": "1 mA",
        }
    sidecar = {
        "title": f"Under control, {day}",
        "table": "measured.csv",
        "time": {"column": "time_s", "unit": "s", "zero": 0},
        "overrides": {"time": {"stop": "120 s"}},
        "inputs": {"supply.voltage": {"column": "U_V", "unit": "V"}},
        "channels": channels,
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False))


def rig(folder: Path, effect: str) -> Path:
    """Plant and three days; returns the scenario."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scenario.yaml").write_text(PLANT.lstrip())
    for day in DAYS:
        record(folder / day, effect, day)
    return folder / "scenario.yaml"
