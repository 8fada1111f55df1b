"""Scenario to system: the only file that names concrete units."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from circuit.netlist import Network
from circuit.ngspice import ngspice
from circuit.unit import CircuitUnit
from cosim.components import (
    CircuitComponent,
    Component,
    FabricComponent,
    FmuComponent,
    HangingMassComponent,
    ParameterValue,
    ProgrammeComponent,
    ProgrammeOutput,
    nanoseconds,
)
from cosim.errors import InputError
from cosim.fmu.unit import FmuUnit
from cosim.fmu_assembly import build_fmu
from cosim.parameters import Resolved, resolve
from cosim.programme import Course, ProgrammeUnit
from cosim.quantity import PhysicalValue, conversion
from cosim.scenario import CONNECTION, Scenario
from cosim.system import Connection, ConnectionFault, System
from cosim.unit import Causality, Unit, UnitError
from mechanics.fabric import FabricDesign
from mechanics.hanging_mass import HangingMassUnit
from mechanics.solver import SolverSettings
from mechanics.unit import FabricUnit

#: SI unit of every number of a fabric that a parameter set or a scenario may give.
FABRIC_UNITS = {
    "bar_diameter": "m",
    "tolerance": "m",
    "width": "m",
    "length_cold": "m",
    "length_hot": "m",
    "length_offset": "m",
    "link_mass": "kg",
    "friction": "1",
    "restitution": "1",
    "steel_stiffness": "N/m",
    "steel_rest_length": "m",
    "tether_play": "m",
}

_CONNECTION = re.compile(CONNECTION)


@dataclass(frozen=True)
class Assembly:
    """A system ready to be initialised.

    Args:
        system: Units and connections.
        start: First values of feedback inputs, SI.
        parameters: Component to resolved parameters, for the run's record.
        versions: What the components compute with beside Python packages: ngspice, every FMU with its SHA-256.
    """

    system: System
    start: Mapping[str, Mapping[str, float]]
    parameters: Mapping[str, Resolved]
    versions: Mapping[str, str]


def assemble(scenario: Scenario) -> Assembly:
    """Build every unit of a scenario and connect them.

    Raises:
        InputError: A component, parameter or connection is wrong; nothing is left allocated.
    """
    source = scenario.path or Path("scenario")
    units: dict[str, Unit] = {}
    parameters: dict[str, Resolved] = {}
    try:
        for name in scenario.names():
            component = scenario.components[name]
            parameters[name] = _parameters(name, component, source)
            units[name] = _build(name, component, parameters[name], scenario, source)
        connections = [
            _connection(text if isinstance(text, str) else text.connect, i, units, source)
            for i, text in enumerate(scenario.connections)
        ]
        sources = frozenset(n for n, u in units.items() if isinstance(u, ProgrammeUnit))
        try:
            system = System(units, connections, sources)
        except ConnectionFault as error:
            raise InputError(source, "connections", str(error), "correct the connection") from error
        start = {n: _start(n, c, units[n], source) for n, c in scenario.components.items()}
    except BaseException:
        for unit in units.values():
            unit.terminate()
        raise
    return Assembly(system, start, parameters, _versions(units))


def _versions(units: Mapping[str, Unit]) -> dict[str, str]:
    found = {}
    for name, unit in units.items():
        if isinstance(unit, CircuitUnit):
            found["ngspice"] = str(ngspice().version)
        elif isinstance(unit, FmuUnit):
            digest = hashlib.sha256(unit.archive.path.read_bytes()).hexdigest()
            found[f"FMU of {name}"] = f"{unit.archive.path.name}, sha256 {digest}"
    return found


def _parameters(name: str, component: Component, source: Path) -> Resolved:
    if not isinstance(component, FmuComponent | FabricComponent):
        return Resolved({}, {})
    try:
        return resolve(component.parameter_set, component.parameters, source)
    except InputError as error:
        raise _within(name, source, error) from error


def _within(name: str, source: Path, error: InputError) -> InputError:
    """The error with the scenario as its file and the key inside it; one in another file keeps that file's name."""
    key = error.key.removeprefix(f"{name}.")
    if error.source == str(source) or key != error.key:
        key = f"components.{name}.{key}" if key else f"components.{name}"
        return InputError(source, key, error.problem, error.remedy or "correct this component")
    problem = f"{error.problem} (needed by components.{name} of {source})"
    return InputError(error.source, error.key, problem, error.remedy)


