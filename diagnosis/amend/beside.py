"""Files beside a scenario that its copy in another folder needs."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from cosim.parameters import find_parameter_set
from cosim.scenario import Scenario, scenario_folder


def take_along(scenario: Scenario, data: dict[str, Any], folder: Path) -> None:
    """Copy parameter sets beside the scenario, and name FMUs beside it from the other folder.

    Args:
        scenario: The scenario as it is.
        data: The YAML content of its copy; names of FMUs are changed in it.
        folder: Where the copy goes.
    """
    assert scenario.path is not None, "the scenario was read from a file"
    shipped = scenario_folder() / "parameter_sets"
    for name, component in data["components"].items():
        original = scenario.components.get(name)
        fmu = component.get("fmu") or ""
        if fmu.endswith(".fmu") and fmu == getattr(original, "fmu", None):
            beside = scenario.path.parent / fmu
            component["fmu"] = os.path.relpath(beside if beside.is_file() else fmu, folder)
        parameter_set = component.get("parameter_set")
        if parameter_set is None:
            continue
        path = find_parameter_set(parameter_set, scenario.path)
        if path.parent != shipped:
            target = folder / parameter_set
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
