"""Macro-steps without Python: the plan of one macro-step, carried out by the compiled library many times."""

from __future__ import annotations

import bisect
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.native.action import Action
from cosim.native.compiled import library
from cosim.native.layout import Code, Cursor, Operation, PlanLayout, Recording, Return
from cosim.system import System
from cosim.unit.protocol import AnyArray, StepOutcome, StepStatus

#: Wall time after which `Plan.advance` comes back, so that interrupts and progress have their turn [s].
TURN = 0.05


@dataclass(frozen=True)
class Grid:
    """Communication points and recorded points.

    Args:
        start: Begin of macro-step 0 [ns].
        size: Length of a macro-step [ns].
        per_record: Macro-steps from one recorded row to the next; 0 records none.
    """

    start: int
    size: int
    per_record: int = 0


@dataclass(frozen=True)
class Actions:
    """What happens, in order.

    Args:
        step: In every macro-step.
        record: After a macro-step at whose end rows are recorded, before they are.
        recordings: (live array, rows): the array is copied to row `index / per_record` of `rows`.
        kept: Arrays whose addresses the operations hold.
        units: FMUs that the library steps.
    """

    step: Sequence[Action]
    record: Sequence[Action] = ()
    recordings: Sequence[tuple[AnyArray, AnyArray]] = ()
    kept: Sequence[AnyArray] = ()
    units: Sequence[CoSimulationUnit] = ()


class Plan:
    """Steps a system as `cosim.algorithms.jacobi` and `gauss_seidel` do, to the same bits.

    All values stay in the units' own arrays: Python can go on after any macro-step.

    Args:
        system: The system; its wall times are kept up to date.
        grid: Communication points.
        actions: What happens.

    Raises:
        LibraryAbsent: There is no compiled library.
    """

    def __init__(self, system: System, grid: Grid, actions: Actions) -> None:
        self._system, self._grid, self._library = system, grid, library()
        self._actions = [*actions.step, *actions.record]
        self._kept = actions
        parts = [a.operations for a in self._actions]
        self._first = np.cumsum([0, *map(len, parts)]).tolist()
        self._step_count: int = self._first[len(actions.step)]
        operations = [o for part in parts for o in part]
        for operation in operations:
            if operation.code == Code.PYTHON:
                operation.unit = len(system.units)
        self._operations = (Operation * len(operations))(*operations)
        self._recordings = (Recording * len(actions.recordings))(
            *(Recording(a.ctypes.data, rows.ctypes.data, a.nbytes) for a, rows in actions.recordings)
        )
        self._wall_time = np.zeros(len(system.units) + 1)
        self._sample = np.zeros_like(self._wall_time)
        self._layout = PlanLayout(
            self._operations,
            self._step_count,
            len(operations),
            self._recordings,
            len(actions.recordings),
            grid.per_record,
            grid.start,
            grid.size,
            self._wall_time.ctypes.data,
            self._sample.ctypes.data,
            len(system.units),
        )
        self._cursor = Cursor()

    @property
    def index(self) -> int:
        """Macro-steps completed; after an error, those completed before it."""
        return int(self._cursor.index) + int(self._cursor.operation >= self._step_count)

    @property
    def recorded(self) -> int:
        """Rows recorded, that of the start included; a step that fails while its outputs settle records none."""
        return int(self._cursor.index) // self._grid.per_record + 1 if self._grid.per_record else 1

    @property
    def native_share(self) -> float:
        """Part of the actions that need no Python, in [0, 1]."""
        return sum(bool(a.calls) or a.can_be_empty for a in self._actions) / max(len(self._actions), 1)

    def advance(self, index: int, stop: int) -> StepOutcome:
        """Make macro-steps from `index` on.

        Args:
            index: Macro-steps completed so far.
            stop: Macro-steps completed at the end.

        Returns:
            OK at the time reached, which is before `stop` where `TURN` has passed (see `index`); or the first outcome
            of a unit that is not OK.

        Raises:
            UnitError: The one that the loop in Python would have raised.
        """
        self._cursor.index, self._cursor.operation = index, 0
        for action in self._actions:
            if action.prepare is not None:
                action.prepare()
        deadline = clock.perf_counter() + TURN
        try:
            while True:
                left = max(deadline - clock.perf_counter(), 0.0)
                found = self._library.cosim_advance(self._layout, self._cursor, stop, left)
                if found in (Return.REACHED, Return.PAUSED):
                    self._hand_over()
                    return StepOutcome(StepStatus.OK, self._grid.start + self.index * self._grid.size)
                outcome = self._in_python(Return(found))
                if outcome is not None and outcome.status is not StepStatus.OK:
                    return outcome
        finally:
            self._share_out()

    def _in_python(self, found: Return) -> StepOutcome | None:
        """Do the action at which the library stopped, and put the cursor behind it."""
        cursor = self._cursor
        number = bisect.bisect_right(self._first, cursor.operation) - 1
        position = cursor.operation - self._first[number]
        time = self._grid.start + cursor.index * self._grid.size
        status = cursor.status if found is Return.REFUSED else 0
        action = self._actions[number]
        if found is Return.CALLED:
            outcome = action.perform(time, self._grid.size)
        else:
            outcome = action.repeat(position, status, time, self._grid.size)
        if action.prepare is not None:
            action.prepare()
        if outcome is None or outcome.status is StepStatus.OK:
            cursor.operation = self._first[number + 1]
        return outcome

    def _hand_over(self) -> None:
        """Tell the FMUs' units where they stand, so that Python can go on from here."""
        for unit in self._kept.units:
            unit.moved_to(self._grid.start + self.index * self._grid.size, self._grid.size)

    def _share_out(self) -> None:
        for name, spent in zip(self._system.wall_time, self._wall_time.tolist()):
            self._system.wall_time[name] += spent
        self._wall_time[:] = 0.0
