"""An SSP to a scenario: a folder with scenario.yaml, the FMUs and parameter sets, which `cosim run` runs."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from cosim.alone import LOCK
from cosim.scenario import parse_scenario
from cosim.ssp.files import plain_name
from cosim.ssp.fmus import Fmu
from cosim.ssp.graph import Graph
from cosim.ssp.graph import Path as ElementPath
from cosim.ssp.import_components import FmuImport, own_component
from cosim.ssp.import_connections import Ends, connections
from cosim.ssp.import_time import TimeRequest, algorithm, times
from cosim.ssp.model import Component, Structure, Unit
from cosim.ssp.namespaces import FMU_TYPE, OWN_TYPE
from cosim.ssp.package import opened
from cosim.ssp.read import read_structure
from cosim.ssp.values import Bindings
from cosim.unit.errors import InputError


@dataclass(frozen=True)
class Imported:
    """What an import made.

    Args:
        scenario: File of the scenario.
        notes: What an SSP leaves open or holds beyond a scenario, and what was done about it.
        names: Path in the SSP to component, where they differ.
    """

    scenario: Path
    notes: tuple[str, ...]
    names: Mapping[str, str]


@dataclass
class _System:
    """The SSP with everything needed to write its scenario."""

    structure: Structure
    graph: Graph
    fmus: dict[ElementPath, Fmu]
    names: dict[ElementPath, str]
    bindings: Bindings
    notes: list[str] = field(default_factory=list)


def import_ssp(path: Path, out: Path, request: TimeRequest | None = None, variant: str = "") -> Imported:
    """Write the scenario of an SSP into a folder.

    Args:
        path: The .ssp file, or the .ssd file of an unpacked one.
        out: Folder; it must be empty or absent.
        request: Times and algorithm that the SSP leaves open.
        variant: Another .ssd file of the package than SystemStructure.ssd.

    Raises:
        InputError: The SSP breaks the standard, asks for what cannot be carried out, or says no times and `request`
            does not either.
    """
    if out.exists() and (not out.is_dir() or any(p.name != LOCK for p in out.iterdir())):
        raise InputError(out, "", "there is something here already", "give another folder with `--out`")
    with opened(path) as folder:
        system = _read(path, folder, variant)
        try:
            data = _scenario(system, request or TimeRequest(), out)
            text = yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110)
            file = out / "scenario.yaml"
            parse_scenario(text, file)
            file.write_text(text, encoding="utf-8")
        except BaseException:
            shutil.rmtree(out, ignore_errors=True)
            raise
    names = {".".join(p): n for p, n in system.names.items() if ".".join(p) != n}
    return Imported(file, tuple(dict.fromkeys([*system.structure.notes, *system.notes])), names)


def check_ssp(path: Path, variant: str = "") -> tuple[Structure, list[str]]:
    """Read an SSP and follow its connections and bindings, without writing anything.

    Returns:
        Its structure, and notes.

    Raises:
        InputError: See `import_ssp`.
    """
    with opened(path) as folder:
        system = _read(path, folder, variant)
        connections(system.graph, Ends(system.names, system.fmus, system.graph))
    return system.structure, list(dict.fromkeys([*system.structure.notes, *system.notes]))


def _read(path: Path, folder: Path, variant: str) -> _System:
    structure = read_structure(path, folder, variant)
    fmus: dict[ElementPath, Fmu] = {}
    known: dict[Path, Fmu] = {}

    def unit_of(element: ElementPath, name: str) -> Unit | None:
        variable = fmus[element].variables.get(name) if element in fmus else None
        return variable.unit if variable is not None else None

    graph = Graph(structure.system, unit_of)
    for element, component in graph.components.items():
        source = _checked_source(component)
        if component.type == FMU_TYPE:
            if source not in known:
                known[source] = _read_fmu(path, component, source)
            fmus[element] = known[source]
            _check_interface(component, fmus[element])
            _check_connectors(component, fmus[element])
    if not graph.components:
        raise structure.place.error("there is no component in it", "give a system with components")
    notes: list[str] = []

    def has_variable(element: ElementPath, name: str) -> bool:
        return element in fmus and name in fmus[element].variables

    bindings = Bindings(graph, has_variable, notes)
    return _System(structure, graph, fmus, _names(graph), bindings, notes)


def _read_fmu(path: Path, component: Component, source: Path) -> Fmu:
    try:
        return Fmu(source)
    except InputError as error:  # it names the file where the package is unpacked for the moment
        where = f"{source.name}: {error.key}" if error.key else source.name
        raise InputError(path, where, f"{error.problem} (component {component.name})", error.remedy) from error


def _checked_source(component: Component) -> Path:
    if component.type not in (FMU_TYPE, OWN_TYPE):
        raise component.place.error(
            f"`{component.name}` is of type {component.type}", "only FMUs can be run; export it as FMU"
        )
    if component.source is None:
        raise component.place.error(
            f"`{component.name}` has no source: it is a place for a component yet to come", "give it an FMU"
        )
    return component.source


def _check_interface(component: Component, fmu: Fmu) -> None:
    """What is asked for, or anything that can be carried out, is there."""
    if component.implementation in ({"any"} if fmu.interfaces else set()) | set(fmu.interfaces):
        return
    there = " or ".join(sorted(fmu.interfaces))
    remedy = f"ask for {there}, which it has" if there else "export the FMU for Co-Simulation or Model Exchange"
    if component.implementation == "ScheduledExecution" or not there:
        problem = (
            f"`{component.name}` has ScheduledExecution alone"
            if not there
            else (f"`{component.name}` asks for ScheduledExecution")
        )
        raise component.place.error(f"{problem}, which is not carried out", remedy)
    raise component.place.error(f"the FMU of `{component.name}` has no {component.implementation}", remedy)


def _check_connectors(component: Component, fmu: Fmu) -> None:
    for name, connector in component.connectors.items():
        variable = fmu.variables.get(name)
        if variable is None:
            raise connector.place.error(
                f"the FMU of `{component.name}` has no variable `{name}`", "correct the connector"
            )
        if connector.kind not in (variable.causality, "unspecified", "constant"):
            raise connector.place.error(
                f"the connector `{name}` of `{component.name}` is of kind {connector.kind}, the FMU's variable is "
                f"{variable.causality}",
                "make the two agree",
            )


def _names(graph: Graph) -> dict[ElementPath, str]:
    """Component names of the scenario: the path joined by `_`, made unique."""
    names: dict[ElementPath, str] = {}
    for path in graph.components:
        base = plain_name("_".join(path))
        name, count = base, 1
        while name in names.values():
            count += 1
            name = f"{base}_{count}"
        names[path] = name
    return names


def _scenario(system: _System, request: TimeRequest, out: Path) -> dict[str, Any]:
    structure, graph = system.structure, system.graph
    can_serialise = all(f.can_serialise for f in system.fmus.values())
    time = times(structure, request, can_serialise, system.notes)
    out.mkdir(parents=True, exist_ok=True)
    ends = Ends(system.names, system.fmus, graph)
    wired = connections(graph, ends)
    importer = FmuImport(out, system.bindings.values, ends, structure.name)
    components = {
        system.names[path]: own_component(component, out)
        if component.type == OWN_TYPE
        else importer.component(path, component, system.fmus[path])
        for path, component in graph.components.items()
    }
    _note_open_inputs(system, ends)
    data: dict[str, Any] = {"title": structure.name}
    if structure.description:
        data["description"] = structure.description
    data |= {"time": time, "algorithm": algorithm(structure, request, system.notes), "components": components}
    if wired:
        data["connections"] = wired
    return data


def _note_open_inputs(system: _System, ends: Ends) -> None:
    for name, connector in system.structure.system.connectors.items():
        node = ((), name)
        if connector.kind == "input" and node in system.graph.outgoing and node not in system.bindings.values:
            system.notes.append(f"the system's input `{name}` is open: what it leads to keeps its start value")
