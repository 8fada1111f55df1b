"""Synchronised: where a unit returns early, all units go back and step to that instant."""

from __future__ import annotations

from collections.abc import Callable

from cosim.algorithms.algorithm import Algorithm
from cosim.algorithms.restoring import require_restoring
from cosim.system import System
from cosim.unit.protocol import StepOutcome, StepStatus, UnitError


class Synchronised(Algorithm):
    """Makes an event of one unit a communication point of all.

    Args:
        system: The system.
        inner: The algorithm that makes each step.

    Raises:
        CannotRestore: A unit cannot return to a saved state.
    """

    divides_steps = True

    def __init__(self, system: System, inner: Callable[[System, int, int], StepOutcome]) -> None:
        require_restoring(system, system.movers, "on_event: synchronise", is_divided=True)
        self._inner = inner
        self._events = 0

    def counts(self) -> dict[str, int]:
        """Events that became communication points."""
        return {"events": self._events}

    def __call__(self, system: System, time: int, size: int) -> StepOutcome:
        """Advance all units by one macro-step, with a communication point at every event inside it.

        Returns:
            OK at `time + size`, or an outcome that is neither OK nor an early return.

        Raises:
            UnitError: A unit returns early without having moved.
        """
        now, end = time, time + size
        while now < end:
            saved = system.save()
            try:
                outcome = self._inner(system, now, end - now)
                if outcome.status is not StepStatus.EARLY_RETURN:
                    return outcome
                if not now < outcome.time < end:
                    raise UnitError(
                        "synchronise",
                        f"{outcome.message or 'a unit returned early'} without having moved",
                        now,
                        "use `on_event: continue`",
                    )
                system.restore(saved, now)
            finally:
                system.release(saved)
            repeated = self._inner(system, now, outcome.time - now)
            if repeated.status is not StepStatus.OK:
                return repeated
            self._events += 1
            now = outcome.time
        return StepOutcome(StepStatus.OK, end)
