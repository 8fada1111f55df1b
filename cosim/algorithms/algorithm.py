"""What every co-simulation algorithm looks like to the run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np
import numpy.typing as npt

from cosim.system import System
from cosim.unit.protocol import StepOutcome


class Algorithm(Protocol):
    """Makes macro-steps. One that names this protocol as its base inherits the defaults: no memory, nothing to tell."""

    #: Whether inputs change inside a macro-step; then energies cannot be added up from one value per step.
    divides_steps: bool = False

    def __call__(self, system: System, time: int, size: int) -> StepOutcome:
        """Advance all units from `time` by `size` [ns]."""
        ...

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """What it remembers from one step to the next."""
        return {}

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]]) -> None:
        """Go on with what `checkpoint` gave."""
        return

    def counts(self) -> dict[str, int]:
        """What it did so far, for the summary of the run."""
        return {}


class Plain(Algorithm):
    """An algorithm without memory.

    Args:
        step: `step(system, time, size)`.
    """

    def __init__(self, step: Callable[[System, int, int], StepOutcome]) -> None:
        self.step = step

    def __call__(self, system: System, time: int, size: int) -> StepOutcome:
        """One macro-step."""
        return self.step(system, time, size)
