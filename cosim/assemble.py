"""Scenario to system: each kind of component to what builds its unit."""

from __future__ import annotations

import functools
import hashlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from circuit.elements import Contact, CurrentLimit, Drop, Lead, SlowSource, SourceResistance
from circuit.elements import Element as CircuitPart
from circuit.netlist import Network
from circuit.ngspice import ngspice
from circuit.unit import CircuitUnit
from cosim.actuator.resolve import resolve_actuators
from cosim.algorithms.algorithm import Algorithm
from cosim.algorithms.choose import choose
from cosim.algorithms.restoring import CannotRestore
from cosim.components import (
    ActuatorComponent,
    AddedInputEntry,
    CircuitComponent,
    CircuitElement,
    Component,
    ContactElement,
    ControllerComponent,
    DropElement,
    FabricComponent,
    FmuComponent,
    HangingMassComponent,
    LeadElement,
    PendulumComponent,
    ProgrammeComponent,
    ProgrammeOutput,
    SensorComponent,
    SlowSourceElement,
    SourceResistanceElement,
    nanoseconds,
)
from cosim.connection import Connection, ConnectionFault, Element
from cosim.control.string_controllers import StringControllers
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuUnit
from cosim.fmu_assembly import build_fmu
from cosim.isolation.unit import IsolatedUnit
from cosim.mechanics_assembly import build_fabric, build_pendulum
from cosim.nearest import did_you_mean
from cosim.parameters import Resolved, resolve
from cosim.programme import Course, ProgrammeUnit
from cosim.scenario import CONNECTION, ScaledConnection, Scenario
from cosim.system import System
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, Unit, UnitError, Variable
from cosim.unit.quantity import PhysicalValue, conversion
from mechanics.hanging_mass import HangingMassUnit

_CONNECTION = re.compile(CONNECTION)
_ELEMENT = re.compile(r"^(?P<name>.+)\[(?P<index>\d+(,\d+)*)\]$")


@dataclass(frozen=True)
class Assembly:
    """A system ready to be initialised.

    Args:
        scenario: The scenario with every actuator written out as an FMU with its connections.
        system: Units and connections.
        algorithm: Makes the macro-steps.
        start: First values of feedback inputs, SI.
        parameters: Component to resolved parameters, for the run's record.
    """

    scenario: Scenario
    system: System
    algorithm: Algorithm
    start: Mapping[str, Mapping[str, float]]
    parameters: Mapping[str, Resolved]

    @functools.cached_property
    def versions(self) -> Mapping[str, str]:
        """What the components compute with beside Python packages: ngspice, every FMU with its SHA-256.

        Raises:
            UnitError: ngspice does not load: a check of a scenario only looks whether it is there.
        """
        return _versions(self.system.units)


def assemble(scenario: Scenario) -> Assembly:
    """Build every unit of a scenario and connect them.

    Raises:
        InputError: A component, parameter or connection is wrong; nothing is left allocated.
    """
    source = scenario.path or Path("scenario")
    units: dict[str, Unit] = {}
    parameters: dict[str, Resolved] = {}
    try:
        scenario = _build_all(scenario, source, units, parameters)
        connections = [
            _connection(given, f"connections[{i}]", units, source) for i, given in enumerate(scenario.connections, 1)
        ]
        connections += _to_added_inputs(scenario, units, source)
        sources = frozenset(n for n, u in units.items() if isinstance(u, ProgrammeUnit))
        try:
            system = System(units, connections, sources)
            algorithm = choose(scenario.algorithm, system, nanoseconds(scenario.time.macro_step))
        except ConnectionFault as error:
            raise InputError(source, "connections", str(error), "correct the connection") from error
        except CannotRestore as error:
            raise InputError(
                source, "algorithm", str(error), "use gauss_seidel or jacobi with `on_event: continue`"
            ) from error
        start = {n: _start(n, c, units[n], source) for n, c in scenario.components.items()}
    except BaseException:
        for unit in units.values():
            unit.terminate()
        raise
    return Assembly(scenario, system, algorithm, start, parameters)


def added_inputs(component: Component) -> Iterator[tuple[str, str, AddedInputEntry]]:
    """What the terms of a component use of others: the key of it in the component, its name there, and what it is."""
    for number, term in enumerate(component.added_terms if isinstance(component, FmuComponent) else ()):
        for own, given in term.inputs.items():
            yield f"added_terms[{number}].inputs.{own}", own, given


def _to_added_inputs(scenario: Scenario, units: Mapping[str, Unit], source: Path) -> Iterator[Connection]:
    """What leads into inputs that FMUs do not have."""
    for name, component in scenario.components.items():
        first: dict[str, tuple[str, AddedInputEntry]] = {}
        for key, own, given in added_inputs(component):
            first.setdefault(own, (f"components.{name}.{key}", given))
        for own, (where, given) in first.items():
            fault = _fault_of_source(given.of, units)
            if fault is not None:
                raise InputError(source, f"{where}.of", *fault)
            yield _connection(f"{given.of} -> {name}.{own}", f"{where}.unit", units, source)


