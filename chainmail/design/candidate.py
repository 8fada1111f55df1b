"""One design: which rows are heated, how, and the scenario that does it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from chainmail.design.closed_form import Row
from cosim.actuator.resolve import default_parameter_set
from cosim.components import (
    ActuatorComponent,
    CircuitComponent,
    FabricComponent,
    ProgrammeComponent,
    ProgrammeOutput,
    nanoseconds,
)
from cosim.mechanics_assembly import build_fabric
from cosim.parameters import resolve
from cosim.scenario import Scenario, scenario_of_data
from cosim.sweep.keys import changed
from cosim.unit.errors import InputError
from cosim.unit.protocol import seconds
from cosim.unit.quantity import PhysicalValue
from mechanics.fabric import FabricDesign

#: Time in which a fabric that was woven flat falls into its drape before anything is switched [s].
DRAPE = 2.5
#: Time between the end of heating and the instant that counts [s]. Links close while their coils become stiff; from
#: then on coils cool, and a loaded fabric sinks again: by 5 mm in the first second in the only run that was looked at.
LEAD = 0.2


@dataclass(frozen=True)
class Rig:
    """The scenario of a task, and what closed forms need of it.

    Args:
        scenario: As given.
        supply: Name of the programme that gives the voltages, and its output.
        circuit: Name of the coil network.
        fabric: Name of the fabric.
        rows: One row of coils each, from the tether.
        held: Tethered rows.
    """

    scenario: Scenario
    supply: tuple[str, str]
    circuit: str
    fabric: str
    rows: tuple[Row, ...]
    held: int
    _varied: dict[tuple[tuple[str, str], ...], Rig] = field(default_factory=dict, compare=False, repr=False)

    def with_keys(self, keys: tuple[tuple[str, str], ...]) -> Rig:
        """The rig with other numbers in its scenario; itself where nothing changes.

        Args:
            keys: Path and value, as in a sweep.

        Raises:
            InputError: A path leads nowhere, or a value is wrong.
        """
        if not keys:
            return self
        if keys not in self._varied:
            source = self.scenario.path or Path("scenario")
            data = yaml.safe_load(self.scenario.to_yaml(is_complete=True))
            try:
                data = changed(data, dict(keys))
            except ValueError as error:
                raise InputError(source, "vary", str(error), "docs/sweeps.md explains paths of keys") from error
            self._varied[keys] = rig_of(scenario_of_data(data, source), source)
        return self._varied[keys]

    @property
    def weave(self) -> FabricDesign:
        """Geometry of the fabric; raises ValueError where it cannot be woven."""
        fabric = self.scenario.components[self.fabric]
        assert isinstance(fabric, FabricComponent)
        source = self.scenario.path or Path("scenario")
        return build_fabric(self.fabric, fabric, resolve(fabric.parameter_set, fabric.parameters, source)).design

    @property
    def free(self) -> tuple[int, ...]:
        """Rows that are not tethered, counted from 1."""
        return tuple(range(self.held + 1, len(self.rows) + 1))

    @property
    def step(self) -> float:
        """Macro-step [s]."""
        return self.scenario.time.macro_step.to("s")


@dataclass(frozen=True)
class Pulse:
    """One row: heated from `begin` to `end`, off until `held`, then held until the deadline.

    A coil that has transformed keeps its stiffness while it cools down to the hold, so nothing is spent until then.

    Args:
        row: Counted from 1.
        voltage: While heated [V].
        hot: Temperature at the end of heating [K].
        begin: [s], on the grid of macro-steps.
        end: [s], the same.
        held: [s], the same; later than the deadline where the coils are still warm then.
        until: End of the hold [s]; infinite where it lasts to the end of the run.
    """

    row: int
    voltage: float
    hot: float
    begin: float
    end: float
    held: float
    until: float = math.inf


@dataclass(frozen=True)
class Candidate:
    """Heated rows, each with its own pulse.

    Args:
        pulses: In the order of their rows.
        hold: Temperature of the hold [K].
        begin: First switch [s]; without a pulse the time at which it would be.
        deadline: [s].
        keys: Keys of the scenario that are changed, path and value as text.
    """

    pulses: tuple[Pulse, ...]
    hold: float
    begin: float
    deadline: float
    keys: tuple[tuple[str, str], ...] = ()

    @property
    def rows(self) -> tuple[int, ...]:
        """Heated rows."""
        return tuple(p.row for p in self.pulses)

    @property
    def hottest(self) -> float:
        """Highest temperature at the end of heating [K]."""
        return max((p.hot for p in self.pulses), default=0.0)

    def power(self, rig: Rig) -> float:
        """Largest power of heating rows at one time [W]; holding ones are added where they overlap."""
        rig = rig.with_keys(self.keys)
        return max((self._power_at(p.begin, rig) for p in self.pulses), default=0.0)

    def _power_at(self, time: float, rig: Rig) -> float:
        heating = sum(rig.rows[p.row - 1].power(p.voltage) for p in self.pulses if p.begin <= time < p.end)
        holding = sum(holding_power(rig, p.row, self.hold) for p in self.pulses if p.held <= time < p.until)
        return heating + holding

    def energy(self, rig: Rig) -> float:
        """Electrical energy until the deadline [J], by the closed form."""
        rig = rig.with_keys(self.keys)
        return sum(
            rig.rows[p.row - 1].power(p.voltage) * (p.end - p.begin)
            + holding_power(rig, p.row, self.hold) * max(min(p.until, self.deadline) - p.held, 0.0)
            for p in self.pulses
        )

    def text(self) -> str:
        """For people."""
        return "; ".join([*self._programmes(), *(f"{key.rpartition('.')[2]} {value}" for key, value in self.keys)])

    def _programmes(self) -> list[str]:
        """Rows with the same programme are listed together."""
        if not self.pulses:
            return ["no row heated"]
        groups: dict[tuple[float, ...], list[int]] = {}
        for p in self.pulses:
            groups.setdefault((p.voltage, p.begin, p.end, p.hot, p.held, p.until), []).append(p.row)
        return [self._programme(rows, *given) for given, rows in groups.items()]

    def _programme(
        self, rows: list[int], voltage: float, begin: float, end: float, hot: float, held: float, until: float
    ) -> str:
        last = f" to {until:g} s" if until < self.deadline else ""
        kept = f", held at {self.hold - 273.15:.3g} degC from {held:g} s{last}" if held < self.deadline else ""
        name = "rows" if len(rows) > 1 else "row"
        return (
            f"{name} {', '.join(map(str, rows))}: {voltage:.3g} V from {begin:g} s to {end:g} s "
            f"({hot - 273.15:.3g} degC){kept}"
        )


def holding_power(rig: Rig, row: int, temperature: float) -> float:
    """Power that holds a row at a temperature [W]."""
    own = rig.rows[row - 1]
    return own.power(own.holding_voltage(temperature))


def rig_of(scenario: Scenario, source: Path) -> Rig:
    """What a design needs of a scenario.

    Raises:
        InputError: The scenario is none of a fabric whose rows have supplies of their own.
    """
    components = scenario.components
    circuits = [(n, c) for n, c in components.items() if isinstance(c, CircuitComponent)]
    fabrics = [(n, c) for n, c in components.items() if isinstance(c, FabricComponent)]
    actuators = [c for c in components.values() if isinstance(c, ActuatorComponent) and c.fmu == "thermal_stiffness"]
    if len(circuits) != 1 or len(fabrics) != 1 or len(actuators) != 1:
        raise InputError(
            source,
            "scenario",
            "a design needs one circuit, one fabric and one `thermal_stiffness`",
            "begin with docs/examples/design/eight_rows.yaml",
        )
    source = scenario.path or source
    (circuit, network), (fabric, woven) = circuits[0], fabrics[0]
    if network.supply != "per_string" or len(network.strings) != woven.rows:
        raise InputError(
            source,
            f"components.{circuit}",
            "its strings are not one per row with a supply each",
            f"give `supply: per_string` and {woven.rows} strings",
        )
    if woven.tether.kind != "cantilever":
        raise InputError(source, f"components.{fabric}.tether", "a design needs a cantilever", "kind: cantilever")
    supply = _source_of(scenario, f"{circuit}.supply_voltage", source)
    ambient = _source_of(scenario, "", source, actuators[0].ambient)
    room = components[ambient[0]]
    assert isinstance(room, ProgrammeComponent)
    constant = room.outputs[ambient[1]].constant
    if not isinstance(constant, PhysicalValue):
        raise InputError(
            source,
            f"components.{ambient[0]}",
            "the room's temperature is not constant",
            "give `constant`: closed forms need it",
        )
    rows = _rows(actuators[0], network, constant.to("K"), scenario)
    return Rig(scenario, supply, circuit, fabric, rows, woven.tether.rows)


def _source_of(scenario: Scenario, target: str, source: Path, name: str | None = None) -> tuple[str, str]:
    """Programme and output that feed an input, or that give the temperature of the surroundings."""
    for given in scenario.connections:
        text = given if isinstance(given, str) else given.connect
        begin, _, end = (part.strip() for part in text.partition("->"))
        component, _, output = begin.partition(".")
        if end == target and isinstance(scenario.components.get(component), ProgrammeComponent):
            return component, output
    found = scenario.components.get(name or "")
    if isinstance(found, ProgrammeComponent) and "temperature" in found.outputs:
        return str(name), "temperature"
    raise InputError(
        source,
        "connections",
        f"no programme feeds {target or 'the surroundings of the actuator'}",
        "begin with docs/examples/design/eight_rows.yaml",
    )


def _rows(
    actuator: ActuatorComponent, network: CircuitComponent, ambient: float, scenario: Scenario
) -> tuple[Row, ...]:
    source = scenario.path or Path("scenario")
    values = resolve(default_parameter_set(actuator), {}, source).values
    values = {"reference_resistance": PhysicalValue(2.2, "ohm"), **values}
    values |= dict(actuator.parameters)

    def si(name: str, unit: str) -> float:
        value = values.get(name)
        if not isinstance(value, PhysicalValue):
            raise InputError(
                source,
                f"components.actuator.parameters.{name}",
                "closed forms need one number",
                "give one value for all coils, or use the shipped parameter set",
            )
        return value.to(unit)

    conductance = si("heat_transfer_coefficient", "W/(m^2*K)") * si("area", "m^2")
    capacity = si("density", "kg/m^3") * si("volume", "m^3") * si("specific_heat", "J/(kg*K)")
    is_regressed = values.get("use_regressed_cooling_rate", True) is True
    rate = si("cooling_rate", "1/s") if is_regressed else conductance / capacity
    resistance = si("reference_resistance", "ohm")
    return tuple(Row(n, resistance, conductance, capacity, ambient, rate) for n in network.strings)


def on_grid(time: float, rig: Rig, up: bool = True) -> float:
    """A time on the grid of macro-steps, not before (or not after) the one given [s]."""
    count = time / rig.step
    return round((math.ceil(count - 1e-9) if up else math.floor(count + 1e-9)) * rig.step, 9)


@dataclass(frozen=True)
class Settings:
    """An engine of the fabric and changes of its settings."""

    engine: str
    solver: Mapping[str, object]


def _voltages(candidate: Candidate, rig: Rig, time: float) -> list[float]:
    """Of every string from a switch on [V]."""
    found = [0.0] * len(rig.rows)
    for p in candidate.pulses:
        if p.begin <= time < p.end:
            found[p.row - 1] = p.voltage
        elif p.held <= time < p.until:
            found[p.row - 1] = rig.rows[p.row - 1].holding_voltage(candidate.hold)
    return found


def scenario_for(
    candidate: Candidate, rig: Rig, settings: Settings | None = None, start: int = 0, end: float | None = None
) -> Scenario:
    """The scenario that carries a candidate out; it begins one drape before the first switch, and ends at the deadline.

    Args:
        candidate: The design.
        rig: Scenario of the task.
        settings: Another engine and other settings; None: those of the scenario.
        start: Number of the random start; 0: the scenario's own.
        end: Where the run is to stop before the deadline [s], a whole number of output steps from it.
    """
    rig = rig.with_keys(candidate.keys)
    base = rig.scenario
    stop, grain = candidate.deadline, seconds(nanoseconds(base.time.output_step))
    # The run ends at the deadline exactly; its length must be a whole number of output steps.
    begin = round(stop - math.ceil((stop - candidate.begin + DRAPE) / grain - 1e-9) * grain, 9)
    switches = {m for p in candidate.pulses for m in (p.begin, p.end, p.held, p.until)}
    moments = sorted({begin, *(m for m in switches if begin < m < stop)})
    points = [(m, _voltages(candidate, rig, m)) for m in moments]
    supply, fabric = base.components[rig.supply[0]], base.components[rig.fabric]
    assert isinstance(supply, ProgrammeComponent)
    assert isinstance(fabric, FabricComponent)
    output = ProgrammeOutput(
        unit="V",
        dim="string",
        points=[(PhysicalValue(t, "s"), [PhysicalValue(float(f"{v:.9g}"), "V") for v in volts]) for t, volts in points],
    )
    own = {"start_number": PhysicalValue(float(start), ""), "start_speed": PhysicalValue(1.0, "mm/s")} if start else {}
    update: dict[str, object] = {"parameters": {**fabric.parameters, **own}}
    if settings is not None:
        update["engine"] = settings.engine
        update["solver"] = fabric.solver.model_copy(update=dict(settings.solver))
    components = {
        **base.components,
        rig.supply[0]: supply.model_copy(update={"outputs": {**supply.outputs, rig.supply[1]: output}}),
        rig.fabric: fabric.model_copy(update=update),
    }
    last = PhysicalValue(stop if end is None else end, "s")
    time = base.time.model_copy(update={"start": PhysicalValue(begin, "s"), "stop": last})
    return base.model_copy(update={"components": components, "time": time})
