"""Iterated: every loop of units repeats its step until the values exchanged inside it agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from cosim.algorithms.algorithm import Algorithm
from cosim.algorithms.restoring import require_restoring
from cosim.connection import Transfer
from cosim.ordering import in_order
from cosim.system import System
from cosim.unit.protocol import AnyArray, StepOutcome, StepStatus, UnitError, seconds

#: (unit, input) to its value.
Values: TypeAlias = Mapping[tuple[str, str], AnyArray]


@dataclass(frozen=True)
class Group:
    """Units that step together.

    Args:
        names: The units, in stepping order.
        is_loop: Whether they depend on each other, or the one on itself.
    """

    names: tuple[str, ...]
    is_loop: bool


def groups(system: System) -> list[Group]:
    """Loops of units and single units, each after those that it depends on; sources are left out."""
    movers = system.movers
    index = {name: i for i, name in enumerate(movers)}
    edges = sorted(
        {
            (index[p.connection.source[0]], index[name])
            for name in movers
            for t in system.transfers[name]
            for p in t.parts
            if p.connection.source[0] in index
        }
    )
    result = []
    for members in in_order(len(movers), edges):
        names = tuple(movers[i] for i in members)
        result.append(Group(names, len(names) > 1 or (members[0], members[0]) in edges))
    return result


class Iterated(Algorithm):
    """Fixed-point iteration over each loop of units, with restored states.

    The inputs of a step are held constant. With `mean` they are the mean of their values at its begin and, as found by
    the iteration, at its end (second order in the step size); with `end` they are those at the end (first order,
    damped). What does not belong to a loop steps once, after what it depends on, and need not be able to restore.

    Args:
        system: The system.
        relative_tolerance: Largest change of an exchanged value from one repetition to the next, relative to
            1 + its size.
        iterations: Most repetitions of one step.
        is_mean: Mean of begin and end, or end.

    Raises:
        CannotRestore: A unit inside a loop cannot return to a saved state.

    Source: Kuebler and Schiehlen, Math. Comput. Model. Dyn. Syst. 6 (2000) 93-113 (iterative coupling); the mean is the
    trapezoidal rule for the coupling variables.
    """

    def __init__(self, system: System, relative_tolerance: float, iterations: int, is_mean: bool) -> None:
        self.groups = groups(system)
        self._tolerance, self._iterations, self._is_mean = relative_tolerance, iterations, is_mean
        inside = [name for group in self.groups if group.is_loop for name in group.names]
        require_restoring(system, inside, "iterated")
        self._repetitions = 0

    def counts(self) -> dict[str, int]:
        """Steps of loops, repetitions included."""
        return {"loop_steps": self._repetitions}

    def __call__(self, system: System, time: int, size: int) -> StepOutcome:
        """Advance all units by one macro-step.

        Returns:
            OK at `time + size`, or the first outcome that is not OK.

        Raises:
            UnitError: The iteration does not converge, or a unit fails.
        """
        system.sample_sources(time, size)
        system.propagate()
        begin = {}
        for name in system.movers:
            for transfer in system.transfers[name]:
                for part in transfer.parts:
                    part.copy()
                begin[transfer.end] = transfer.buffer.copy()
        for group in self.groups:
            step = self._loop if group.is_loop else self._once
            outcome = step(system, group, begin, (time, size))
            if outcome.status is not StepStatus.OK:
                return outcome
        return StepOutcome(StepStatus.OK, time + size)

    def _once(self, system: System, group: Group, begin: Values, when: tuple[int, int]) -> StepOutcome:
        name = group.names[0]
        end = {}
        for transfer in system.transfers[name]:
            for part in transfer.parts:
                part.copy()
            end[transfer.end] = transfer.buffer.copy()
        return self._step(system, name, (begin, end), when)

    def _step(self, system: System, name: str, values: tuple[Values, Values], when: tuple[int, int]) -> StepOutcome:
        """Step a unit with its inputs over the step; afterwards its outputs are those of the inputs at the end.

        The inputs are left as they were over the step, which is what an energy meter must see.
        """
        self._apply(system.transfers[name], *values)
        outcome = system.step(name, *when)
        unit = system.units[name]
        if self._is_mean and unit.feedthrough and outcome.status is StepStatus.OK:
            continuous = [t for t in system.transfers[name] if not t.is_clock]  # a tick is handed over once
            for transfer in continuous:
                transfer.buffer[...] = values[1][transfer.end]
                transfer.write()
            unit.refresh()
            self._apply(continuous, *values)
        return outcome

    def _apply(self, transfers: Sequence[Transfer], begin: Values, end: Values) -> None:
        """Set inputs for the step from their values at begin and end."""
        for transfer in transfers:
            first, last = begin[transfer.end], end[transfer.end]
            is_mean = self._is_mean and transfer.variable.type.is_float
            transfer.buffer[...] = 0.5 * (first + last) if is_mean else last
            transfer.write()

    def _loop(self, system: System, group: Group, begin: Values, when: tuple[int, int]) -> StepOutcome:
        inputs = [t for name in group.names for t in system.transfers[name]]
        for transfer in inputs:  # what comes from groups before this one is known at the end of the step
            for part in transfer.parts:
                part.copy()
        end = {t.end: t.buffer.copy() for t in inputs}
        change, where = np.inf, inputs[0]
        saved = {name: system.units[name].save() for name in group.names}
        try:
            for repetition in range(self._iterations):
                if repetition:
                    system.restore(saved, when[0])
                self._repetitions += 1
                outcome, change, where = self._repeat(system, group, (begin, end), when)
                if outcome.status is not StepStatus.OK or change <= self._tolerance:
                    return outcome
        finally:
            system.release(saved)
        raise UnitError(
            "iterated",
            f"the loop {', '.join(group.names)} does not converge in {self._iterations} repetitions of the "
            f"step of {seconds(when[1]):g} s: {'.'.join(where.end)} still changes by {change:.3g} (relative)",
            when[0],
            "use a smaller macro_step, `inputs: end`, or more iterations",
        )

    def _repeat(
        self, system: System, group: Group, values: tuple[Values, Values], when: tuple[int, int]
    ) -> tuple[StepOutcome, float, Transfer]:
        """Step every unit of a loop once; returns the largest change of an input at the end, and which it was."""
        end = values[1]
        inputs = [t for name in group.names for t in system.transfers[name]]
        change, where = 0.0, inputs[0]
        for name in group.names:
            outcome = self._step(system, name, values, when)
            if outcome.status is not StepStatus.OK:
                break
            for transfer in inputs:
                difference = _follow(transfer, name, end[transfer.end])
                if difference > change:
                    change, where = difference, transfer
        return outcome, change, where


def _follow(transfer: Transfer, source: str, end: AnyArray) -> float:
    """Let the end value of an input follow a unit that has just stepped; returns its largest relative change."""
    if all(p.connection.source[0] != source for p in transfer.parts):
        return 0.0
    transfer.buffer[...] = end
    for part in transfer.parts:
        if part.connection.source[0] == source:
            part.copy()
    if transfer.variable.type.is_float:
        change = np.abs(transfer.buffer - end) / (1.0 + np.abs(transfer.buffer))
        difference = float(np.max(change)) if change.size else 0.0
        difference = difference if np.isfinite(difference) else np.inf
    else:
        difference = float(not np.array_equal(transfer.buffer, end))
    end[...] = transfer.buffer
    return difference