def _fault_of_source(of: str, units: Mapping[str, Unit]) -> tuple[str, str] | None:
    """Why `component.variable` is no floating-point number that can be had, and what to write; None: it is one."""
    component, _, text = of.partition(".")
    if not text:
        return f"`{of}` names no variable", "write component.variable"
    if component not in units:
        return f"there is no component {component}{did_you_mean(component, units)}", f"there are: {', '.join(units)}"
    variables = units[component].variables
    name, element = _element(text, variables)
    found = variables.get(name)
    if found is None or found.causality not in (Causality.OUTPUT, Causality.LOCAL):
        there = [n for n, v in variables.items() if v.causality is Causality.OUTPUT]
        return f"{component} has no output {name}{did_you_mean(name, there)}", f"it has: {', '.join(there) or 'none'}"
    if not found.type.is_float or (found.shape and element is None):
        return f"{of} is not one floating-point number", f"name one, or an element as in {name}[1]"
    return None


def _build_all(scenario: Scenario, source: Path, units: dict[str, Unit], parameters: dict[str, Resolved]) -> Scenario:
    """Fill `units` and `parameters`, in stepping order; actuators, which take their size from neighbours, come last."""
    names = scenario.names()
    actuators = [n for n in names if isinstance(scenario.components[n], ActuatorComponent)]
    for name in [*(n for n in names if n not in actuators), *actuators]:
        if actuators and name == actuators[0]:
            scenario = resolve_actuators(scenario, units, source)
        component = scenario.components[name]
        parameters[name] = _parameters(name, component, source)
        units[name] = _build(name, component, parameters[name], scenario, source)
    for built in (units, parameters):
        ordered = {name: built[name] for name in names}
        built.clear()
        built.update(ordered)  # type: ignore[arg-type]
    return scenario


def _versions(units: Mapping[str, Unit]) -> dict[str, str]:
    found = {}
    for name, part in units.items():
        unit = part.strings[0] if isinstance(part, StringControllers) else part
        if isinstance(unit, CircuitUnit):
            found["ngspice"] = str(ngspice().version)
        elif isinstance(unit, FmuUnit | IsolatedUnit) and unit.archive is not None:
            digest = hashlib.sha256(unit.archive.path.read_bytes()).hexdigest()
            found[f"FMU of {name}"] = f"{unit.archive.path.name}, sha256 {digest}"
    return found


def _parameters(name: str, component: Component, source: Path) -> Resolved:
    if not isinstance(component, FmuComponent | FabricComponent | PendulumComponent):
        return Resolved({}, {})
    try:
        return resolve(component.parameter_set, component.parameters, source)
    except InputError as error:
        raise error.within(name, source) from error


def _build(name: str, component: Component, parameters: Resolved, scenario: Scenario, source: Path) -> Unit:
    try:
        return _BUILDERS[type(component)](name, component, parameters, scenario, source)
    except InputError as error:
        raise error.within(name, source) from error
    except UnitError as error:  # libngspice is missing
        raise InputError(source, f"components.{name}", error.what, error.remedy or "correct this component") from error
    except ValueError as error:
        raise InputError(source, f"components.{name}", str(error), "correct this component") from error


def _programme(name: str, component: ProgrammeComponent, *_: Any) -> Unit:
    return ProgrammeUnit(name, {o: _course(given) for o, given in component.outputs.items()})


def _circuit(name: str, component: CircuitComponent, *_: Any) -> Unit:
    return CircuitUnit(name, _network(component))


def _hanging_mass(name: str, component: HangingMassComponent, *_: Any) -> Unit:
    return HangingMassUnit(name, component.coils, component.mass.to("kg"))


def _fabric(name: str, component: FabricComponent, parameters: Resolved, *_: Any) -> Unit:
    return build_fabric(name, component, parameters)


def _pendulum(name: str, component: PendulumComponent, parameters: Resolved, *_: Any) -> Unit:
    return build_pendulum(name, component, parameters)


def _control(
    name: str, component: SensorComponent | ControllerComponent, _: Resolved, __: Scenario, source: Path
) -> Unit:
    from cosim.control_assembly import build_control  # late: few scenarios have one

    return build_control(name, component, source)


def _fmu(name: str, component: FmuComponent, parameters: Resolved, scenario: Scenario, source: Path) -> Unit:
    reports_events = getattr(scenario.algorithm, "on_event", "continue") == "synchronise"
    every = (i.of.partition(".") for c in scenario.components.values() for *_, i in added_inputs(c))
    known: dict[str, AddedInputEntry] = {}
    for key, own, given in added_inputs(component):
        if known.setdefault(own, given) != given:
            raise InputError(source, key, "another term has this name for something else", "choose another one")
    wanted = [variable for of, _, variable in every if of == name]
    unit = build_fmu(name, component, parameters, source, reports_events, scenario.time.stop.to("s"), wanted)
    if isinstance(unit, CoSimulationUnit):
        try:
            unit.check_step(nanoseconds(scenario.time.macro_step))
        except InputError:
            unit.terminate()
            raise
    return unit


