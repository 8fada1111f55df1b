"""One design: which rows are heated, how, and the scenario that does it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

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
from cosim.parameters import resolve
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import seconds
from cosim.unit.quantity import PhysicalValue

#: Time in which a fabric that was woven flat falls into its drape before anything is switched [s].
DRAPE = 2.5


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

    @property
    def free(self) -> tuple[int, ...]:
        """Rows that are not tethered, counted from 1."""
        return tuple(range(self.held + 1, len(self.rows) + 1))

    @property
    def step(self) -> float:
        """Macro-step [s]."""
        return self.scenario.time.macro_step.to("s")


@dataclass(frozen=True)
class Candidate:
    """Heated rows with one programme: heated from `begin` to `end`, off until `held`, then held until the deadline.

    A coil that has transformed keeps its stiffness while it cools down to `hold`, so nothing is spent until then.

    Args:
        rows: Heated rows, counted from 1.
        voltage: While heated [V].
        hot: Temperature at the end of heating [K].
        hold: Temperature of the hold [K].
        begin: [s], on the grid of macro-steps.
        end: [s], the same.
        held: [s], the same; later than the deadline where the coils are still warm then.
        deadline: [s].
    """

    rows: tuple[int, ...]
    voltage: float
    hot: float
    hold: float
    begin: float
    end: float
    held: float
    deadline: float

    def energy(self, rig: Rig) -> float:
        """Electrical energy until the deadline [J], by the closed form."""
        return sum(
            rig.rows[r - 1].power(self.voltage) * (self.end - self.begin)
            + rig.rows[r - 1].power(rig.rows[r - 1].holding_voltage(self.hold)) * max(self.deadline - self.held, 0.0)
            for r in self.rows
        )

    def text(self) -> str:
        """For people."""
        rows = ", ".join(map(str, self.rows))
        if not self.rows:
            return "no row heated"
        held = f", held at {self.hold - 273.15:.3g} degC from {self.held:g} s" if self.held < self.deadline else ""
        return (
            f"rows {rows}: {self.voltage:.3g} V from {self.begin:g} s to {self.end:g} s "
            f"({self.hot - 273.15:.3g} degC){held}"
        )


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


def scenario_for(
    candidate: Candidate, rig: Rig, solver: Mapping[str, object] | None = None, start: int = 0
) -> Scenario:
    """The scenario that carries a candidate out; it begins one drape before the first switch, and ends at the deadline.

    Args:
        candidate: The design.
        rig: Scenario of the task.
        solver: Other settings of Bullet; None: those of the scenario.
        start: Number of the random start; 0: the scenario's own.
    """
    base = rig.scenario
    stop, grain = candidate.deadline, seconds(nanoseconds(base.time.output_step))
    # The run ends at the deadline exactly; its length must be a whole number of output steps.
    begin = round(stop - math.ceil((stop - candidate.begin + DRAPE) / grain - 1e-9) * grain, 9)
    numbers = range(1, len(rig.rows) + 1)
    held = [rig.rows[r - 1].holding_voltage(candidate.hold) if r in candidate.rows else 0.0 for r in numbers]
    heated = [candidate.voltage if r in candidate.rows else 0.0 for r in numbers]
    points = [(begin, [0.0] * len(rig.rows))]
    if candidate.rows:
        points.append((candidate.begin, heated))
    if candidate.rows and candidate.end < stop:
        points.append((candidate.end, [0.0] * len(rig.rows)))
    if candidate.held < stop:
        points.append((candidate.held, held))
    supply, fabric = base.components[rig.supply[0]], base.components[rig.fabric]
    assert isinstance(supply, ProgrammeComponent)
    assert isinstance(fabric, FabricComponent)
    output = ProgrammeOutput(
        unit="V",
        dim="string",
        points=[(PhysicalValue(t, "s"), [PhysicalValue(float(f"{v:.9g}"), "V") for v in volts]) for t, volts in points],
    )
    own = {"start_number": PhysicalValue(float(start), ""), "start_speed": PhysicalValue(1.0, "mm/s")} if start else {}
    changed: dict[str, object] = {"parameters": {**fabric.parameters, **own}}
    if solver is not None:
        changed["solver"] = fabric.solver.model_copy(update=dict(solver))
    components = {
        **base.components,
        rig.supply[0]: supply.model_copy(update={"outputs": {**supply.outputs, rig.supply[1]: output}}),
        rig.fabric: fabric.model_copy(update=changed),
    }
    time = base.time.model_copy(update={"start": PhysicalValue(begin, "s"), "stop": PhysicalValue(stop, "s")})
    return base.model_copy(update={"components": components, "time": time})
