"""A scenario to an SSP: one .ssp file with the description, the FMUs, parameter sets and components of ours."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from cosim.assemble import Assembly, added_inputs, assemble
from cosim.components import FmuComponent, nanoseconds
from cosim.connection import Connection
from cosim.fmu_assembly import find_fmu
from cosim.parameters import Resolved, find_parameter_set
from cosim.scenario import ScaledConnection, Scenario
from cosim.ssp.document import Document, validate
from cosim.ssp.elements import to_bytes
from cosim.ssp.export_parts import Part
from cosim.ssp.fmus import Fmu
from cosim.ssp.import_components import OWN_KEYS
from cosim.ssp.model import IDENTITY, End, Linear
from cosim.ssp.namespaces import DEFAULT_SSD, FMU_TYPE, OWN_TYPE, SSD, SSV, Version, tag
from cosim.ssp.package import write
from cosim.ssp.replaced import Replaced
from cosim.ssp.write import WrittenComponent, WrittenConnection, WrittenStructure, description
from cosim.ssp.write_parameters import Entry, parameter_set
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS

_IMPLEMENTATIONS = {"internal": "CoSimulation", "cvode": "ModelExchange"}


@dataclass
class _Export:
    """An export in progress."""

    scenario: Scenario
    source: Path
    version: Version
    parts: dict[str, Part]
    entries: dict[str, bytes] = field(default_factory=dict)


def export_ssp(scenario: Scenario, out: Path, version: Version = "2.0", only_fmus: bool = False) -> tuple[str, ...]:
    """Write a scenario as an SSP.

    Args:
        scenario: What to export; it is assembled first, so that only what runs is written.
        out: The .ssp file.
        version: Version of SSP.
        only_fmus: Leave out components that are no FMU, for tools that know FMUs alone: constants of a programme go
            out as start values, everything else that these components give becomes an input of the system.

    Returns:
        What a reader of the file does not find in it.

    Raises:
        InputError: The scenario is wrong, or the version of SSP cannot hold it.
    """
    assembly = assemble(scenario)
    source = scenario.path or Path("scenario")
    try:
        parts = {n: _part(n, assembly, source, version) for n in assembly.scenario.components}
        export = _Export(assembly.scenario, source, version, parts)
        structure, notes = _structure(export, assembly, only_fmus)
        top = description(structure)
    except ValueError as error:
        remedy = "export as SSP 2.0, or use FMI 2.0 FMUs (`fmi: 2`)" if version == "1.0" else "correct the scenario"
        raise InputError(source, "", f"it cannot be written as SSP {version}: {error}", remedy) from error
    finally:
        assembly.system.terminate()
    validate(Document(out, DEFAULT_SSD, top, []), top, tag(SSD, "SystemStructureDescription"))
    write(out, {DEFAULT_SSD: to_bytes(top), **export.entries})
    return notes


def _part(name: str, assembly: Assembly, source: Path, version: Version) -> Part:
    component = assembly.scenario.components[name]
    fmu = Fmu(find_fmu(component, source)) if isinstance(component, FmuComponent) else None
    return Part(name, component, assembly.system.units[name], fmu, version)


def _structure(export: _Export, assembly: Assembly, only_fmus: bool) -> tuple[WrittenStructure, tuple[str, ...]]:
    scenario, parts = export.scenario, export.parts
    left_out = {n for n, p in parts.items() if p.fmu is None} if only_fmus else set()
    if left_out == set(parts):
        raise ValueError("no component of it is an FMU")
    _check_sources(export, left_out)
    replaced = Replaced(left_out, parts)
    connected: dict[str, set[str]] = {n: set() for n in parts}
    connections: list[WrittenConnection] = []
    written = assembly.system.connections[: len(scenario.connections)]  # those into added inputs come last
    for given, connection in zip(scenario.connections, written, strict=True):
        linear, suppress = _scaling(given)
        if connection.target[0] in left_out:
            continue
        if connection.source[0] in left_out and replaced.as_start_value(connection, linear, suppress):
            continue
        connected[connection.target[0]].add(connection.target[1])
        connections += _connections(export.parts, connection, replaced, linear, suppress)
    components = [
        _fmu_component(export, parts[n], assembly.parameters[n], replaced.starts.get(n, {}), connected[n])
        if parts[n].fmu is not None
        else _own_component(export, parts[n], connected[n])
        for n in scenario.components
        if n not in left_out
    ]
    time = scenario.time.model_dump(mode="json", exclude={"start", "stop"})
    own: dict[str, Any] = {"time": time, "algorithm": scenario.algorithm.model_dump(mode="json", exclude_none=True)}
    if left_out and "order" in own["algorithm"]:
        own["algorithm"]["order"] = [n for n in own["algorithm"]["order"] if n not in left_out]
    start, stop = (nanoseconds(t) / NANOSECONDS for t in (scenario.time.start, scenario.time.stop))
    termed = [n for n, p in parts.items() if p.fmu is not None and getattr(p.component, "added_terms", [])]
    notes = tuple(f"other tools run `{n}` without the terms that are added to it" for n in termed)
    return WrittenStructure(
        scenario.title,
        scenario.description,
        export.version,
        list(replaced.inputs.values()),
        components,
        connections,
        start,
        stop,
        own,
    ), (*replaced.notes, *notes)


def _check_sources(export: _Export, left_out: Set[str]) -> None:
    """Whether what added inputs get is in the file.

    Raises:
        InputError: It is of a component that is left out.
    """
    for name, part in export.parts.items():
        for key, _, given in added_inputs(part.component):
            source = given.of.partition(".")[0]
            if source in left_out and name not in left_out:
                problem = f"{source} is no FMU and is left out, and a term of {name} needs {given.of}"
                raise InputError(export.source, f"components.{name}.{key}", problem, "export the whole scenario")


def _scaling(given: str | ScaledConnection) -> tuple[Linear, bool]:
    if isinstance(given, str):
        return IDENTITY, False
    return Linear(float(given.factor), float(given.offset)), not given.convert_units


def _connections(
    parts: Mapping[str, Part], connection: Connection, replaced: Replaced, linear: Linear, suppress: bool
) -> Iterator[WrittenConnection]:
    """A connection as SSP writes it: whole arrays to whole arrays of one shape, else element by element."""
    (source, name), (target, variable) = connection.source, connection.target
    shapes = []
    for part, of, element in (
        (parts[source], name, connection.source_element),
        (parts[target], variable, connection.target_element),
    ):
        shapes.append(() if element is not None else part.unit.variables[of].shape)
    is_split = any(parts[p].is_split(v) for p, v in (connection.source, connection.target))
    elements: list[tuple[int, ...] | None] = [None]
    if shapes[1] and (is_split or shapes[0] != shapes[1]):
        elements = list(itertools.product(*map(range, shapes[1])))
    for element in elements:
        from_element = connection.source_element if connection.source_element is not None or not shapes[0] else element
        to_element = connection.target_element if connection.target_element is not None else element
        ends = [
            End(part, *parts[part].end(of, at))
            for part, of, at in ((source, name, from_element), (target, variable, to_element))
        ]
        yield WrittenConnection(replaced.end(ends[0], name), ends[1], linear, suppress)


def _own_component(export: _Export, part: Part, connected: set[str]) -> WrittenComponent:
    """A component that is no FMU: its YAML is its source.

    Raises:
        InputError: It is a controller whose law is a Python file, which no other tool runs.
    """
    if getattr(getattr(part.component, "law", None), "kind", "") == "python":
        raise InputError(
            export.source,
            f"components.{part.name}.law",
            "a law in Python cannot be exported",
            "take a built-in law, or write an FMU",
        )
    data = part.component.model_dump(mode="json", exclude_defaults=True, exclude_none=True)
    data = {"kind": part.component.kind, **data}
    name = data.get("parameter_set")
    if name is not None:
        file = find_parameter_set(name, export.source)
        data["parameter_set"] = _entry(export, file.name, file.read_bytes())
        data["parameter_set"] = data["parameter_set"].removeprefix("resources/")
    text = yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110)
    source = _entry(export, f"{part.name}.yaml", text.encode())
    return WrittenComponent(part.name, OWN_TYPE, source, "any", part.ports(connected), None, {})


def _fmu_component(
    export: _Export, part: Part, resolved: Resolved, starts: Mapping[str, Any], connected: set[str]
) -> WrittenComponent:
    component, fmu = part.component, part.fmu
    assert isinstance(component, FmuComponent)
    assert fmu is not None
    file = find_fmu(component, export.source)
    source = _entry(export, file.name, file.read_bytes())
    is_fmi2 = fmu.is_fmi2
    values = [] if is_fmi2 else [Entry(n, v) for n, v in component.structure.items()]
    values += [Entry(n, v, resolved.sources[n]) for n, v in resolved.values.items()]
    values += [Entry(n, v) for n, v in {**starts, **component.start}.items()]
    parameters = None
    if values:
        top = parameter_set(export.scenario.title, values, fmu, component.structure, export.version)
        validate(Document(export.source, f"{part.name}.ssv", top, []), top, tag(SSV, "ParameterSet"))
        parameters = _entry(export, f"{part.name}.ssv", to_bytes(top))
    kept = set(OWN_KEYS) - (set() if is_fmi2 else {"structure"})
    own = component.model_dump(mode="json", include=kept, exclude_defaults=True, exclude_none=True)
    return WrittenComponent(
        part.name, FMU_TYPE, source, _IMPLEMENTATIONS[component.integrator], part.ports(connected), parameters, own
    )


def _entry(export: _Export, name: str, content: bytes) -> str:
    """Add a resource; one of the same name and content is used again, another gets a number."""
    path, count = f"resources/{name}", 1
    while export.entries.get(path, content) != content:
        count += 1
        path = f"resources/{Path(name).stem}_{count}{Path(name).suffix}"
    export.entries[path] = content
    return path
