"""What every simulated part looks like to the co-simulation algorithm.

A unit owns named arrays (`cosim.unit.variable`); those of our own units are float64 in SI units. The algorithm sets its
inputs, asks it for one step and reads its outputs. FMUs, the ngspice circuit, the Bullet fabric and the sources all
satisfy this one protocol; circuit and mechanics import nothing of `cosim` but this module.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from cosim.unit.variable import AnyArray, Array, Causality, Coordinate, Variable, VariableType

__all__ = [
    "NANOSECONDS",
    "AnyArray",
    "Array",
    "ArrayStore",
    "Causality",
    "Coordinate",
    "ParallelUnit",
    "StepOutcome",
    "StepStatus",
    "Unit",
    "UnitError",
    "Variable",
    "VariableType",
    "are_equal",
    "is_finite",
    "seconds",
]

#: Simulated time is an integer number of nanoseconds, so that steps never drift and the end is met exactly.
NANOSECONDS = 1_000_000_000


def seconds(time: int) -> float:
    """Simulated time [s] of an integer time [ns]."""
    return time / NANOSECONDS


def are_equal(one: AnyArray, other: AnyArray | float) -> bool:
    """Whether two arrays of one shape hold the same values; one element is compared without numpy's overhead."""
    if one.size != 1 or isinstance(other, float):  # a caller of ours may give a plain number
        return bool((one == other).all())
    return bool(one.item() == other.item())


def is_finite(values: AnyArray) -> bool:
    """Whether every element is a finite number; the same for one element."""
    return math.isfinite(values.item()) if values.size == 1 else bool(np.isfinite(values).all())


def element_text(values: AnyArray) -> str:
    """Index of the first element that is not finite, counted from 1, in brackets; empty for a scalar."""
    if not values.ndim:
        return ""
    return str([int(i) + 1 for i in np.argwhere(~np.isfinite(values))[0]])


class StepStatus(Enum):
    """How a step ended (a failure raises `UnitError` instead)."""

    OK = "ok"
    EARLY_RETURN = "early return"
    DISCARDED = "discarded"


class StepOutcome(NamedTuple):
    """Result of `Unit.do_step` (a named tuple: made at every step, it costs half of a frozen dataclass).

    Args:
        status: How it ended.
        time: Time reached [ns].
        message: Reason where it is not OK.
    """

    status: StepStatus
    time: int
    message: str = ""


class UnitError(Exception):
    """A unit cannot go on: what, where and when.

    Args:
        unit: Name of the unit.
        what: The failure in a sentence, with the element concerned.
        time: Simulated time [ns] where known.
        remedy: What a user can do about it.
    """

    def __init__(self, unit: str, what: str, time: int | None = None, remedy: str = "") -> None:
        self.unit, self.what, self.time, self.remedy = unit, what, time, remedy
        when = "" if time is None else f" at t = {seconds(time):.6g} s"
        super().__init__(f"{unit}{when}: {what}" + (f" ({remedy})" if remedy else ""))


@runtime_checkable
class Unit(Protocol):
    """One simulated part.

    Call order: `set` of start values, `initialise`, any number of (`set`, `refresh`, `get`), `exit_initialisation`,
    then any number of (`set`, `do_step`, `refresh`, `get`), then `terminate`. After `initialise(time)` every output
    holds its value at `time`. `do_step(time, size)` advances to `time + size` with the inputs held constant; its
    outputs are stamped `time + size`.

    A class that names this protocol as its base inherits the defaults below: no direct feedthrough, no way back.
    """

    name: str
    variables: Mapping[str, Variable]
    coordinates: Mapping[str, Coordinate]
    #: Output to the inputs that it depends on at the same instant: after `set`, `refresh` gives its new value. What
    #: a unit computes in `do_step` alone is not listed.
    feedthrough: Mapping[str, frozenset[str]] = {}
    #: The same between `initialise` and `exit_initialisation`.
    initial_feedthrough: Mapping[str, frozenset[str]] = {}
    #: Whether `save` and `restore` work, so that a step can be repeated.
    can_restore: bool = False
    #: Whether `checkpoint` works, so that a run that was interrupted can go on.
    can_checkpoint: bool = True
    #: A sentence for each parameter or start value that lies outside the range which the unit declares for it.
    outside_range: Sequence[str] = ()

    def set(self, name: str, value: AnyArray) -> None:
        """Copy `value` (shape of the variable) to an input. Raises UnitError if it is not finite."""
        ...

    def get(self, name: str) -> AnyArray:
        """Current value of a variable; the array may be overwritten by the next step, so copy it to keep it."""
        ...

    def initialise(self, time: int) -> None:
        """Make all outputs valid at the start time [ns]; an FMU enters Initialization Mode."""
        ...

    def exit_initialisation(self) -> None:
        """All start values have been exchanged; an FMU leaves Initialization Mode."""
        return

    def refresh(self) -> None:
        """Outputs that depend directly on inputs follow what was set since; no time passes."""
        return

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Advance from `time` by `size` [ns]. Raises UnitError if the unit cannot go on."""
        ...

    def save(self) -> Any:
        """State, inputs and outputs, to come back to with `restore`; hand it to `release` when it is not needed.

        Raises:
            UnitError: The unit cannot restore.
        """
        if not self.can_restore:
            raise UnitError(self.name, "it cannot return to a saved state")
        return self.checkpoint()

    def restore(self, saved: Any, time: int) -> None:
        """Return to what `save` gave at `time` [ns]; may be done any number of times."""
        self.resume(saved, time)

    def release(self, saved: Any) -> None:
        """Free what `save` gave."""
        return

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """State from which a fresh unit, after `resume`, continues exactly as this one does from here on.

        A unit whose engine cannot save its state exactly (Bullet) rebuilds itself from the returned arrays here, so
        that the run that goes on and the run that is resumed later are the same to the last bit.
        """
        ...

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Take the place of `initialise` and `exit_initialisation`: continue from a checkpoint made at `time` [ns]."""
        ...

    def terminate(self) -> None:
        """Free what the unit holds; safe to call twice."""
        ...


@runtime_checkable
class ParallelUnit(Protocol):
    """A unit whose step can go on elsewhere (in a process of its own) while others step."""

    def begin_step(self, time: int, size: int) -> None:
        """Begin what `do_step` does; nothing else may be asked of the unit before `finish_step`."""
        ...

    def finish_step(self) -> StepOutcome:
        """Wait for the end of the step; raises UnitError as `do_step` does."""
        ...


@dataclass
class ArrayStore:
    """Preallocated float64 arrays of a unit, for units written in Python."""

    unit: str
    variables: Mapping[str, Variable]
    arrays: dict[str, Array] = field(init=False)

    def __post_init__(self) -> None:
        self.arrays = {
            name: np.full(v.shape, math.nan if v.start is None else v.start) for name, v in self.variables.items()
        }

    def set(self, name: str, value: AnyArray) -> None:
        """Copy a finite value to an input; raises UnitError with the first element that is not finite."""
        array = self.arrays[name]
        array[...] = value
        if not is_finite(array):
            raise UnitError(self.unit, f"input {name}{element_text(array)} is not a finite number")

    def get(self, name: str) -> Array:
        """The live array."""
        return self.arrays[name]
