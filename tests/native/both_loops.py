"""One system stepped by the loop in Python and by the native one, and what is compared of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from cosim import programme
from cosim.algorithms import gauss_seidel, jacobi
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuSettings
from cosim.native.plan import Grid
from cosim.native.planning import Watch, native_plan
from cosim.observers.trace import Trace
from cosim.system import System
from cosim.unit.protocol import StepStatus, UnitError

STEP = {"jacobi": jacobi.step, "gauss_seidel": gauss_seidel.step}


@dataclass
class Result:
    """All that a run leaves behind."""

    rows: dict[str, np.ndarray]
    now: dict[str, np.ndarray]
    index: int = 0
    ending: str = ""
    native_share: float = 0.0
    wall_time: dict[str, float] = field(default_factory=dict)

    def check_equals(self, other: Result) -> None:
        """The same to the last bit: recorded rows, present values, number of steps, error text."""
        assert (self.index, self.ending) == (other.index, other.ending)
        for mine, theirs in ((self.rows, other.rows), (self.now, other.now)):
            assert mine.keys() == theirs.keys()
            for name, values in mine.items():
                assert values.dtype == theirs[name].dtype
                assert values.tobytes() == theirs[name].tobytes(), name


@dataclass(frozen=True)
class Course:
    """How long and how finely a system is stepped."""

    kind: str = "jacobi"
    start: int = 0
    size: int = 10_000_000
    steps: int = 40
    per_record: int = 1


def fmu(name: str, path, **parameters: float) -> CoSimulationUnit:
    """A component."""
    return CoSimulationUnit(name, open_fmu(path), FmuSettings(parameters=parameters))


def run(make: Callable[[], System], course: Course, is_native: bool, hand_over: int = 0) -> Result:
    """Step a fresh system to its end, or to what stops it.

    Args:
        make: Makes the system.
        course: Time grid.
        is_native: Which loop.
        hand_over: Every so many steps the other loop makes one step; 0: never.
    """
    system = make()
    try:
        system.initialise(course.start, {})
        times = range(course.start, course.start + course.steps * course.size + 1, course.per_record * course.size)
        trace = Trace(system, times)
        trace.record(course.start)
        loop = _native if is_native else _python
        with np.errstate(invalid="ignore", over="ignore"):  # values that are not finite are found and named anyway
            index, ending, share = loop(system, course, trace, hand_over)
        rows = {c.name: trace.rows[c.name][: trace.count].copy() for c in trace.channels}
        now = {f"{n}.{v}": np.array(u.get(v)) for n, u in system.units.items() for v in u.variables}
        return Result(rows, now, index, ending, share, dict(system.wall_time))
    finally:
        system.terminate()


def _step_in_python(system: System, course: Course, index: int) -> str:
    outcome = STEP[course.kind](system, course.start + index * course.size, course.size)
    return "" if outcome.status is StepStatus.OK else f"{outcome.status} {outcome.time} {outcome.message}"


def _record_in_python(system: System, course: Course, trace: Trace, index: int) -> None:
    if index % course.per_record == 0:
        system.propagate()
        trace.count = index // course.per_record
        trace.record(course.start + index * course.size)


def _python(system: System, course: Course, trace: Trace, _hand_over: int) -> tuple[int, str, float]:
    index = 0
    try:
        while index < course.steps:
            ending = _step_in_python(system, course, index)
            if ending:
                return index, ending, 0.0
            index += 1
            _record_in_python(system, course, trace, index)
    except UnitError as error:
        return index, f"{error} {error.time} {error.remedy}", 0.0
    return index, "", 0.0


def _native(system: System, course: Course, trace: Trace, hand_over: int) -> tuple[int, str, float]:
    plan = native_plan(system, course.kind, Grid(course.start, course.size, course.per_record), Watch(trace))
    index = 0
    try:
        while index < course.steps:
            if hand_over and index % hand_over == hand_over - 1:
                ending = _step_in_python(system, course, index)
                if ending:
                    return index, ending, plan.native_share
                index += 1
                _record_in_python(system, course, trace, index)
                continue
            stop = min(course.steps, (index // hand_over + 1) * hand_over - 1) if hand_over else course.steps
            try:
                outcome = plan.advance(index, stop)
            finally:
                index, trace.count = plan.index, plan.recorded
            if outcome.status is not StepStatus.OK:
                return index, f"{outcome.status} {outcome.time} {outcome.message}", plan.native_share
    except UnitError as error:
        return index, f"{error} {error.time} {error.remedy}", plan.native_share
    return index, "", plan.native_share


def compare(make: Callable[[], System], course: Course, hand_over: int = 0) -> Result:
    """Run both loops and check that they agree; returns the native result."""
    native = run(make, course, is_native=True, hand_over=hand_over)
    native.check_equals(run(make, course, is_native=False))
    return native


def held(times: Sequence[int], values: Sequence[float]) -> programme.Course:
    """A programme whose values hold from each time [ns] on."""
    return programme.Course(tuple(times), np.array(values, dtype=float), "1", None, is_linear=False)


def linear(times: Sequence[int], values: Sequence[float]) -> programme.Course:
    """A programme interpolated between times [ns]."""
    return programme.Course(tuple(times), np.array(values, dtype=float), "1", None, is_linear=True)
