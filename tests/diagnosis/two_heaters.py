"""Two heaters in a room, recorded with a known start and room that the recording need not know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import yaml

from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording

NOISE = 0.05  # K
SCENARIO = """
title: Two heaters
time: {stop: 40 s, macro_step: 100 ms, output_step: 200 ms, checkpoint_step: 10 s}
components:
  drive:
    kind: programme
    outputs:
      power_1: {unit: W, points: [[0 s, 0 W], [8 s, 0.3 W], [24 s, 0 W]]}
      power_2: {unit: W, points: [[0 s, 0 W], [16 s, 0.2 W], [32 s, 0 W]]}
  room: {kind: programme, outputs: {temperature: {unit: K, constant: 21 degC}}}
  heaters:
    kind: fmu
    fmu: FMU
    structure: {coils: 2}
    parameters: {PARAMETERS}
connections:
  - drive.power_1 -> heaters.power[1]
  - drive.power_2 -> heaters.power[2]
  - room.temperature -> heaters.ambient_temperature
"""


def scenario(
    folder: Path, fmu: str = "thermal_stiffness", parameters: str = "initial_temperature: 21 degC"
) -> Scenario:
    """The model; of the coil network where its FMU is thermal_stiffness."""
    if fmu == "thermal_stiffness":
        parameters = f"use_regressed_cooling_rate: false, {parameters}".rstrip(", ")
    file = folder / "scenario.yaml"
    file.write_text(SCENARIO.replace("FMU", fmu).replace("PARAMETERS", parameters), encoding="utf-8")
    return load_scenario(file)


def conditions(starts: object = None, room: str | None = None, **coils: object) -> dict[str, Any]:
    """Overrides of a room and of the coils' parameters."""
    own = {**coils, **({"initial_temperature": starts} if starts is not None else {})}
    found: dict[str, Any] = {"heaters": {"parameters": own}} if own else {}
    if room is not None:
        found["room"] = {"outputs": {"temperature": {"constant": room}}}
    return {"components": found}


def record(
    base: Scenario,
    folder: Path,
    truth: Mapping[str, Any],
    seed: int,
    said: Mapping[str, Any] | None = None,
    channels: str = "coil[*].temperature",
    **keys: Any,
) -> Recording:
    """A recording of what truly was, that says something else of it.

    Args:
        base: The model.
        folder: Of the recording.
        truth: Overrides under which it is simulated.
        seed: Of the noise.
        said: Overrides that it states.
        channels: What is measured.
        keys: Further keys of recording.yaml.
    """
    sensors = SensorFile.model_validate(
        {
            "default": {"rate": "5 Hz", "noise": "1e-6"},
            "channels": {
                "coil.temperature": {"rate": "5 Hz", "unit": "K", "noise": f"{NOISE} K"},
                "coil.stiffness": {"rate": "5 Hz", "noise": "0.5 N/m"},
            },
        }
    )
    empty = Recording(folder, "", {}, (), truth, base.time.stop.to("s"), 0.0)
    results = run(scenario_of(base, empty))
    read = read_results(results, channels.split(), sensors, seed, folder)
    write_recording(folder, read, Notes(folder.name, "", dict(said or {})))
    file = folder / "recording.yaml"
    file.write_text(yaml.safe_dump({**yaml.safe_load(file.read_text()), **keys}, sort_keys=False))
    return replace(load_recording(file), title=folder.name)
