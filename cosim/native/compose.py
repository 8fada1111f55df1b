"""From a system and its algorithm to the actions of one macro-step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal, TypeGuard

import numpy as np

from cosim.connection import Transfer
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.native.action import Action, Call
from cosim.native.copies import copy_operation
from cosim.native.courses import course_call
from cosim.native.fmu_calls import is_carried, is_plain, next_event, read_calls, step_call, write_call
from cosim.programme import ProgrammeUnit
from cosim.system import System
from cosim.unit.protocol import AnyArray, StepOutcome, Unit

Kind = Literal["jacobi", "gauss_seidel"]


class Composer:
    """Translates what an algorithm does in one macro-step; what has no translation stays with Python.

    Args:
        system: Initialised units and their connections.
    """

    def __init__(self, system: System) -> None:
        self._system = system
        self._index: Mapping[str, int] = {name: i for i, name in enumerate(system.units)}
        #: Number of the wall time that belongs to no unit.
        self.own = len(system.units)
        #: Arrays whose addresses the operations hold.
        self.kept: list[AnyArray] = []
        #: FMUs that the library steps.
        self.stepped: list[CoSimulationUnit] = []

    def macro_step(self, kind: Kind) -> list[Action]:
        """What `cosim.algorithms.jacobi` and `cosim.algorithms.gauss_seidel` do, in their order."""
        system = self._system
        actions = [self._step(name) for name in system.sources]
        actions += self.propagation()
        if kind == "jacobi":
            actions += [self._transfer(t) for t in system.unsettled]
            return actions + [self._step(name) for name in system.movers]
        for name in system.movers:
            actions += [self._transfer(t) for t in system.transfers[name]]
            actions.append(self._step(name))
        return actions

    def propagation(self) -> list[Action]:
        """What `System.propagate` does."""
        return list(self._propagation())

    def live(self, unit: Unit, variable: str) -> AnyArray | None:
        """The array that always holds a variable's present value; None where there is none to be read by address."""
        if not isinstance(unit, CoSimulationUnit | ProgrammeUnit):
            return None
        array = unit.get(variable)
        return array if is_carried(array) else None

    def _propagation(self) -> Iterator[Action]:
        for action in self._system.propagation.actions:
            owner: Any = getattr(action, "__self__", None)
            if isinstance(owner, Transfer):
                yield self._transfer(owner)
            elif isinstance(owner, CoSimulationUnit):
                yield self._refresh(owner)
            else:
                yield Action(lambda _time, _size, action=action: action())  # type: ignore[misc]

    def _transfer(self, transfer: Transfer) -> Action:
        def perform(_time: int, _size: int) -> None:
            transfer.carry_out()

        return Action(perform, self._transfer_calls(transfer) or ())

    def _transfer_calls(self, transfer: Transfer) -> list[Call] | None:
        name = transfer.variable.name
        if not self._is_plain(transfer.target) or name not in transfer.target.writers:
            return None
        write = write_call(transfer.target.writers[name], transfer.buffer, self.own)
        if write is None:
            return None
        copies = []
        for part in transfer.parts:
            source = self.live(part.source, part.connection.source[1])
            copy = None if source is None else copy_operation(part.connection, source, part.buffer, self.own)
            if copy is None:
                return None
            copies.append(Call(copy))
        return [*copies, write]

    def _step(self, name: str) -> Action:
        unit, system = self._system.units[name], self._system

        def perform(time: int, size: int) -> StepOutcome:
            return system.step(name, time, size)

        if isinstance(unit, ProgrammeUnit):
            return Action(perform, self._courses(unit), can_be_empty=True)
        if not self._is_plain(unit):
            return Action(perform)
        read = self._read(unit, self._index[name])
        if read is None:
            return Action(perform)
        due = np.empty(1)
        self.kept.append(due)
        self.stepped.append(unit)

        def prepare() -> None:
            due[0] = next_event(unit)

        return Action(perform, [step_call(unit, self._index[name], due), *read], prepare=prepare)

    def _courses(self, unit: ProgrammeUnit) -> list[Call]:
        calls = []
        for name, course in unit.courses.items():
            if len(course.times) > 1:
                call, *arrays = course_call(course, unit.get(name), self._index[unit.name])
                self.kept += arrays
                calls.append(call)
        return calls

    def _refresh(self, unit: CoSimulationUnit) -> Action:
        def perform(_time: int, _size: int) -> None:
            unit.refresh()

        return Action(perform, (self._read(unit, self.own) if self._is_plain(unit) else None) or ())

    def _read(self, unit: CoSimulationUnit, index: int) -> list[Call] | None:
        """Get all outputs; None where one needs Python."""
        calls: list[Call] = []
        for access in unit.buffers.group_readers:
            found = read_calls(access, index)
            if found is None:
                return None
            calls += found
        return calls

    def _is_plain(self, unit: Unit) -> TypeGuard[CoSimulationUnit]:
        connected = {t.variable.name for t in self._system.transfers[unit.name]}
        return isinstance(unit, CoSimulationUnit) and is_plain(unit, connected)
