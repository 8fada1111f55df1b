"""Components and the connections between their variables, checked once."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from cosim.unit import Array, Causality, StepOutcome, Unit, UnitError, Variable


class ConnectionFault(ValueError):
    """A connection or a component does not fit; the text names it and the remedy."""


@dataclass(frozen=True)
class Connection:
    """A directed connection `source_unit.source_variable -> target_unit.target_variable`.

    Args:
        source: (unit, variable) of an output.
        target: (unit, variable) of an input.
        factor: Target value = factor * source value + offset (unit conversion).
        offset: See factor, in the unit of the target.
    """

    source: tuple[str, str]
    target: tuple[str, str]
    factor: float = 1.0
    offset: float = 0.0

    def __str__(self) -> str:
        return f"{'.'.join(self.source)} -> {'.'.join(self.target)}"


@dataclass
class Transfer:
    """A connection bound to its two units, ready to be carried out."""

    connection: Connection
    source: Unit
    target: Unit

    def carry_out(self) -> None:
        """Copy the output to the input, converted; raises UnitError, naming the connection, if it is not finite."""
        value = self.source.get(self.connection.source[1])
        if self.connection.factor != 1.0 or self.connection.offset != 0.0:
            value = self.connection.factor * value + self.connection.offset
        try:
            self.target.set(self.connection.target[1], value)
        except UnitError as error:
            raise UnitError(error.unit, f"{error.what}, through {self.connection}", error.time, error.remedy) from error


@dataclass
class System:
    """Units, the connections into each, and the time spent in each.

    Args:
        units: Name to unit, in the order in which Gauss-Seidel steps them.
        connections: All connections.
        sources: Names of units that are functions of time alone; they are sampled before any other unit steps.

    Raises:
        ConnectionFault: An unknown name, a wrong causality or shape, two connections into one input, or an input that
            is neither connected nor has a start value.
    """

    units: Mapping[str, Unit]
    connections: Sequence[Connection]
    sources: frozenset[str] = frozenset()
    wall_time: dict[str, float] = field(init=False)
    transfers: dict[str, list[Transfer]] = field(init=False)

    def __post_init__(self) -> None:
        self.wall_time = dict.fromkeys(self.units, 0.0)
        self.transfers = {name: [] for name in self.units}
        for connection in self.connections:
            self._check(connection)
            source, target = self.units[connection.source[0]], self.units[connection.target[0]]
            self.transfers[connection.target[0]].append(Transfer(connection, source, target))
        self._check_inputs()

    def _variable(self, end: tuple[str, str], causality: Causality, connection: Connection) -> Variable:
        if end[0] not in self.units:
            raise ConnectionFault(f"{connection}: there is no component {end[0]}; there are: {', '.join(self.units)}")
        variables = self.units[end[0]].variables
        found = variables.get(end[1])
        if found is None or found.causality is not causality:
            names = ", ".join(n for n, v in variables.items() if v.causality is causality) or "none"
            raise ConnectionFault(f"{connection}: {end[0]} has no {causality.value} {end[1]}; it has: {names}")
        return found

    def _check(self, connection: Connection) -> None:
        source = self._variable(connection.source, Causality.OUTPUT, connection)
        target = self._variable(connection.target, Causality.INPUT, connection)
        if source.shape != target.shape and source.shape != ():
            raise ConnectionFault(f"{connection}: shape {source.shape} does not fit shape {target.shape}")
        if any(t.connection.target == connection.target for t in self.transfers[connection.target[0]]):
            raise ConnectionFault(f"{connection}: another connection already leads into {'.'.join(connection.target)}")

    def _check_inputs(self) -> None:
        for name, unit in self.units.items():
            connected = {t.connection.target[1] for t in self.transfers[name]}
            for variable in unit.variables.values():
                if variable.causality is Causality.INPUT and variable.start is None and variable.name not in connected:
                    raise ConnectionFault(f"{name}.{variable.name}: nothing is connected to this input; connect it")

    def initialise(self, time: int, start: Mapping[str, Mapping[str, float]]) -> None:
        """Initialise every unit in order.

        An input whose source comes later in the order takes its first value from `start` or from the variable's own
        start value; it is set again once all units are initialised.

        Args:
            time: Start time [ns].
            start: Unit to input to first value (SI), for feedback connections.

        Raises:
            ConnectionFault: A feedback input has no start value.
        """
        ready: set[str] = set()
        for name, unit in self.units.items():
            for transfer in self.transfers[name]:
                self._first_value(transfer, ready, start.get(name, {}))
            begin = clock.perf_counter()
            unit.initialise(time)
            self.wall_time[name] += clock.perf_counter() - begin
            ready.add(name)
        self.exchange_all()

    def _first_value(self, transfer: Transfer, ready: set[str], start: Mapping[str, float]) -> None:
        connection = transfer.connection
        if connection.source[0] in ready:
            transfer.carry_out()
            return
        variable = transfer.target.variables[connection.target[1]]
        value = start.get(variable.name, variable.start)
        if value is None:
            raise ConnectionFault(
                f"{connection}: {connection.source[0]} is initialised after {connection.target[0]}, so this input "
                f"needs a first value; give components.{connection.target[0]}.start.{variable.name}"
            )
        transfer.target.set(variable.name, np.full(variable.shape, value))

    def exchange(self, name: str) -> None:
        """Carry out all connections into one unit."""
        for transfer in self.transfers[name]:
            transfer.carry_out()

    def exchange_all(self) -> None:
        """Carry out every connection."""
        for name in self.units:
            self.exchange(name)

    def step(self, name: str, time: int, size: int) -> StepOutcome:
        """Step one unit and add its wall time."""
        begin = clock.perf_counter()
        outcome = self.units[name].do_step(time, size)
        self.wall_time[name] += clock.perf_counter() - begin
        return outcome

    def value(self, name: str, variable: str) -> Array:
        """Copy of a unit's variable."""
        return np.array(self.units[name].get(variable), dtype=np.float64)

    def terminate(self) -> None:
        """Terminate every unit."""
        for unit in self.units.values():
            unit.terminate()
