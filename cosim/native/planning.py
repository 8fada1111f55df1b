"""Whether a run can be made without Python between two macro-steps, and the plan for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cosim.native.action import Action
from cosim.native.compose import Composer, Kind
from cosim.native.plan import Actions, Grid, Plan
from cosim.observers.trace import Trace, keep
from cosim.system import System
from cosim.unit.protocol import AnyArray, Unit, Variable

#: Integers up to this are exact as doubles, so that both loops compute the same times (104 days) [ns].
LATEST = 2**53


class NoPlan(Exception):
    """No part of the system can be stepped without Python; the text says why."""


@dataclass(frozen=True)
class Watch:
    """What is to be done beside the steps.

    Args:
        trace: Where outputs are recorded.
        each_step: Called after every macro-step.
        each_record: Called after every macro-step at whose end outputs are recorded, once they are up to date.
    """

    trace: Trace
    each_step: Callable[[], object] | None = None
    each_record: Callable[[], object] | None = None


def native_plan(system: System, kind: Kind, grid: Grid, watch: Watch) -> Plan:
    """The plan of a run.

    Whatever the library cannot do (a unit that is no Co-Simulation FMU, text, an algebraic loop) is called in Python
    from within the plan, in its place.

    Args:
        system: The system, initialised.
        kind: The algorithm, which repeats no step.
        grid: Communication points; `trace.times` begins at its start.
        watch: What is to be done beside the steps.

    Raises:
        LibraryAbsent: There is no compiled library.
        NoPlan: Nothing could be done without Python, or the times are too large.
    """
    composer = Composer(system)
    if max(abs(time) for time in (grid.start, *watch.trace.times[-1:])) > LATEST:
        raise NoPlan("it simulates more than 104 days")
    step = composer.macro_step(kind)
    if not any(action.calls for action in step):
        raise NoPlan("no component is a Co-Simulation FMU in this process")
    step += _called(watch.each_step)
    record = composer.propagation()
    recordings: list[tuple[AnyArray, AnyArray]] = []
    for channel in watch.trace.channels:
        unit, rows = system.units[channel.unit], watch.trace.rows[channel.name]
        live = composer.live(unit, channel.variable.name)
        if live is not None and live.dtype == rows.dtype:
            recordings.append((live, rows))
        else:
            record.append(Action(_recorder(unit, channel.variable, rows, grid)))
    record += _called(watch.each_record)
    return Plan(system, grid, Actions(step, record, recordings, composer.kept, composer.stepped))


def _called(callback: Callable[[], object] | None) -> list[Action]:
    if callback is None:
        return []

    def perform(_time: int, _size: int) -> None:
        callback()

    return [Action(perform)]


def _recorder(unit: Unit, variable: Variable, rows: AnyArray, grid: Grid) -> Callable[[int, int], None]:
    """Records a variable that has no array to be read by address."""

    def perform(time: int, size: int) -> None:
        keep(rows, (time + size - grid.start) // (grid.size * grid.per_record), variable, unit.get(variable.name))

    return perform
