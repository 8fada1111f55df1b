"""Tasks about rows: which are to be rigid and which flexible, and rows that stiffen one after another."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

from chainmail.design.candidate import Candidate, Pulse, Rig, holding_power, on_grid
from chainmail.design.closed_form import Row, heated_together, nearest_power
from chainmail.design.cycle import cycle_requirements
from chainmail.design.impossible import Impossible
from chainmail.design.row_model import Chain
from chainmail.design.task import Schedule, Shape, Task, Wanted
from cosim.components import nanoseconds
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue

#: Bend of a cold and of a hot row in the row model [rad]: between what was seen of both (docs/design.md).
COLD_BEND, HOT_BEND = math.radians(12.5), math.radians(3.0)

#: Free rows of which all patterns of heated ones are looked at.
MOST_ROWS = 16


def with_requirements(task: Task, rig: Rig, path: Path) -> Task:
    """The task with what `shape`, `schedule` and `cycle` want written out as bends of rows and curvatures.

    Args:
        task: As its file has it.
        rig: Scenario of the task.
        path: File of the task, for errors.

    Raises:
        InputError: A row is none of the free ones, or times do not fit each other.
    """
    wanted, source = list(task.wanted), str(path)
    if task.shape is not None:
        shape = task.shape
        _check_rows([*shape.rigid, *shape.flexible], rig, "shape", source)
        last = max((w.at.to("s") for w in wanted if w.at is not None), default=0.0)
        if last > shape.at.to("s"):
            raise InputError(
                source,
                "shape.at",
                f"rows are heated for the latest time, {last:g} s, and so are not yet hot at {shape.at}",
                "give both the same time",
            )
        wanted += [_bend(rig, r, shape, shape.at.to("s"), is_straight=True) for r in shape.rigid if r < len(rig.rows)]
        wanted += [
            _bend(rig, r, shape, shape.at.to("s"), is_straight=False) for r in shape.flexible if r < len(rig.rows)
        ]
    if task.schedule is not None:
        plan = task.schedule
        _check_rows(list(plan.rows), rig, "schedule.rows", source)
        for moment in sorted({t.to("s") for t in plan.rows.values()}):
            at = moment + plan.settle.to("s")
            for row, time in plan.rows.items():
                if row < len(rig.rows) and (time.to("s") <= moment or time.to("s") > at):
                    wanted.append(_bend(rig, row, plan, at, is_straight=time.to("s") <= moment))
    if task.cycle is not None:
        grain = rig.scenario.time.output_step
        if nanoseconds(task.cycle.period) % nanoseconds(grain):
            problem = f"{task.cycle.period} is no multiple of time.output_step, {grain}"
            raise InputError(source, "cycle.period", problem, "runs end at the end of a cycle; take a multiple")
        wanted += cycle_requirements(task.cycle, rig)
    if not wanted:
        raise InputError(
            source,
            "wanted",
            "nothing is wanted whose rows can be seen to bend",
            "the last row has no bend: name others, or give `wanted`",
        )
    return task.model_copy(update={"wanted": wanted})


def _check_rows(rows: Sequence[int], rig: Rig, key: str, source: str) -> None:
    wrong = sorted(set(rows) - set(rig.free))
    if wrong:
        raise InputError(
            source,
            key,
            f"row {wrong[0]} is no free row of the fabric",
            f"free rows are {rig.free[0]} to {rig.free[-1]}",
        )


def _bend(rig: Rig, row: int, given: Shape | Schedule, at: float, is_straight: bool) -> Wanted:
    bound = {"below": given.straight} if is_straight else {"above": given.bent}
    return Wanted(
        quantity=f"{rig.fabric}.row_bend",
        over="at",
        at=PhysicalValue(round(at, 9), "s"),
        of=row,
        unit="deg",
        share=given.share,
        confidence=given.confidence,
        **bound,
    )


def fewest_rows(shape: Shape, rig: Rig) -> list[tuple[int, ...]]:
    """Patterns of heated rows that have the shape by the row model, out of all that there are; fewest rows first.

    Of more than `MOST_ROWS` free rows only the pattern that heats the rigid ones is looked at.

    >>> from types import SimpleNamespace
    >>> rig = SimpleNamespace(free=(3, 4, 5, 6), rows=(0,) * 6, held=2)
    >>> shape = Shape(rigid=[3, 4, 6], flexible=[5], at="5 s")
    >>> fewest_rows(shape, rig)
    [(3, 4, 6)]
    """
    if len(rig.free) > MOST_ROWS:
        every = [tuple(sorted(shape.rigid))]
    else:
        every = [p for n in range(len(rig.free) + 1) for p in combinations(rig.free, n)]
    return [p for p in every if _has_shape(p, shape, rig)]


def _has_shape(hot: tuple[int, ...], shape: Shape, rig: Rig) -> bool:
    angles = Chain(len(rig.rows), rig.held, 1.0, COLD_BEND, HOT_BEND).angles(hot)
    bends = {row: angles[row - rig.held] - angles[row - rig.held - 1] for row in range(rig.held + 1, len(rig.rows))}
    # Nothing hangs on the last row, so nothing bends it: it is rigid where it is hot.
    bends[len(rig.rows)] = HOT_BEND if len(rig.rows) in hot else COLD_BEND
    straight, bent = shape.straight.to("rad"), shape.bent.to("rad")
    return all(bends[r] < straight for r in shape.rigid) and all(bends[r] > bent for r in shape.flexible)


def scheduled(
    schedule: Schedule, rig: Rig, hot: float, hold: float, voltages: tuple[float, float], power: float
) -> Candidate:
    """Rows that become hot one after another: each heated last, so that it is flexible as long as possible.

    Rows of one time are heated together; heating of one time begins after that of the time before has ended, and leaves
    the power that holds earlier rows.

    Args:
        schedule: Times by which rows are rigid.
        rig: Scenario of the task.
        hot: Temperature at the end of heating [K].
        hold: Temperature of the hold [K].
        voltages: Lowest and greatest of a row [V].
        power: Greatest of all [W].

    Raises:
        Impossible: There is not enough time, voltage or power for one of the times.
    """
    moments = sorted({t.to("s") for t in schedule.rows.values()})
    deadline = on_grid(moments[-1] + schedule.settle.to("s"), rig)
    pulses: list[Pulse] = []
    free_from = 0.0
    for moment in moments:
        rows = sorted(r for r, t in schedule.rows.items() if t.to("s") == moment)
        own = [rig.rows[r - 1] for r in rows]
        spare = power - sum(holding_power(rig, p.row, hold) for p in pulses)
        end = on_grid(moment, rig, up=False)
        exact = heated_together(own, [hot] * len(rows), voltages[1] * (1 - 1e-9), spare * (1 - 1e-9), end - free_from)
        if exact is None or min(exact) < voltages[0]:
            raise _refusal(rows, own, moment, (free_from, end), hot, voltages, spare)
        volts = [math.floor(1e4 * v) / 1e4 for v in exact]
        begin = on_grid(end - max(r.heating_time(v, hot) for r, v in zip(own, volts)), rig, up=False)
        held = on_grid(end + own[0].coasting_time(hot, hold), rig, up=False)
        pulses += [Pulse(r, v, hot, begin, end, held) for r, v in zip(rows, volts)]
        free_from = end
    ordered = tuple(sorted(pulses, key=lambda p: p.row))
    return Candidate(ordered, hold, min(p.begin for p in pulses), deadline)


def _refusal(
    rows: list[int],
    own: Sequence[Row],
    moment: float,
    times: tuple[float, float],
    hot: float,
    voltages: tuple[float, float],
    spare: float,
) -> Impossible:
    """Why rows cannot be hot by their time, and when they could be."""
    names = f"row{'s' if len(rows) > 1 else ''} {', '.join(map(str, rows))}"
    time = max(times[1] - times[0], 0.0)
    limit = (
        f"the schedule: {names} cannot be rigid by {moment:g} s: there are {time:.3g} s in which no other row is heated"
        f", {max(spare, 0.0):.3g} W and {voltages[1]:.4g} V"
    )
    # As long as it takes: a row comes within 1e-3 of what a voltage settles at in seven time constants.
    longest = 7.0 * own[0].capacity / own[0].conductance
    exact = heated_together(own, [hot] * len(own), voltages[1] * (1 - 1e-9), max(spare, 0.0) * (1 - 1e-9), longest)
    if exact is None:
        volts = max(r.voltage_for(hot, longest) for r in own)
        power = sum(nearest_power(r, hot, longest) for r in own)
        return Impossible(limit, f"in any time it takes more than {volts:.3g} V and {power:.3g} W")
    if min(exact) < voltages[0]:
        return Impossible(
            limit, f"a lowest voltage of {math.floor(100 * min(exact)) / 100:g} V; it is {voltages[0]:g} V"
        )
    soonest = times[0] + max(r.heating_time(v, hot) for r, v in zip(own, exact))
    return Impossible(limit, f"{names} by {math.ceil(100 * soonest) / 100:g} s, or more power or voltage")
