"""Components of kind `actuator` to plain FMU components with explicit size, parameter set and connections."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

from cosim.actuator.interface import PAGE, coils_of, faults
from cosim.components import ActuatorComponent, FmuComponent
from cosim.fmu.archive import FmuArchive, open_fmu
from cosim.fmu.gathering import fmu_variables
from cosim.fmu.units import UnitNames
from cosim.fmu_assembly import find_fmu
from cosim.scenario import CONNECTION, Scenario, scenario_folder
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, Unit, Variable

#: Parameter sets of shipped actuators that are not named after them.
PARAMETER_SETS = {"thermal_stiffness": "niti_paper", "instant_stiffness": "niti_instant"}

#: For each neighbour: (its output, the actuator's input) and (the actuator's output, its input).
_FROM: Mapping[str, tuple[tuple[str, str], ...]] = {
    "electrical": (("power", "power"), ("voltage", "voltage")),
    "ambient": (("temperature", "ambient_temperature"),),
    "mechanical": (("extension", "extension"), ("tension", "tension")),
}
_TO: Mapping[str, tuple[tuple[str, str], ...]] = {
    "electrical": (("resistance", "resistance"),),
    "ambient": (),
    "mechanical": (("stiffness", "stiffness"), ("rest_length", "rest_length")),
}
_CONNECTION = re.compile(CONNECTION)


def resolve_actuators(scenario: Scenario, units: Mapping[str, Unit], source: Path) -> Scenario:
    """The scenario with every actuator written out: kind `fmu`, its size, its parameter set, its connections.

    Args:
        scenario: What the user wrote.
        units: Every unit that is no actuator.
        source: File named in errors.

    Raises:
        InputError: A neighbour does not exist, the FMU does not have the interface, or the sizes differ.
    """
    components = dict(scenario.components)
    connections = list(scenario.connections)
    for name, component in scenario.components.items():
        if not isinstance(component, ActuatorComponent):
            continue
        taken = _targets([c if isinstance(c, str) else c.connect for c in connections])
        try:
            neighbours = _neighbours(component, units, source)
            components[name], variables = _plain(name, component, neighbours, source)
            made = _connections(name, variables, neighbours, source)
        except InputError as error:
            raise error.within(name, source) from error
        connections += [text for target, text in made if target not in taken]
    return scenario.model_copy(update={"components": components, "connections": connections})


def default_parameter_set(component: FmuComponent) -> str | None:
    """The parameter set that belongs to a shipped actuator; an FMU given by path begins with its own values."""
    if component.parameter_set is not None or component.fmu.endswith(".fmu"):
        return component.parameter_set
    name = PARAMETER_SETS.get(component.fmu, component.fmu)
    return name if os.path.isfile(scenario_folder() / "parameter_sets" / f"{name}.yaml") else None


def _neighbours(component: ActuatorComponent, units: Mapping[str, Unit], source: Path) -> dict[str, tuple[str, Unit]]:
    found = {}
    for role in _FROM:
        neighbour = getattr(component, role)
        if neighbour is None:
            continue
        if neighbour not in units:
            raise InputError(
                source, role, f"there is no component `{neighbour}` to connect to", f"name one of: {', '.join(units)}"
            )
        found[role] = neighbour, units[neighbour]
    return found


def _plain(
    name: str, component: ActuatorComponent, neighbours: Mapping[str, tuple[str, Unit]], source: Path
) -> tuple[FmuComponent, Mapping[str, Variable]]:
    """The component as one of kind `fmu`, and its checked variables."""
    coils = _size(component, neighbours, source)
    sized = (
        component
        if coils is None
        else component.model_copy(update={"structure": {**component.structure, "coils": coils}})
    )
    archive = open_fmu(find_fmu(sized, source))
    try:
        structure, variables = _variables(archive, sized, source)
    finally:
        archive.remove()
    check_actuator(archive.path.name, variables, source)
    own = coils_of(variables)
    if coils not in (None, own):
        raise InputError(
            source,
            "fmu",
            f"{archive.path.name} is built for {own} coils, its neighbours have {coils}",
            f"build it for them: `cosim fmu build ... --coils {coils}`",
        )
    fields = {key: getattr(component, key) for key in FmuComponent.model_fields if key in component.model_fields_set}
    fields |= {"kind": "fmu", "structure": structure, "parameter_set": default_parameter_set(component)}
    return FmuComponent(**fields), variables


def _variables(
    archive: FmuArchive, component: FmuComponent, source: Path
) -> tuple[dict[str, int], dict[str, Variable]]:
    """Structure of the component, and the FMU's variables; an FMU without the parameter `coils` has its own size."""
    structural = {v.name for v in archive.description.modelVariables if v.causality == "structuralParameter"}
    structure = {k: v for k, v in component.structure.items() if k != "coils" or k in structural}
    try:
        found = fmu_variables(archive.description, structure, UnitNames(archive.description))
    except ValueError as error:
        raise InputError(source, "structure", str(error), "correct `structure`") from error
    is_fmi2 = archive.description.fmiVersion.startswith("2")  # there `coils` chooses the file
    return dict(component.structure) if is_fmi2 else structure, {n: v.variable for n, v in found.items()}


