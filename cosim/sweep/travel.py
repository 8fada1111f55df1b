"""Scenarios on their way to where they are run: as text, with a key that says everything that decides their result."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

from cosim.components import FmuComponent
from cosim.compute.package import Packer
from cosim.fmu_assembly import find_fmu
from cosim.parameters import Resolved, resolve
from cosim.run_folder import resolved_scenario
from cosim.scenario import Scenario
from cosim.sweep.one_run import Shared
from cosim.unit.errors import InputError


def packed_text(scenario: Scenario, packer: Packer) -> str:
    """The scenario as text that needs no file but those of the packer.

    Raises:
        InputError: A parameter set is wrong.
    """
    # Parameter sets of actuators are named when they are resolved; names alone travel, since every worker has them.
    data = json.loads(resolved_scenario(scenario, _sets(scenario)).model_dump_json(exclude_none=True))
    return json.dumps(packer.packed(data, (scenario.path or Path()).parent))


def _sets(scenario: Scenario) -> dict[str, Any]:
    source = scenario.path or Path("scenario")
    found = {}
    for name, component in scenario.components.items():
        given = getattr(component, "parameter_set", None)
        own = dict(getattr(component, "parameters", {}))
        try:
            found[name] = resolve(given, own, source) if given is not None else Resolved({}, {})
        except InputError as error:
            raise error.within(name, source) from error
    return found


def run_key(shared: Shared, text: str) -> str:
    """Hash of files, program, scenario, shipped FMUs, and what is read off the run."""
    asked = json.dumps(
        [
            {n: o.model_dump(mode="json", by_alias=True) for n, o in part.items()}
            for part in (shared.outputs, shared.series)
        ]
    )
    return hashlib.sha256(f"{shared.files.digest} {asked} {text} {_shipped(text)}".encode()).hexdigest()


_SHIPPED: dict[str, str] = {}


def _shipped(text: str) -> str:
    """Hashes of the shipped FMUs of a scenario: one that was built anew makes other runs."""
    found = []
    for name, given in json.loads(text)["components"].items():
        if given.get("fmu") and not given["fmu"].endswith(".fmu"):
            component = FmuComponent.model_construct(**{"fmi": 3, "structure": {}, **given})
            file = find_fmu(component, Path(name))
            if str(file) not in _SHIPPED:
                _SHIPPED[str(file)] = hashlib.sha256(file.read_bytes()).hexdigest()
            found.append(_SHIPPED[str(file)])
    return " ".join(found)
