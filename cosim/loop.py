"""The loop over macro-steps: in Python for any system, in C where the units allow it; both give the same bits."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass
from typing import Protocol

from cosim.algorithms.algorithm import Algorithm, Plain
from cosim.fmu.unit import FmuUnit
from cosim.native import plan as native
from cosim.native.compiled import LibraryAbsent, tell_once
from cosim.native.plan import Grid
from cosim.native.planning import NoPlan, Watch, native_plan
from cosim.observers.energy_balance import EnergyMeter
from cosim.observers.trace import Trace
from cosim.system import System
from cosim.unit.protocol import StepOutcome, StepStatus, seconds


class Loop(Protocol):
    """Makes macro-steps and records what is due."""

    #: `C` or `Python`, for the summary of the run.
    language: str

    @property
    def native_share(self) -> float:
        """Part of what a macro-step does that needs no Python, in [0, 1]."""
        ...

    @property
    def index(self) -> int:
        """Macro-steps completed; after an error, those completed before it."""
        ...

    def advance(self, index: int, stop: int) -> StepOutcome:
        """Make macro-steps from `index` to `stop`, or fewer where some wall time has passed.

        Returns:
            OK, or the first outcome that is not OK.

        Raises:
            UnitError: A unit cannot go on.
        """
        ...


@dataclass(frozen=True)
class Watched:
    """What is stepped and who looks on.

    Args:
        system: The initialised system.
        trace: Where outputs are recorded.
        meter: Adds up energies.
        grid: Communication points and recorded points.
    """

    system: System
    trace: Trace
    meter: EnergyMeter
    grid: Grid


class PythonLoop(Loop):
    """One call of the algorithm per macro-step.

    Args:
        watched: What is stepped.
        algorithm: Makes the steps.
    """

    language = "Python"
    native_share = 0.0

    def __init__(self, watched: Watched, algorithm: Algorithm) -> None:
        self._watched, self._algorithm = watched, algorithm
        self._index = 0

    @property
    def index(self) -> int:
        """Macro-steps completed."""
        return self._index

    def advance(self, index: int, stop: int) -> StepOutcome:
        """See `Loop.advance`."""
        watched, grid, step = self._watched, self._watched.grid, self._algorithm
        system, trace, meter, length = watched.system, watched.trace, watched.meter, seconds(grid.size)
        self._index = index
        deadline = clock.perf_counter() + native.TURN
        outcome = StepOutcome(StepStatus.OK, grid.start + index * grid.size)
        while self._index < stop:
            outcome = step(system, grid.start + self._index * grid.size, grid.size)
            if outcome.status is not StepStatus.OK:
                return outcome
            self._index += 1
            if meter.units:
                meter.add_step(length)
            if self._index % grid.per_record == 0:
                system.propagate()
                trace.record(grid.start + self._index * grid.size)
                meter.note_largest()
            if clock.perf_counter() > deadline:
                break
        return outcome


class NativeLoop(Loop):
    """Macro-steps in C; what needs Python is called in its place.

    Args:
        watched: What is stepped.
        kind: `gauss_seidel` or `jacobi`.

    Raises:
        LibraryAbsent: The compiled library is not there.
        NoPlan: It would bring nothing here.
    """

    language = "C"

    def __init__(self, watched: Watched, kind: str) -> None:
        self._watched = watched
        meter, length = watched.meter, seconds(watched.grid.size)
        watch = Watch(
            watched.trace,
            (lambda: meter.add_step(length)) if meter.units else None,
            meter.note_largest if meter.units else None,
        )
        self._plan = native_plan(watched.system, kind, watched.grid, watch)  # type: ignore[arg-type]

    @property
    def native_share(self) -> float:
        """Part of what a macro-step does that needs no Python; 1: nothing is called back."""
        return self._plan.native_share

    @property
    def index(self) -> int:
        """Macro-steps completed."""
        return self._plan.index

    def advance(self, index: int, stop: int) -> StepOutcome:
        """See `Loop.advance`."""
        try:
            return self._plan.advance(index, stop)
        finally:
            self._watched.trace.count = self._plan.recorded


def choose_loop(watched: Watched, algorithm: Algorithm, kind: str) -> Loop:
    """The loop in C where there is one for this system and algorithm; else that in Python, and why, said once."""
    # What the master adds to an FMU it adds in Python.
    is_parallel = kind == "jacobi" and watched.system.has_parallel_units
    has_terms = any(isinstance(u, FmuUnit) and not u.added.is_empty for u in watched.system.units.values())
    if isinstance(algorithm, Plain) and not is_parallel and not has_terms:
        try:
            return NativeLoop(watched, kind)
        except LibraryAbsent as reason:
            tell_once(str(reason))
        except NoPlan:
            pass  # nothing in this system could be stepped without Python
    return PythonLoop(watched, algorithm)