def check_actuator(what: str, variables: Mapping[str, Variable], source: object) -> None:
    """Raise InputError with every fault where an FMU does not have the interface of an actuator."""
    found = faults(variables)
    if found:
        raise InputError(
            source,
            "fmu",
            f"{what} is no actuator: " + "; ".join(found),
            f"see {PAGE}, or use `kind: fmu` and connect its variables yourself",
        )


def _size(component: ActuatorComponent, neighbours: Mapping[str, tuple[str, Unit]], source: Path) -> int | None:
    """Number of coils that the scenario or the neighbours give; None where they leave it open."""
    given = {}
    if "coils" in component.structure:
        given["structure"] = component.structure["coils"]
    for role, (neighbour, unit) in neighbours.items():
        names = [n for n, _ in _FROM[role]] + [n for _, n in _TO[role]]
        sizes = [unit.variables[n].shape[0] for n in names if n in unit.variables and unit.variables[n].shape]
        if sizes and role != "ambient":
            given[f"{role} ({neighbour})"] = sizes[0]
    if len(set(given.values())) > 1:
        said = ", ".join(f"{who}: {coils}" for who, coils in given.items())
        raise InputError(
            source,
            "",
            f"its neighbours have different numbers of coils: {said}",
            "make them equal, for example `strings` of the circuit",
        )
    return next(iter(given.values()), None)


def _targets(connections: list[str]) -> set[tuple[str, str]]:
    """(component, variable) that connections lead to; an element of an array counts for the whole."""
    found = [match for text in connections if (match := _CONNECTION.match(text))]
    return {(m[3], re.sub(r"\[[\d,]+\]$", "", m[4])) for m in found}


def _connections(
    name: str, variables: Mapping[str, Variable], neighbours: Mapping[str, tuple[str, Unit]], source: Path
) -> list[tuple[tuple[str, str], str]]:
    """(target, connection) of every connection of the interface that both sides have."""
    made = []
    for role, (neighbour, unit) in neighbours.items():
        outputs = {n for n, v in unit.variables.items() if v.causality is Causality.OUTPUT}
        inputs = {n for n, v in unit.variables.items() if v.causality is Causality.INPUT}
        into = [
            ((name, own), f"{neighbour}.{theirs} -> {name}.{own}")
            for theirs, own in _FROM[role]
            if theirs in outputs and own in variables
        ]
        out = [
            ((neighbour, theirs), f"{name}.{own} -> {neighbour}.{theirs}")
            for own, theirs in _TO[role]
            if own in variables and theirs in inputs
        ]
        if not into and role != "mechanical":
            takes = " or ".join(f"`{own}`" for _, own in _FROM[role] if own in variables)
            gives = ", ".join(sorted(outputs)) or "nothing"
            raise InputError(
                source,
                role,
                f"`{neighbour}` gives no {takes} to this actuator; it gives: {gives}",
                "name another component, or connect them under `connections`",
            )
        if not out and role == "mechanical":
            raise InputError(
                source,
                role,
                f"`{neighbour}` takes no stiffness; its inputs: {', '.join(sorted(inputs)) or 'none'}",
                "name the fabric or the load",
            )
        made += into + out
    return made