def _build(name: str, component: Component, parameters: Resolved, scenario: Scenario, source: Path) -> Unit:
    try:
        if isinstance(component, ProgrammeComponent):
            return ProgrammeUnit(name, {o: _course(given) for o, given in component.outputs.items()})
        if isinstance(component, CircuitComponent):
            return CircuitUnit(name, _network(component))
        if isinstance(component, HangingMassComponent):
            return HangingMassUnit(name, component.coils, component.mass.to("kg"))
        if isinstance(component, FabricComponent):
            return _fabric(name, component, parameters)
        return build_fmu(name, component, parameters, source)
    except InputError as error:
        raise _within(name, source, error) from error
    except UnitError as error:  # libngspice is missing
        raise InputError(source, f"components.{name}", error.what, error.remedy or "correct this component") from error
    except ValueError as error:
        raise InputError(source, f"components.{name}", str(error), "correct this component") from error


def _course(given: ProgrammeOutput) -> Course:
    points = given.points if given.points is not None else [(PhysicalValue(0.0, "s"), given.constant)]
    values = [
        [element.to(given.unit) for element in v] if isinstance(v, list) else v.to(given.unit)  # type: ignore[union-attr]
        for _, v in points
    ]
    return Course(
        tuple(nanoseconds(t) for t, _ in points),
        np.array(values, dtype=np.float64),
        given.unit,
        given.dim,
        given.interpolation == "linear",
    )


def _network(component: CircuitComponent) -> Network:
    return Network(
        strings=tuple(component.strings),
        supply=component.supply,
        supply_resistance=component.supply_resistance.to("ohm"),
        string_resistance=component.string_resistance.to("ohm"),
        open_coils=tuple(component.open_coils),
        shorted_coils=tuple(component.shorted_coils),
    )


def _fabric(name: str, component: FabricComponent, parameters: Resolved) -> FabricUnit:
    numbers: dict[str, Any] = {}
    for key, value in parameters.values.items():
        if key == "gravity":
            numbers[key] = _gravity(value)
        elif key not in FABRIC_UNITS:
            raise ValueError(f"a fabric has no parameter `{key}`; it has: gravity, {', '.join(FABRIC_UNITS)}")
        elif not isinstance(value, PhysicalValue):
            raise ValueError(f"{key} must be one number with a unit")
        else:
            numbers[key] = value.to(FABRIC_UNITS[key])
    design = FabricDesign(
        rows=component.rows,
        columns=component.columns,
        tether_rows=component.tether.rows,
        tether_kind=component.tether.kind,
        **numbers,
    )
    solver = SolverSettings(
        micro_step=component.solver.micro_step.to("s"),
        iterations=component.solver.iterations,
        penetration_limit=component.solver.penetration_limit.to("m"),
        springs=component.solver.springs,
    )
    return FabricUnit(name, design, solver)


def _gravity(value: ParameterValue) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("gravity is a list of three accelerations, for example [0 m/s^2, 0 m/s^2, -9.81 m/s^2]")
    x, y, z = (_quantity(element).to("m/s^2") for element in value)
    return x, y, z


def _quantity(value: object) -> PhysicalValue:
    if not isinstance(value, PhysicalValue):
        raise ValueError(f"{value!r} is not a number with a unit")
    return value


def _connection(text: str, index: int, units: Mapping[str, Unit], source: Path) -> Connection:
    match = _CONNECTION.match(text)
    assert match is not None  # the scenario's pattern has checked it
    ends = (match[1], match[2]), (match[3], match[4])
    found = [units[u].variables.get(v) if u in units else None for u, v in ends]
    factor, offset = 1.0, 0.0
    if found[0] is not None and found[1] is not None:
        try:
            factor, offset = conversion(found[0].unit, found[1].unit)
        except ValueError as error:
            raise InputError(
                source, f"connections[{index}]", f"{text}: {error}", "connect variables that measure the same thing"
            ) from error
    return Connection(ends[0], ends[1], factor, offset)


def _start(name: str, component: Component, unit: Unit, source: Path) -> dict[str, float]:
    values: dict[str, float] = {}
    if isinstance(component, FmuComponent):
        return values  # they are the FMU's own start values
    for key, value in getattr(component, "start", {}).items():
        variable = unit.variables.get(key)
        where = f"components.{name}.start.{key}"
        if variable is None or variable.causality is not Causality.INPUT:
            inputs = ", ".join(n for n, v in unit.variables.items() if v.causality is Causality.INPUT) or "none"
            raise InputError(source, where, "there is no such input", f"it has: {inputs}")
        try:
            values[key] = _quantity(value).to(variable.unit)
        except ValueError as error:
            raise InputError(source, where, str(error), f"give it in {variable.unit}") from error
    return values
