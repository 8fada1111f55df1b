"""The amended scenario, as text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from cosim.actuator.resolve import default_parameter_set
from cosim.components import FmuComponent, ProgrammeOutput
from cosim.parameters import resolve
from cosim.scenario import Scenario
from cosim.unit.quantity import PhysicalValue
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.amend.actuator_fmu import neighbour_inputs
from diagnosis.amend.changes import SAME, CannotAmend, Changes, FittedTerm
from diagnosis.amend.circuit_elements import circuit_elements, quantity
from diagnosis.amend.fmu_source import contact_parameter, parameter_name
from diagnosis.amend.load_fmu import load_fields
from diagnosis.amend.parts import Part, load_ports
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, Array, CoilNetworkLayout
from diagnosis.models.coil_network.translate import GRAVITY
from diagnosis.search.cosim_run import shifted

#: Parameters of the FMU's coils with their units, by the field of the network that they give.
_BRANCH = {"a": "N/m", "b": "1", "c": "1/K", "d": "N/m"}
_DIRECT = {
    "reference_resistance": "ohm",
    "cooling_rate": "1/s",
    "resistance_temperature_coefficient": "1/K",
    **{f"heating_{letter}": unit for letter, unit in _BRANCH.items()},
    **{f"cooling_{letter}": unit for letter, unit in _BRANCH.items()},
}
#: Start values of thermal_stiffness that are needed where neither the set nor the scenario gives them.
_DEFAULTS = {"area": (97.85e-6, "m^2"), "density": (6450.0, "kg/m^3"), "specific_heat": (837.0, "J/(kg*K)")}


@dataclass(frozen=True)
class Files:
    """FMUs of an amended scenario, names beside it.

    Args:
        actuator: File of the coils, or None: the FMU of the scenario stays.
        load: File of the load, or None.
    """

    actuator: str | None
    load: str | None


def needs_own_fmu(changes: Changes) -> bool:
    """Whether the FMU of the scenario cannot say what was found of its coils."""
    shared = [f"{branch}_{letter}" for branch in ("heating", "cooling") for letter in "abcd"] + ["cooling_rate"]
    differs = any(np.ndim(changes.factors.get(name, 1.0)) for name in shared)
    return bool(changes.of(Part.ACTUATOR)) or differs or "power_gain" in changes.factors or _talks(changes)


def needs_own_load(changes: Changes) -> bool:
    """Whether an ideal mass below each coil cannot say what was found of the load."""
    return bool(changes.of(Part.LOAD)) or (
        changes.translation.load is not None and bool(np.ndim(changes.factors.get("load", 1.0)))
    )


def _talks(changes: Changes) -> bool:
    """Whether the load must be told more of the coils than their stiffness."""
    ports = load_ports([t.term for t in changes.of(Part.LOAD)])
    return any(p.array != "temperature" for p in ports)


def write_number(values: Array, unit: str) -> str | list[str]:
    """One value, or one for each element."""
    flat = np.atleast_1d(np.asarray(values, dtype=np.float64))
    same = float(np.ptp(flat)) <= SAME * float(np.max(np.abs(flat)))
    texts = [quantity(float(v), unit) if unit != "1" else f"{float(v):.10g}" for v in flat]
    return texts[0] if same else texts


def amended_data(scenario: Scenario, changes: Changes, files: Files) -> dict[str, Any]:
    """The scenario's own YAML with all changes.

    Raises:
        CannotAmend: A change has no place in a scenario.
    """
    assert scenario.path is not None, "the scenario was read from a file"
    data: dict[str, Any] = parse_yaml(read_text(scenario.path), scenario.path)
    translation = changes.translation
    components = data["components"]
    components[translation.actuator] = _actuator(scenario, components[translation.actuator], changes, files)
    if translation.circuit is not None:
        components[translation.circuit] = _circuit(components[translation.circuit], changes)
    elif changes.of(Part.CIRCUIT):
        raise CannotAmend("the scenario has no circuit")
    if translation.load is not None:
        components[translation.load] = _load(components[translation.load], changes, files)
    elif changes.of(Part.LOAD):
        raise CannotAmend("nothing hangs below the coils")
    _connect(data, changes)
    _move_room(data, changes)
    data["title"] = f"{data.get('title', scenario.title)} (amended)"
    data.pop("description", None)
    return data


def _move_room(data: dict[str, Any], changes: Changes) -> None:
    """What every day has of its room: the programme of the surroundings, moved as a whole."""
    amount = changes.offsets.get("ambient_offset", 0.0)
    if not amount:
        return
    component, _, output = changes.translation.ambient.partition(".")
    given = data["components"][component]["outputs"][output]
    moved = shifted(ProgrammeOutput.model_validate(given), amount / changes.translation.ambient_factor)
    data["components"][component]["outputs"][output] = moved.model_dump(mode="json", exclude_defaults=True)


def term_parameters(terms: list[FittedTerm], layout: CoilNetworkLayout) -> dict[str, Any]:
    """Parameters of terms by their names in the generated FMUs."""
    found: dict[str, Any] = {}
    for t in terms:
        for p in t.term.parameters:
            if t.term.axis != "pair":
                found[parameter_name(t.term, p.name)] = write_number(t.values[p.name], p.unit)
            for pair, n in t.contacts(layout).items():
                found[contact_parameter(t.term, p.name, pair)] = write_number(t.values[p.name][n], p.unit)
    return found


def _actuator(scenario: Scenario, given: dict[str, Any], changes: Changes, files: Files) -> dict[str, Any]:
    component = scenario.components[changes.translation.actuator]
    assert isinstance(component, FmuComponent)
    result = dict(given)
    parameter_set = component.parameter_set
    if str(component.kind) == "actuator":  # a subclass with another tag
        parameter_set = default_parameter_set(component)
    if parameter_set is not None:
        result["parameter_set"] = parameter_set
    own = _coil_parameters(scenario, component, parameter_set, changes)
    if files.actuator is not None:
        result["fmu"] = files.actuator
        result["structure"] = {"coils": changes.translation.layout.coils}
        for key in ("integrator", "tolerance", "fmi"):
            result.pop(key, None)
        own |= term_parameters(changes.of(Part.ACTUATOR), changes.translation.layout)
        if changes.cycles_before:
            own["cycles_before"] = write_number(np.asarray(changes.cycles_before), "1")
        if "power_gain" in changes.factors:
            own["power_gain"] = write_number(changes.factors["power_gain"], "1")
    if own:
        result["parameters"] = {**given.get("parameters", {}), **own}
    return result


def _coil_parameters(
    scenario: Scenario, component: FmuComponent, parameter_set: str | None, changes: Changes
) -> dict[str, Any]:
    """Recalibrated parameters of the coils, by the names of the FMU."""
    assert scenario.path is not None
    known = resolve(parameter_set, component.parameters, scenario.path).values
    numbers = {}
    for name, (default, unit) in _DEFAULTS.items():
        value = known.get(name)
        numbers[name] = value.to(unit) if isinstance(value, PhysicalValue) else default
    found: dict[str, Any] = {}
    for field in changes.factors:
        if field == "conductance":
            found["heat_transfer_coefficient"] = write_number(changes.value(field) / numbers["area"], "W/(m^2*K)")
        elif field == "capacity":
            volume = changes.value(field) / (numbers["density"] * numbers["specific_heat"])
            found["volume"] = write_number(volume, "m^3")
        elif field in _DIRECT:
            found[field] = write_number(changes.value(field), _DIRECT[field])
        elif field not in ("load", "power_gain", "string_resistance", "supply_resistance"):
            raise CannotAmend(f"a scenario cannot say {field}")
    if "initial_temperature" in changes.offsets:
        first = changes.translation.parameters.base["initial_temperature"]
        found["initial_temperature"] = write_number(np.asarray(first) + changes.offsets["initial_temperature"], "K")
    return found


def _circuit(given: dict[str, Any], changes: Changes) -> dict[str, Any]:
    result = dict(given)
    for field in ("string_resistance", "supply_resistance"):
        if field in changes.factors:
            value = write_number(changes.value(field), "ohm")
            if isinstance(value, list):
                raise CannotAmend(f"{field} differs from string to string")
            result[field] = value
    elements = circuit_elements(changes.of(Part.CIRCUIT), changes.translation.start)
    if elements:
        result["elements"] = [*given.get("elements", []), *elements]
    return result


def _load(given: dict[str, Any], changes: Changes, files: Files) -> dict[str, Any]:
    mass = write_number(changes.value("load") / GRAVITY, "kg")
    if files.load is None:
        if "load" not in changes.factors:
            return given
        if isinstance(mass, list):
            raise CannotAmend("the mass differs from coil to coil")
        return {**given, "mass": mass}
    terms, layout = changes.of(Part.LOAD), changes.translation.layout
    fields = {
        name: write_number(changes.value(name), COIL_FIELDS[name][1]) for name in load_fields([t.term for t in terms])
    }
    return {
        "kind": "fmu",
        "fmu": files.load,
        "structure": {"coils": layout.coils},
        "parameters": {"mass": mass, "gravity": quantity(GRAVITY, "m/s^2"), **fields, **term_parameters(terms, layout)},
    }


def _connect(data: dict[str, Any], changes: Changes) -> None:
    """Connections for what the terms of one part need to know of another."""
    actuator, circuit, load = (getattr(changes.translation, n) for n in ("actuator", "circuit", "load"))
    ports = load_ports([t.term for t in changes.of(Part.LOAD)])
    needs = actuator_inputs(changes)
    sources: Mapping[str, str | None] = {"extension": load, "tension": load, "current": circuit}
    wanted = [f"{sources[n]}.{n} -> {actuator}.{n}" for n in needs if sources[n] is not None]
    wanted += [f"{actuator}.{p.name} -> {load}.{p.name}" for p in ports]
    if wanted:
        data["connections"] = [
            *data.get("connections", []),
            *(c for c in wanted if c not in data.get("connections", [])),
        ]


def actuator_inputs(changes: Changes) -> list[str]:
    """Inputs of the amended coils beside power and ambient temperature."""
    needs = neighbour_inputs([t.term for t in changes.of(Part.ACTUATOR)])
    told = {p.array for p in load_ports([t.term for t in changes.of(Part.LOAD)])}
    return [*needs, "current"] if "current" in told and "current" not in needs else needs
