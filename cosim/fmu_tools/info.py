"""`cosim fmu info`: what an FMU is and has."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from cosim.actuator.interface import PORTS, faults
from cosim.fmu.archive import FmuArchive, open_fmu
from cosim.fmu.gathering import fmu_variables
from cosim.fmu.sizes import StructureFault
from cosim.fmu.units import UnitNames
from cosim.fmu.variables import FmuVariable
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, Variable

_CAPABILITIES = (
    "canHandleVariableCommunicationStepSize",
    "canGetAndSetFMUstate",
    "canSerializeFMUstate",
    "hasEventMode",
    "mightReturnEarlyFromDoStep",
    "canReturnEarlyAfterIntermediateUpdate",
    "providesDirectionalDerivative",
    "providesDirectionalDerivatives",
    "needsExecutionTool",
    "canBeInstantiatedOnlyOncePerProcess",
)
#: Room that a description needs beside the other columns; with less it stands below.
_DESCRIPTION = 30


@dataclass(frozen=True)
class FmuInfo:
    """What `cosim fmu info` shows.

    Args:
        general: Key to text: version, interfaces, capabilities, structure, states, files.
        variables: One row per variable: name, causality, type, shape, unit, start, description.
        actuator: Faults of the actuator interface; empty for an actuator.
    """

    general: dict[str, str]
    variables: list[dict[str, Any]]
    actuator: list[str]

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        verdict = {"is_actuator": not self.actuator, "faults": self.actuator}
        return {"general": self.general, "actuator": verdict, "variables": self.variables}


def read_info(path: Path) -> FmuInfo:
    """Read an FMU's description and file list; nothing in it is executed.

    Raises:
        InputError: It is no FMU.
    """
    archive = open_fmu(path)
    try:
        variables = fmu_variables(archive.description, {}, UnitNames(archive.description))
        general = _general(archive, variables)
    except StructureFault as error:
        raise InputError(path, "modelDescription.xml", str(error), error.remedy or "correct its description") from error
    finally:
        archive.remove()
    rows = [_row(name, v) for name, v in variables.items()]
    return FmuInfo(general, rows, faults({n: v.variable for n, v in variables.items()}))


def looks_like_actuator(variables: Mapping[str, Variable]) -> bool:
    """Whether the outputs say that it is meant to be an actuator; a temperature alone does not."""
    telling = {p.name for p in PORTS if p.causality is Causality.OUTPUT and p.is_required} - {"temperature"}
    return any(n in telling and v.causality is Causality.OUTPUT for n, v in variables.items())


def _general(archive: FmuArchive, variables: dict[str, FmuVariable]) -> dict[str, str]:
    d = archive.description
    found = {
        "model": d.modelName or "",
        "FMI version": d.fmiVersion,
        "description": d.description or "",
        "made by": d.generationTool or "",
        "token": getattr(d, "instantiationToken", None) or d.guid,
    }
    for kind, declared in (
        ("Co-Simulation", d.coSimulation),
        ("Model Exchange", d.modelExchange),
        ("Scheduled Execution", d.scheduledExecution),
    ):
        if declared is not None:
            able = [c for c in _CAPABILITIES if getattr(declared, c, False)]
            found[kind] = ", ".join(able) or "no capabilities"
    structural = [f"{n} = {v.declared[0].start}" for n, v in variables.items() if v.is_structural]
    found["structure"] = ", ".join(structural) or "fixed"
    found["continuous states"] = ", ".join(_states(archive, variables)) or "none"
    if d.defaultExperiment is not None:
        experiment = d.defaultExperiment
        given = [(k, getattr(experiment, k)) for k in ("startTime", "stopTime", "stepSize", "tolerance")]
        found["default experiment"] = ", ".join(f"{k} {v}" for k, v in given if v is not None)
    with zipfile.ZipFile(archive.path) as content:
        names = content.namelist()
    found["platforms"] = ", ".join(sorted({n.split("/")[1] for n in names if n.startswith("binaries/")} - {""}))
    found["sources inside"] = "yes" if any(n.startswith("sources/") for n in names) else "no"
    found["licence inside"] = "yes" if any("licen" in n.lower() for n in names) else "no"
    return {k: str(v) for k, v in found.items() if v}


def _states(archive: FmuArchive, variables: dict[str, FmuVariable]) -> list[str]:
    """Names of the continuous states: what a declared derivative derives."""
    derived = {id(v.derivative) for v in archive.description.modelVariables if v.derivative is not None}
    return [n for n, v in variables.items() if any(id(declared) in derived for declared in v.declared)]


def _row(name: str, v: FmuVariable) -> dict[str, Any]:
    declared = v.declared[0]
    return {
        "name": name,
        "causality": declared.causality or "local",
        "variability": declared.variability or "",
        "type": v.variable.type.value,
        "shape": list(v.variable.shape),
        "unit": v.variable.unit,
        "start": declared.start,
        "description": v.variable.description,
    }


def show_info(path: Path, info: FmuInfo, console: Console) -> None:
    """Print both tables."""
    head = Table(box=None, show_header=False, title=str(path), title_justify="left", pad_edge=False)
    head.add_column()
    head.add_column(overflow="fold")
    for key, text in info.general.items():
        head.add_row(key, text)
    head.add_row("actuator", "yes" if not info.actuator else "no: " + info.actuator[0])
    console.print(head)
    console.print()
    console.print(_variables(info.variables, console.width), soft_wrap=False)


def _variables(rows: list[dict[str, Any]], width: int) -> Table:
    """One row per variable; where a terminal has no room for descriptions, they stand below the table."""
    headings = ("variable", "causality", "type", "unit", "start")
    cells = [
        (
            row["name"],
            row["causality"],
            row["type"] + "".join(f"[{size}]" for size in row["shape"]),
            row["unit"],
            _short(row["start"]),
        )
        for row in rows
    ]
    taken = sum(max(len(line[k]) for line in [headings, *cells]) + 2 for k in range(len(headings)))
    has_room = taken + _DESCRIPTION <= width
    table = Table(box=None, pad_edge=False, padding=(0, 1) if has_room else (0, 1, 0, 0))
    for heading in headings:
        table.add_column(heading, no_wrap=has_room, overflow="fold")
    if has_room:
        table.add_column("description", overflow="fold")
    for line, row in zip(cells, rows, strict=True):
        table.add_row(*map(escape, line), *([escape(row["description"])] if has_room else []))
    if has_room or not any(row["description"] for row in rows):
        return table
    both = Table.grid()
    both.add_row(table)
    both.add_row("")
    for row in rows:
        if row["description"]:
            both.add_row(escape(f"{row['name']}: {row['description']}"))
    return both


def _short(start: str | None) -> str:
    """A start value of six digits; of an array its first element."""
    words = (start or "").split()
    try:
        first = f"{float(words[0]):.6g}" if words else ""
    except ValueError:
        first = (start or "")[:16]
    return first if len(words) < 2 else f"{first} ..."
