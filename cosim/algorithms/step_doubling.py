"""Step doubling: the error of every step is estimated by making it again in halves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from cosim.algorithms.algorithm import Algorithm
from cosim.algorithms.restoring import require_restoring
from cosim.system import System
from cosim.unit.protocol import Array, Causality, StepOutcome, StepStatus, UnitError, seconds

#: The next step is this share of the one that would just meet the tolerance.
SAFETY = 0.9
#: A step changes by no more than these factors at once.
SHRINK, GROW = 0.2, 4.0


@dataclass(frozen=True)
class ErrorControl:
    """What a step must meet.

    Args:
        relative: Share of each value.
        absolute: In the unit of each value.
        minimum_step: Shortest step [ns].
    """

    relative: float
    absolute: float
    minimum_step: int


class StepDoubling(Algorithm):
    """Richardson error control around a first-order algorithm.

    A step of h is made whole and, after every unit was taken back, in two halves. The difference estimates the error
    of the halves, which are kept if it meets the tolerance; else h is reduced. Macro-steps stay communication points
    of the run: h grows up to them and starts each where the last ended.

    Args:
        system: The system.
        inner: The algorithm that makes each step.
        control: Tolerances.
        size: Macro-step [ns]; the first step that is tried.

    Raises:
        CannotRestore: A unit cannot return to a saved state.

    Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, section II.4 (step doubling); for
    co-simulation Schierz, Arnold, Clauss, 9th Modelica Conference (2012) 205-214.
    """

    divides_steps = True

    def __init__(
        self, system: System, inner: Callable[[System, int, int], StepOutcome], control: ErrorControl, size: int
    ) -> None:
        require_restoring(system, system.movers, "step_doubling", is_divided=True)
        self._inner, self._control, self._size = inner, control, size
        self._watched = [
            (name, v.name)
            for name in system.movers
            for v in system.units[name].variables.values()
            if v.causality is Causality.OUTPUT and v.type.is_float
        ]
        self.accepted = self.rejected = 0

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """The step that it will try next [ns], and its counts."""
        return {"memory": np.array([self._size, self.accepted, self.rejected])}

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]]) -> None:
        """Go on with that step."""
        self._size, self.accepted, self.rejected = (int(number) for number in state["memory"])

    def counts(self) -> dict[str, int]:
        """Steps accepted and rejected."""
        return {"accepted_steps": self.accepted, "rejected_steps": self.rejected}

    def __call__(self, system: System, time: int, size: int) -> StepOutcome:
        """Advance all units by one macro-step, in as many steps as the tolerance asks for.

        Raises:
            UnitError: The tolerance is not met even by the shortest step, or a unit fails.
        """
        now, end = time, time + size
        while now < end:
            now += self._advance(system, now, end - now)
        return StepOutcome(StepStatus.OK, end)

    def _advance(self, system: System, time: int, rest: int) -> int:
        """Make one accepted step of at most `rest` [ns]; returns its length [ns]."""
        while True:
            size = min(self._size, rest)
            saved = system.save()
            try:
                error = self._error(system, saved, time, size)
                if error > 1.0:
                    system.restore(saved, time)
            finally:
                system.release(saved)
            # The difference of whole and halved step is of second order in the step.
            factor = GROW if error == 0.0 else min(GROW, max(SHRINK, SAFETY * error**-0.5))
            if error <= 1.0:
                self.accepted += 1
                if size == self._size or factor < 1.0:  # a step cut short by the macro-step says nothing about growth
                    self._size = max(round(size * factor), self._control.minimum_step)
                return size
            self.rejected += 1
            if size <= self._control.minimum_step:
                raise UnitError(
                    "step_doubling",
                    f"the error of a step of {seconds(size):g} s is {error:.3g} times the "
                    "tolerance, and minimum_step allows none shorter",
                    time,
                    "loosen the tolerances or allow a smaller minimum_step",
                )
            self._size = max(round(size * min(factor, 0.5)), self._control.minimum_step)

    def _error(self, system: System, saved: dict[str, object], time: int, size: int) -> float:
        """Largest error of a step relative to the tolerance; the halves remain. Infinite if a unit discards it."""
        if self._inner(system, time, size).status is not StepStatus.OK:
            return np.inf
        whole = self._outputs(system)
        system.restore(saved, time)
        first = size // 2
        for begin, part in ((time, first), (time + first, size - first)):
            if part and self._inner(system, begin, part).status is not StepStatus.OK:
                return np.inf
        error = 0.0
        for one, other in zip(whole, self._outputs(system)):
            if one.size:
                allowed = self._control.absolute + self._control.relative * np.abs(other)
                error = max(error, float(np.max(np.abs(one - other) / allowed)))
        return error

    def _outputs(self, system: System) -> list[Array]:
        system.propagate()  # else outputs with direct feedthrough would still show the inputs of the begin
        return [np.asarray(system.value(*end), dtype=np.float64) for end in self._watched]
