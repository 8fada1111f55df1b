"""Components and the connections between their variables, checked once."""

from __future__ import annotations

import time as clock
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from cosim.connection import Connection, ConnectionFault, Element, Transfer
from cosim.loops import AlgebraicLoop, Propagation
from cosim.nearest import did_you_mean
from cosim.unit.protocol import (
    AnyArray,
    Causality,
    ParallelUnit,
    StepOutcome,
    StepStatus,
    Unit,
    UnitError,
    Variable,
    VariableType,
)

__all__ = ["Connection", "ConnectionFault", "System"]


@dataclass
class System:
    """Units, the connections that lead into each, and the time spent in each.

    Args:
        units: Name to unit, in the order in which Gauss-Seidel steps them.
        connections: All connections.
        sources: Names of units that are functions of time alone; they are sampled before any other unit steps.

    Raises:
        ConnectionFault: An unknown name, a wrong causality, type or shape, two connections into one input, or an input
            that is neither connected nor has a start value.
    """

    units: Mapping[str, Unit]
    connections: Sequence[Connection]
    sources: frozenset[str] = frozenset()
    wall_time: dict[str, float] = field(init=False)
    has_parallel_units: bool = field(init=False)
    transfers: dict[str, list[Transfer]] = field(init=False)
    #: Names of all units but the sources, in order.
    movers: list[str] = field(init=False)
    #: Connections into them that `propagate` leaves to be carried out.
    unsettled: list[Transfer] = field(init=False)

    def __post_init__(self) -> None:
        self.has_parallel_units = sum(isinstance(u, ParallelUnit) for u in self.units.values()) > 1
        self.wall_time = dict.fromkeys(self.units, 0.0)
        inputs: dict[tuple[str, str], Transfer] = {}
        for connection in self.connections:
            self._check(connection)
            target = self.units[connection.target[0]]
            transfer = inputs.setdefault(connection.target, Transfer(target, target.variables[connection.target[1]]))
            transfer.add(connection, self.units[connection.source[0]])
        self.transfers = {name: [t for end, t in inputs.items() if end[0] == name] for name in self.units}
        self._check_inputs()
        #: What `propagate` does.
        self.propagation = Propagation(self.units, self.transfers, lambda u: u.feedthrough, is_complete=False)
        self.movers = [name for name in self.units if name not in self.sources]
        settled = {id(transfer) for transfer in self.propagation.settled}
        self.unsettled = [t for name in self.movers for t in self.transfers[name] if id(t) not in settled]
        self._initial = Propagation(self.units, self.transfers, lambda u: u.initial_feedthrough, is_complete=True)

    @property
    def loops(self) -> Sequence[AlgebraicLoop]:
        """Algebraic loops between outputs and inputs of one instant while the system steps."""
        return self.propagation.loops

    @property
    def initial_loops(self) -> Sequence[AlgebraicLoop]:
        """Algebraic loops between start values."""
        return self._initial.loops

    def _variable(self, end: tuple[str, str], causalities: set[Causality], connection: Connection) -> Variable:
        if end[0] not in self.units:
            raise ConnectionFault(
                f"{connection}: there is no component {end[0]}{_instead(end[0], self.units, 'there are')}"
            )
        variables = self.units[end[0]].variables
        found = variables.get(end[1])
        if found is None or found.causality not in causalities:
            names = [n for n, v in variables.items() if v.causality in causalities]
            what = "input" if Causality.INPUT in causalities else "output"
            if what == "output" and end[1] in getattr(self.units[end[0]], "unrecorded", ()):
                raise ConnectionFault(
                    f"{connection}: {end[1]} is no output of {end[0]}, but a local variable of its FMU; "
                    f"name it there, `record: [{end[1]}]`, and it can be connected"
                )
            raise ConnectionFault(f"{connection}: {end[0]} has no {what} {end[1]}{_instead(end[1], names, 'it has')}")
        return found

    def _check(self, connection: Connection) -> None:
        source = self._variable(connection.source, {Causality.OUTPUT, Causality.LOCAL}, connection)
        target = self._variable(connection.target, {Causality.INPUT}, connection)
        shapes = [
            _shape(v, e, connection)
            for v, e in ((source, connection.source_element), (target, connection.target_element))
        ]
        if shapes[0] != shapes[1] and shapes[0] != ():
            raise ConnectionFault(f"{connection}: shape {shapes[0]} does not fit shape {shapes[1]}")
        if not target.type.accepts(source.type):
            raise ConnectionFault(
                f"{connection}: {source.type.value} does not fit {target.type.value} without loss; "
                f"{_remedy(source.type, target.type)}"
            )
        can_scale = source.type.is_number or source.type is VariableType.BOOLEAN
        if connection.is_scaled and not (target.type.is_number and can_scale):
            raise ConnectionFault(
                f"{connection}: a value of type {source.type.value} cannot be scaled; "
                "connect it without factor and offset"
            )

    def _check_inputs(self) -> None:
        for name, unit in self.units.items():
            connected = {t.variable.name: t for t in self.transfers[name]}
            for variable in unit.variables.values():
                if variable.causality is not Causality.INPUT or variable.start is not None:
                    continue
                if variable.name not in connected:
                    raise ConnectionFault(f"{name}.{variable.name}: nothing is connected to this input; connect it")
                missing = connected[variable.name].missing
                if missing is not None:
                    element = ",".join(str(i + 1) for i in missing)
                    raise ConnectionFault(
                        f"{name}.{variable.name}[{element}]: nothing is connected to this element "
                        "of the input; connect it"
                    )

    def initialise(self, time: int, start: Mapping[str, Mapping[str, float]]) -> None:
        """Initialise every unit in order, then exchange start values until all agree, loops included.

        An input whose source comes later in the order takes its first value from `start` or from the variable's own
        start value; it is set again once all units are initialised.

        Args:
            time: Start time [ns].
            start: Unit to input to first value (SI), for feedback connections.

        Raises:
            ConnectionFault: A feedback input has no start value.
            UnitError: A unit cannot begin, or a loop of start values has no solution.
        """
        ready: set[str] = set()
        for name, unit in self.units.items():
            for transfer in self.transfers[name]:
                self._first_value(transfer, ready, start.get(name, {}))
            begin = clock.perf_counter()
            unit.initialise(time)
            self.wall_time[name] += clock.perf_counter() - begin
            ready.add(name)
        self._initial.carry_out()
        for unit in self.units.values():
            unit.exit_initialisation()
        self.exchange_all()

    def _first_value(self, transfer: Transfer, ready: set[str], start: Mapping[str, float]) -> None:
        late = next((p.connection for p in transfer.parts if p.connection.source[0] not in ready), None)
        if late is None:
            transfer.carry_out()
            return
        variable = transfer.variable
        value = start.get(variable.name, variable.start)
        if value is None:
            raise ConnectionFault(
                f"{late}: {late.source[0]} is initialised after {late.target[0]}, so this input "
                f"needs a first value; give components.{late.target[0]}.start.{variable.name}"
            )
        transfer.buffer[...] = value
        transfer.write()

    def exchange(self, name: str) -> None:
        """Carry out all connections into one unit."""
        for transfer in self.transfers[name]:
            transfer.carry_out()

    def exchange_all(self) -> None:
        """Carry out every connection, those with direct feedthrough in the order in which outputs follow.

        Clocks are left out: a tick is handed over once, in the step that follows it.
        """
        self.propagation.carry_out()
        for name in self.units:
            for transfer in self.transfers[name]:
                if not transfer.is_clock:
                    transfer.carry_out()

    def propagate(self) -> None:
        """Let every output that depends directly on an input follow the outputs of this instant."""
        self.propagation.carry_out()

    def step(self, name: str, time: int, size: int) -> StepOutcome:
        """Step one unit and add its wall time."""
        begin = clock.perf_counter()
        outcome = self.units[name].do_step(time, size)
        self.wall_time[name] += clock.perf_counter() - begin
        return outcome

    def sample_sources(self, time: int, size: int) -> None:
        """Let the functions of time take their values for a step."""
        for name in self.sources:
            self.step(name, time, size)

    def step_together(self, names: Sequence[str], time: int, size: int) -> StepOutcome:
        """Step units that do not wait for each other; those in processes of their own step at the same time.

        Returns:
            The first outcome that is not OK, in the order of `names`, or the last.

        Raises:
            UnitError: A unit cannot go on; every step that had begun has ended.
        """
        elsewhere = [n for n in names if isinstance(self.units[n], ParallelUnit)] if self.has_parallel_units else []
        if len(elsewhere) < 2:
            return self._in_turn(names, time, size)
        begun: list[ParallelUnit] = []
        outcomes: dict[str, StepOutcome] = {}
        try:
            for name in elsewhere:
                unit = self.units[name]
                assert isinstance(unit, ParallelUnit)
                unit.begin_step(time, size)
                begun.append(unit)
            here = self._in_turn([n for n in names if n not in elsewhere], time, size)
            for name in elsewhere:
                begin = clock.perf_counter()
                outcomes[name] = begun.pop(0).finish_step()
                self.wall_time[name] += clock.perf_counter() - begin
        finally:
            for remote in begun:  # only after an error, which is the one to be told
                with suppress(UnitError):
                    remote.finish_step()
        return next((o for o in (here, *outcomes.values()) if o.status is not StepStatus.OK), here)

    def _in_turn(self, names: Sequence[str], time: int, size: int) -> StepOutcome:
        outcome = StepOutcome(StepStatus.OK, time + size)
        for name in names:
            outcome = self.step(name, time, size)
            if outcome.status is not StepStatus.OK:
                return outcome
        return outcome

    def value(self, name: str, variable: str) -> AnyArray:
        """Copy of a unit's variable."""
        return np.array(self.units[name].get(variable))

    def save(self) -> dict[str, object]:
        """States of all units, for `restore` and `release`; raises UnitError if one cannot return."""
        return {name: unit.save() for name, unit in self.units.items()}

    def restore(self, saved: Mapping[str, object], time: int) -> None:
        """Return the saved units to what they were at `time` [ns]."""
        for name, state in saved.items():
            self.units[name].restore(state, time)

    def release(self, saved: Mapping[str, object]) -> None:
        """Free saved states."""
        for name, state in saved.items():
            self.units[name].release(state)

    def terminate(self) -> None:
        """Terminate every unit."""
        for unit in self.units.values():
            unit.terminate()


def _remedy(source: VariableType, target: VariableType) -> str:
    """What to do where a value of one type cannot go to another."""
    if source.is_number and target.is_number:
        return f"connect an output of type {target.value}, or round it in an FMU between them"
    if source.is_number and target is VariableType.BOOLEAN:
        return "put an FMU between them that says from which value on it is true"
    return f"connect an output of type {target.value}"


def _shape(variable: Variable, element: Element | None, connection: Connection) -> tuple[int, ...]:
    if element is None:
        return variable.shape
    if len(element) != len(variable.shape) or any(not 0 <= i < n for i, n in zip(element, variable.shape)):
        raise ConnectionFault(f"{connection}: {variable.name} has shape {variable.shape}; there is no such element")
    return ()


def _instead(name: str, known: Collection[str], begin: str) -> str:
    """The rest of a sentence about a name that does not exist: what may be meant, and what there is."""
    hint, names = did_you_mean(name, known), ", ".join(known) or "none"
    return f"{hint} {begin.capitalize()}: {names}" if hint else f"; {begin}: {names}"