#: Kind of component to what builds its unit.
_BUILDERS: Mapping[type[Any], Callable[..., Unit]] = {
    ProgrammeComponent: _programme,
    CircuitComponent: _circuit,
    HangingMassComponent: _hanging_mass,
    FabricComponent: _fabric,
    PendulumComponent: _pendulum,
    SensorComponent: _control,
    ControllerComponent: _control,
    FmuComponent: _fmu,
    ActuatorComponent: _fmu,
}


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
        elements=tuple(_element_of(e) for e in component.elements),
    )


def _element_of(given: CircuitElement) -> CircuitPart:
    if isinstance(given, ContactElement):
        instant = None if given.instant is None else given.instant.to("s")
        return Contact(given.string, given.resistance.to("ohm"), instant)
    if isinstance(given, LeadElement):
        return Lead(given.string, given.rise.to("ohm/A^2"))
    if isinstance(given, DropElement):
        return Drop(given.string, given.voltage.to("V"))
    if isinstance(given, SourceResistanceElement):
        return SourceResistance(given.supply, given.resistance.to("ohm"))
    if isinstance(given, SlowSourceElement):
        return SlowSource(given.supply, given.delay.to("s"))
    return CurrentLimit(given.supply, given.limit.to("A"), given.share)


def _quantity(value: object) -> PhysicalValue:
    if not isinstance(value, PhysicalValue):
        raise ValueError(f"{value!r} is not a number with a unit")
    return value


def _connection(given: str | ScaledConnection, key: str, units: Mapping[str, Unit], source: Path) -> Connection:
    scaled = given if isinstance(given, ScaledConnection) else ScaledConnection(connect=given)
    match = _CONNECTION.match(scaled.connect)
    assert match is not None  # the scenario's pattern has checked it
    ends, elements, found = [], [], []
    for unit, text in ((match[1], match[2]), (match[3], match[4])):
        variables = units[unit].variables if unit in units else {}
        name, element = _element(text, variables)
        ends.append((unit, name))
        elements.append(element)
        found.append(variables.get(name))
    factor, offset = 1.0, 0.0
    # Only floating-point numbers have units in FMI: a Boolean or an integer gives its number to whatever it leads to.
    if found[0] is not None and found[1] is not None and found[0].type.is_float and scaled.convert_units:
        try:
            factor, offset = conversion(found[0].unit, found[1].unit) if found[1].type.is_float else (1.0, 0.0)
        except ValueError as error:
            raise InputError(source, key, f"{scaled.connect}: {error}", _unit_remedy(scaled, found)) from error
    factor, offset = scaled.factor * factor, scaled.factor * offset + scaled.offset
    return Connection(ends[0], ends[1], factor, offset, elements[0], elements[1])


def _unit_remedy(given: ScaledConnection, ends: Sequence[Variable | None]) -> str:
    """What to write where the units of a connection do not convert: take the numbers as they are, if that is meant."""
    bare = [end for end in ends if end is not None and end.unit == "1"]
    plain = f"`{{connect: {' '.join(given.connect.split())}, convert_units: false}}` takes the number as it is"
    if len(bare) == 1:
        return f"{bare[0].name} has no unit; if it is meant in the unit of the other, {plain}"
    return f"connect variables that measure the same thing, or, if the units are declared wrongly, {plain}"


def _element(text: str, variables: Mapping[str, Variable]) -> tuple[str, Element | None]:
    """Name and zero-based element of `power[3]`; a variable whose own name has brackets comes first."""
    match = _ELEMENT.match(text)
    if text in variables or match is None or match["name"] not in variables:
        return text, None
    first = variables[match["name"]].first_index
    return match["name"], tuple(int(i) - first for i in match["index"].split(","))


def _start(name: str, component: Component, unit: Unit, source: Path) -> dict[str, float]:
    values: dict[str, float] = {}
    if isinstance(component, FmuComponent):
        return values  # they are the FMU's own start values
    for key, value in getattr(component, "start", {}).items():
        variable = unit.variables.get(key)
        where = f"components.{name}.start.{key}"
        if variable is None or variable.causality is not Causality.INPUT:
            inputs = [n for n, v in unit.variables.items() if v.causality is Causality.INPUT]
            raise InputError(
                source,
                where,
                f"there is no such input{did_you_mean(key, inputs)}",
                f"it has: {', '.join(inputs) or 'none'}",
            )
        try:
            values[key] = _quantity(value).to(variable.unit)
        except ValueError as error:
            raise InputError(source, where, str(error), f"give it in {variable.unit}") from error
    return values
