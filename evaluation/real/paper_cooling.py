"""The recordings that the paper's regressions imply: coils that heat at 0.2226 1/s and cool at 0.14 1/s.

Equation (3) heats with h A / (rho c V) = 0.2226 1/s, equation (5) cools with a rate of 0.14 1/s that was found by
regression. One lump with one coefficient cannot do both; here is what a laboratory with the paper's coils would have
recorded, as a task for the diagnosis. `python -m evaluation.real.paper_cooling --out DIR` writes it.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import yaml

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.recording.readings import read_results
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording

#: Recording to the voltage of each of the six coils, and when it is cut.
_PROGRAMMES = {
    "first": ((0.5, 0.7, 0.8, 0.9, 1.0, 1.2), 40.0),
    "other": ((0.6, 0.75, 0.85, 0.95, 1.1, 1.15), 25.0),
}
_STOP = 80.0  # [s]
#: A thermocouple and a clip-on ammeter.
_SENSORS = {
    "coil.temperature": {"rate": "2 Hz", "noise": "0.3 degC", "unit": "degC"},
    "string.current": {"rate": "2 Hz", "noise": "3 mA", "unit": "A"},
}


def write(out: Path) -> None:
    """Write recordings, the simple scenario and `splits.yaml` into `out/paper_cooling`.

    Raises:
        InputError: The folder holds recordings already, or cannot be written.
    """
    folder = out / "paper_cooling"
    shipped = load_scenario("single_coil_heating")
    assert shipped.path is not None, "shipped scenarios are files"
    data: dict[str, Any] = parse_yaml(read_text(shipped.path), shipped.path)
    channels = [
        f"{kind}[{n},1].temperature" if kind == "coil" else f"{kind}[{n}].current"
        for kind in ("coil", "string")
        for n in range(1, 7)
    ]
    for seed, (name, (volts, cut)) in enumerate(_PROGRAMMES.items()):
        points = [["0 s", [f"{v} V" for v in volts]], [f"{cut:g} s", ["0 V"] * 6]]
        change = {"components": {"supply": {"outputs": {"voltage": {"points": points}}}}}
        data["components"]["supply"]["outputs"]["voltage"]["points"] = points
        made = parse_scenario(yaml.safe_dump(data, sort_keys=False), shipped.path)
        sensors = SensorFile.model_validate({"channels": _SENSORS})
        read = read_results(run(made), channels, sensors, seed, folder)
        title = f"Six coils for {cut:g} s, as equations (3) and (5) of the paper have it"
        notes = Notes(
            title, "made from the paper's regressions, not measured", {"time": {"stop": f"{_STOP:g} s"}, **change}
        )
        write_recording(folder / name, read, notes)
    data["title"] = "Single coils that cool as they heat"
    data["description"] = "Equation (3) alone: one lump with one coefficient of heat transfer, heating and cooling."
    data["components"]["actuator"]["parameters"] = {"use_regressed_cooling_rate": False}
    (folder / "simple.yaml").write_text(yaml.safe_dump(data, sort_keys=False), encoding="utf-8")
    splits = {"scenario": "simple.yaml", "splits": {"other voltages": {"training": ["first"], "held_out": ["other"]}}}
    (folder / "splits.yaml").write_text(yaml.safe_dump(splits, sort_keys=False), encoding="utf-8")


def main(arguments: list[str] | None = None) -> int:
    """Write it; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.real.paper_cooling", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder for the recordings")
    try:
        write(parser.parse_args(arguments).out)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
