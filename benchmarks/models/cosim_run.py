"""The same systems run by this project's own tool, through a scenario of plain FMU components."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import yaml

from benchmarks.models.systems import System
from cosim.run import run
from cosim.scenario import Scenario, parse_scenario

MODELS = Path(__file__).resolve().parent


#: Name of an algorithm, or what a scenario says under `algorithm`.
Method = str | dict[str, Any]


def scenario(
    system: System, version: int, step: float, method: Method = "jacobi", output_step: float | None = None
) -> dict[str, Any]:
    """What a user would write, as the mapping that a scenario file holds.

    Args:
        system: What to simulate.
        version: FMI version, 2 or 3.
        step: Macro-step [s].
        method: Algorithm.
        output_step: Interval of recorded values [s]; None: the end alone.
    """
    steps = round(system.stop / step)
    output = step * steps if output_step is None else output_step
    components: dict[str, dict[str, Any]] = {
        name: {"kind": "fmu", "fmu": str(system.fmu(name, version))} for name in system.components
    }
    # Inputs that close a loop start from zero unless the system says otherwise.
    values = {(wire.target, wire.input): 0.0 for wire in system.connections} | system.start
    for (name, variable), value in values.items():
        row = tomllib.loads((MODELS / system.components[name] / "model.toml").read_text())["variables"][variable]
        key = "parameters" if row["causality"] == "parameter" else "start"
        unit = "" if row["unit"] == "1" else row["unit"]
        components[name].setdefault(key, {})[variable] = f"{value!r} {unit}".strip()
    return {
        "title": "measured system",
        "time": {
            "stop": f"{system.stop:.9g} s",
            "macro_step": f"{step * 1e9:.0f} ns",
            "output_step": f"{output * 1e9:.0f} ns",
            "checkpoint_step": f"{step * steps * 1e9:.0f} ns",
        },
        "algorithm": {"kind": method} if isinstance(method, str) else method,
        "components": components,
        "connections": [f"{c.source}.{c.output} -> {c.target}.{c.input}" for c in system.connections],
    }


def load(
    system: System, version: int, step: float, method: Method = "jacobi", output_step: float | None = None
) -> Scenario:
    """The scenario, checked."""
    text = yaml.safe_dump(scenario(system, version, step, method, output_step), sort_keys=False)
    return parse_scenario(text, Path("benchmark.yaml"))


def simulate(system: System, version: int, step: float, method: Method = "jacobi") -> tuple[float, ...]:
    """Outputs of `system` at its stop time."""
    result = run(load(system, version, step, method))
    return tuple(float(result[f"{name}.{variable}"].values[-1]) for name, variable in system.outputs)
