"""Recordings of small fabrics, made by the closed co-simulation with other numbers than the scenario says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue
from diagnosis.models.fabric.camera import CAMERA_LAWS
from diagnosis.models.fabric.laws import LINK_LAWS, fabric_laws
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording

SMALL, DRAPE = Path(__file__).with_name("small.yaml"), Path(__file__).with_name("drape.yaml")
SENSORS = SensorFile.model_validate(
    {
        "default": {"rate": "20 Hz", "noise": "0.2 mm", "unit": "m"},
        "channels": {
            "coil.temperature": {"rate": "10 Hz", "noise": "0.3 K"},
            "supply.current": {"rate": "20 Hz", "noise": "3 mA", "unit": "A"},
        },
    }
)
ELECTRICAL = ["supply.current", "coil[1,1].temperature", "coil[3,2].temperature"]
MARKERS = [f"marker[{i}].{axis}" for i in range(5, 11) for axis in "xyz"] + ["link[15].length", "link[12].length"]


def laws_but(*kept: str) -> list[str]:
    """Identifiers of all laws of a fabric, its links and its camera, without some: few simulations do then."""
    every = {law.place.term.identifier for law in fabric_laws("")} | LINK_LAWS | CAMERA_LAWS
    assert every > set(kept)
    return sorted(every - set(kept))


def with_fabric(scenario: Scenario, **numbers: str) -> Scenario:
    """The scenario with other parameters of its fabric."""
    fabric = scenario.components["fabric"]
    given = {name: PhysicalValue.parse(text) for name, text in numbers.items()}
    own = fabric.model_copy(update={"parameters": {**fabric.parameters, **given}})
    return scenario.model_copy(update={"components": {**scenario.components, "fabric": own}})


def shortened(scenario: Scenario, stop: float) -> Scenario:
    """The scenario up to a time [s]."""
    return scenario.model_copy(update={"time": scenario.time.model_copy(update={"stop": PhysicalValue(stop, "s")})})


def made(folder: Path, seed: int, channels: list[str], scenario: Scenario, **truth: str) -> Recording:
    """A recording of a fabric that starts by itself, with a random start of its own and other numbers."""
    start = {"start_speed": "1 mm/s", "start_number": str(1000 + seed)}
    results = run(with_fabric(scenario, **start, **truth))
    write_recording(folder, read_results(results, channels, SENSORS, seed, folder), Notes("fabric"))
    return load_recording(folder)


def small() -> Scenario:
    """5 x 2 links for a second."""
    return load_scenario(SMALL)


def still(folder: Path, **keys: object) -> Recording:
    """A marker and a current of the small fabric, over its second; the values stand still."""
    folder.mkdir()
    time = np.linspace(0.0, 0.98, 50)
    table = np.column_stack([time, np.full(50, 0.01), np.where(time < 0.2, 0.0, 1.1)])
    np.savetxt(folder / "data.csv", table, delimiter=",", header="time,z,i", comments="", fmt="%.4f")
    channels = {
        "marker[5].z": {"column": "z", "unit": "m", "noise": "0.2 mm"},
        "supply.current": {"column": "i", "unit": "A", "noise": "3 mA"},
    }
    given = {
        "title": folder.name,
        "table": "data.csv",
        "time": {"column": "time", "unit": "s", "zero": 0.0},
        "channels": channels,
        **keys,
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(given), encoding="utf-8")
    return load_recording(folder)
