"""A scenario to a coil network: which coils there are, what drives them, and the values of their parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from circuit.netlist import Network
from cosim.assemble import Assembly, assemble
from cosim.components import (
    CircuitComponent,
    FabricComponent,
    FmuComponent,
    HangingMassComponent,
    ProgrammeComponent,
    nanoseconds,
)
from cosim.connection import Connection
from cosim.fmu.unit import FmuUnit
from cosim.programme import ProgrammeUnit
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.stated import stated_terms
from diagnosis.models.coil_network.wiring import fault, reached, series_resistances

#: Standard gravity as mechanics.hanging_mass takes it [m/s^2].
GRAVITY = 9.81


class NoCoilNetwork(Exception):
    """The scenario is none that a coil network can simulate; the text says why."""


@dataclass(frozen=True)
class Translation:
    """A scenario as a network.

    Args:
        layout: Coils and strings.
        parameters: Nominal values, SI.
        drive: What drives it.
        start: First instant [s].
        actuator: Name of the component that holds the coils.
        circuit: Name of the circuit, or None where power is given.
        load: Name of the hanging load, or None.
        ambient: `component.output` of the programme of the surroundings.
        ambient_factor: Kelvin of the surroundings for one unit of that output.
        uncertainty: Parameter of the actuator to the standard deviation of ln(value), where its set states one.
        scatter: The same from coil to coil.
    """

    layout: CoilNetworkLayout
    parameters: CoilNetworkParameters
    drive: Drive
    start: float
    actuator: str
    circuit: str | None
    load: str | None
    ambient: str = ""
    ambient_factor: float = 1.0
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    scatter: Mapping[str, float] = field(default_factory=dict)


def translate(scenario: Scenario) -> Translation:
    """Read the network off a scenario; of one with a fabric it is what does not depend on the fabric's motion.

    Raises:
        NoCoilNetwork: It has a component that a network does not have (a pendulum, another FMU).
        InputError: The scenario is wrong.
    """
    actuators = [n for n, c in scenario.components.items() if isinstance(c, FmuComponent)]
    if len(actuators) != 1:
        raise NoCoilNetwork(f"it has {len(actuators)} FMUs; a network has one")
    for name, component in scenario.components.items():
        known = ProgrammeComponent | CircuitComponent | HangingMassComponent | FabricComponent | FmuComponent
        if not isinstance(component, known):
            raise NoCoilNetwork(f"a network has no {component.kind} ({name})")
    actuator = scenario.components[actuators[0]]
    assert isinstance(actuator, FmuComponent)
    if actuator.fmu != "thermal_stiffness":
        raise NoCoilNetwork(f"a network simulates thermal_stiffness, not {actuator.fmu}")
    if actuator.added_terms:
        raise NoCoilNetwork(f"a network has no terms that are added to an FMU ({actuators[0]}.added_terms)")
    for kind in (CircuitComponent, HangingMassComponent):
        several = [n for n, c in scenario.components.items() if isinstance(c, kind)]
        if len(several) > 1:
            raise NoCoilNetwork(
                f"a network has one component of kind {kind.model_fields['kind'].annotation}, not several"
            )
    assembly = assemble(scenario)
    try:
        return _Reader(scenario, assembly, actuators[0]).translation()
    finally:
        assembly.system.terminate()


class _Values(dict[str, Array]):
    """Parameters by name, which knows those that nobody has asked for."""

    def __init__(self) -> None:
        super().__init__()
        self._read: set[str] = set()

    def __getitem__(self, name: str) -> Array:
        self._read.add(name)
        return super().__getitem__(name)

    def get(self, name: str, default: Any = None) -> Any:
        """As of a dictionary."""
        self._read.add(name)
        return super().get(name, default)

    @property
    def unread(self) -> set[str]:
        """Names that were not read."""
        return set(self) - self._read


class _Reader:
    """Reads one assembled scenario."""

    def __init__(self, scenario: Scenario, assembly: Assembly, actuator: str) -> None:
        self.scenario, self.assembly, self.actuator = scenario, assembly, actuator
        self.connections = list(assembly.system.connections)
        components = scenario.components
        self.circuit = next((n for n, c in components.items() if isinstance(c, CircuitComponent)), None)
        self.load = next((n for n, c in components.items() if isinstance(c, HangingMassComponent)), None)

    def translation(self) -> Translation:
        fabrics = [n for n, c in self.scenario.components.items() if isinstance(c, FabricComponent)]
        reason = fault(self.assembly.system, self.actuator, self.circuit, self.load, fabrics)
        if reason:
            raise NoCoilNetwork(reason)
        coils = int(self.assembly.system.units[self.actuator].variables["temperature"].size)
        ambient = self._programme(self.actuator, "ambient_temperature")
        start = nanoseconds(self.scenario.time.start) * 1e-9
        if self.circuit is None:
            layout = CoilNetworkLayout(coils)
            power = self._programme(self.actuator, "power", coils)
            self._check_power(coils)
            drive = Drive(ambient, power=power)
        else:
            circuit = self.scenario.components[self.circuit]
            assert isinstance(circuit, CircuitComponent)
            layout = CoilNetworkLayout(coils, tuple(circuit.strings), circuit.supply)
            sources = layout.sources if circuit.supply == "per_string" else None
            drive = Drive(ambient, voltage=self._programme(self.circuit, "supply_voltage", sources))
        own = self.assembly.parameters[self.actuator]
        room = self._into(self.actuator, "ambient_temperature")[0]
        return Translation(
            layout,
            self._parameters(),
            drive,
            start,
            self.actuator,
            self.circuit,
            self.load,
            ".".join(room.source),
            room.factor,
            own.uncertainty,
            own.scatter,
        )

    def _into(self, unit: str, variable: str) -> list[Connection]:
        return [c for c in self.connections if c.target == (unit, variable)]

    def _check_power(self, coils: int) -> None:
        """Coils without a connection have the FMU's start value in the co-simulation, and 0 W in a network."""
        is_given = "power" in getattr(self.scenario.components[self.actuator], "start", {})
        if is_given and not reached(self._into(self.actuator, "power"), coils):
            raise NoCoilNetwork(f"{self.actuator}.start.power heats coils that have no connection")

    def _programme(self, unit: str, variable: str, elements: int | None = None) -> Programme:
        """The course of an input that programmes drive, in SI."""
        parts = self._into(unit, variable)
        if not parts:
            raise NoCoilNetwork(f"nothing is connected to {unit}.{variable}")
        found = [self._course(c) for c in parts]
        if len(found) == 1 and parts[0].target_element is None:
            times, values, is_linear = found[0]
            if elements is not None and values.ndim == 1:
                values = np.repeat(values[:, None], elements, axis=1)
            return Programme(times, values, is_linear)
        if elements is None or any(is_linear for _, _, is_linear in found):
            raise NoCoilNetwork(f"{unit}.{variable} is put together from several programmes, not all of them held")
        times = np.unique(np.concatenate([t for t, _, _ in found]))
        values = np.zeros((len(times), elements))
        for connection, (own, course, _) in zip(parts, found):
            held = course[np.maximum(np.searchsorted(own, times, side="right") - 1, 0)]
            assert connection.target_element is not None
            values[:, connection.target_element[0]] = held
        return Programme(times, values)

    def _course(self, connection: Connection) -> tuple[Array, Array, bool]:
        source = self.assembly.system.units[connection.source[0]]
        if not isinstance(source, ProgrammeUnit):
            raise NoCoilNetwork(f"{connection}: its source is no programme")
        course = source.courses[connection.source[1]]
        values = course.values
        if connection.source_element is not None:
            values = values[:, connection.source_element[0]]
        values = connection.factor * np.asarray(values, dtype=np.float64) + connection.offset
        return np.array(course.times) * 1e-9, values, course.is_linear

    def _parameters(self) -> CoilNetworkParameters:
        values = self._fmu_values()
        base: dict[str, float | Array] = {
            "conductance": np.asarray(values["heat_transfer_coefficient"]) * values["area"],
            "capacity": values["density"] * np.asarray(values["volume"]) * values["specific_heat"],
            "rest_length": values["coil_rest_length"],
        }
        for name in (
            "reference_resistance",
            "resistance_temperature_coefficient",
            "reference_temperature",
            "cooling_rate",
            "off_power",
            "initial_temperature",
            "heating_a",
            "heating_b",
            "heating_c",
            "heating_d",
            "cooling_a",
            "cooling_b",
            "cooling_c",
            "cooling_d",
        ):
            base[name] = values[name]
        # an FMU that was built before it had one starts every coil on the heating branch
        base["initial_loop_position"] = values.get("initial_loop_position", np.zeros(()))
        base["use_regressed_cooling_rate"] = float(values["use_regressed_cooling_rate"])
        terms: Mapping[str, Mapping[str, float | Array]] = {}
        if self.circuit is not None:
            circuit = self.scenario.components[self.circuit]
            assert isinstance(circuit, CircuitComponent)
            start = nanoseconds(self.scenario.time.start) * 1e-9
            base["string_resistance"], base["supply_resistance"] = series_resistances(circuit, start)
            try:
                terms = stated_terms(circuit, start)
            except ValueError as error:
                raise NoCoilNetwork(str(error)) from error
            self._break_coils(base, circuit)
        if self.load is not None:
            load = self.scenario.components[self.load]
            assert isinstance(load, HangingMassComponent)
            base["load"] = load.mass.to("kg") * GRAVITY
        unread = sorted(n for n in self.assembly.parameters[self.actuator].values if n in values.unread)
        if unread:
            raise NoCoilNetwork(f"a network has no parameter {unread[0]} of {self.actuator}")
        return CoilNetworkParameters(base, terms)

    def _break_coils(self, base: dict[str, float | Array], circuit: CircuitComponent) -> None:
        """Coils that are open or shorted in the scenario have the resistance that the circuit gives them."""
        network = Network(tuple(circuit.strings), open_coils=tuple(circuit.open_coils))
        fixed = {**network.open_resistances(), **dict.fromkeys(circuit.shorted_coils, 0.0)}
        if not fixed:
            return
        for name in ("reference_resistance", "resistance_temperature_coefficient"):
            values = np.broadcast_to(np.asarray(base[name], dtype=np.float64), (network.coils,)).copy()
            for coil, resistance in fixed.items():
                values[coil - 1] = resistance if name == "reference_resistance" else 0.0
            base[name] = values

    def _fmu_values(self) -> _Values:
        """Values of the FMU's parameters: its own start values, replaced by those of the scenario."""
        unit = self.assembly.system.units[self.actuator]
        if not isinstance(unit, FmuUnit):
            raise NoCoilNetwork("the actuator runs in a process of its own")
        given = self.assembly.parameters[self.actuator].values
        values = _Values()
        for variable in unit.archive.description.modelVariables:
            name = variable.name.removesuffix("[1]")
            if variable.causality != "parameter" or "[" in name:
                continue
            text = str(variable.start or "0").replace("true", "1").replace("false", "0")
            values[name] = np.array([float(part) for part in text.split()])
            if name in given:
                values[name] = _number(given[name], variable.unit or "1")
            values.update({n: v.reshape(()) for n, v in values.items() if v.size == 1})
        self._put_elements(unit, values)
        return values

    def _put_elements(self, unit: FmuUnit, values: dict[str, Array]) -> None:
        """Single elements that the scenario gives by the names of FMI 2.0, `initial_temperature[2]`."""
        units = {v.name.partition("[")[0]: v.unit or "1" for v in unit.archive.description.modelVariables}
        for name, value in self.assembly.parameters[self.actuator].values.items():
            field, bracket, element = name.partition("[")
            if bracket and field in values:
                coils = unit.variables["temperature"].size
                values[field] = np.array(np.broadcast_to(values[field], (coils,)))
                values[field][int(element.rstrip("]")) - 1] = float(_number(value, units[field]))


def _number(value: object, unit: str) -> Array:
    if isinstance(value, list):
        return np.array([_number(v, unit).reshape(()) for v in value])
    if isinstance(value, PhysicalValue):
        return np.array(value.to(unit))
    if isinstance(value, bool | int | float):
        return np.array(float(value))
    raise NoCoilNetwork(f"{value!r} is no number")


def not_for_network(source: object, reason: NoCoilNetwork) -> InputError:
    """The error of a scenario that a network was asked for."""
    return InputError(source, "components", str(reason), "see docs/diagnosis.md: which scenarios are fast")
