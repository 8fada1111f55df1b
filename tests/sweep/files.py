"""A small scenario and sweeps over it."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COIL = (ROOT / "docs" / "examples" / "sweeps" / "one_coil.yaml").read_text()
SWEEP = """
title: t
scenario: coil.yaml
axes:
  voltage: {key: "supply.outputs.voltage.constant", values: [0.6 V, 0.8 V, 1.0 V]}
  volume:
    zip:
      - {key: components.actuator.parameters.volume, values: [7 mm^3, 8 mm^3]}
      - {key: room.outputs.temperature.constant, values: [22 degC, 25 degC]}
outputs:
  hottest: {quantity: actuator.temperature, over: max, unit: degC}
  energy: {quantity: energy}
  integral: {quantity: circuit.power, over: integral, from: 0 s, to: 2 s}
series:
  temperature: {quantity: actuator.temperature}
"""


def written(folder: Path, sweep: str = SWEEP, stop: str = "4 s") -> Path:
    """Scenario and sweep in a folder; returns the sweep file."""
    folder.mkdir(parents=True, exist_ok=True)
    coil = COIL.replace("stop: 30 s", f"stop: {stop}").replace("checkpoint_step: 10 s", "checkpoint_step: 2 s")
    coil = coil.replace("points: [[0 s, 0 V], [1 s, 1 V], [21 s, 0 V]]", "constant: 1 V")
    (folder / "coil.yaml").write_text(coil)
    path = folder / "sweep.yaml"
    path.write_text(sweep)
    return path
