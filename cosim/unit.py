"""What every simulated part looks like to the co-simulation algorithm.

A unit owns arrays of float64 in SI units. The algorithm sets its inputs, asks it for one step and reads its
outputs. FMUs, the ngspice circuit, the Bullet fabric and the sources all satisfy this one protocol; circuit and
mechanics import nothing of `cosim` but this module.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]

#: Simulated time is an integer number of nanoseconds, so that steps never drift and the end is met exactly.
NANOSECONDS = 1_000_000_000


def seconds(time: int) -> float:
    """Simulated time [s] of an integer time [ns]."""
    return time / NANOSECONDS


class Causality(Enum):
    """Role of a variable, with the names of FMI."""

    INPUT = "input"
    OUTPUT = "output"
    PARAMETER = "parameter"


@dataclass(frozen=True)
class Variable:
    """One named array of a unit.

    Args:
        name: Name within the unit, for example `power`.
        causality: Whether the algorithm writes it (input) or reads it (output).
        shape: Shape of the array; `()` is a scalar.
        unit: SI unit as text that pint parses (`W`, `K`, `N/m`, `1/m`, `1`).
        dims: Name of each dimension, for example `("coil",)`; same length as `shape`.
        description: One sentence for results and error texts.
        start: Value of an input that nothing is connected to; a scalar fills the shape. None: must be connected.
        recorded: Whether a trace keeps it.
    """

    name: str
    causality: Causality
    shape: tuple[int, ...]
    unit: str
    dims: tuple[str, ...] = ()
    description: str = ""
    start: float | None = None
    recorded: bool = True

    def __post_init__(self) -> None:
        if len(self.dims) != len(self.shape):
            raise ValueError(f"{self.name}: {len(self.dims)} dimension names for shape {self.shape}")

    @property
    def size(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)


@dataclass(frozen=True)
class Coordinate:
    """A labelled axis of results, for example the row of every link.

    Args:
        dim: Dimension that it runs along.
        values: Shape (size of dim,); numbers or text.
        description: One sentence for the result file.
    """

    dim: str
    values: npt.NDArray[np.generic]
    description: str = ""


class StepStatus(Enum):
    """How a step ended (a failure raises `UnitError` instead)."""

    OK = "ok"
    EARLY_RETURN = "early return"
    DISCARDED = "discarded"


@dataclass(frozen=True)
class StepOutcome:
    """Result of `Unit.do_step`.

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

    Call order: `set` of start values, `initialise`, then any number of (`set`, `do_step`, `get`), then `terminate`.
    After `initialise(time)` every output holds its value at `time`. `do_step(time, size)` advances to
    `time + size` with the inputs held constant; its outputs are stamped `time + size`.
    """

    name: str
    variables: Mapping[str, Variable]
    coordinates: Mapping[str, Coordinate]

    def set(self, name: str, value: Array) -> None:
        """Copy `value` (shape of the variable, SI) to an input. Raises UnitError if it is not finite."""
        ...

    def get(self, name: str) -> Array:
        """Current value of a variable; the array may be overwritten by the next step, so copy it to keep it."""
        ...

    def initialise(self, time: int) -> None:
        """Make all outputs valid at the start time [ns]."""
        ...

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Advance from `time` by `size` [ns]. Raises UnitError if the unit cannot go on."""
        ...

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """State from which a fresh unit, after `resume`, continues exactly as this one does from here on.

        A unit whose engine cannot save its state exactly (Bullet) rebuilds itself from the returned arrays here, so
        that the run that goes on and the run that is resumed later are the same to the last bit.
        """
        ...

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Take the place of `initialise`: continue from a checkpoint made at `time` [ns]."""
        ...

    def terminate(self) -> None:
        """Free what the unit holds; safe to call twice."""
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

    def set(self, name: str, value: Array) -> None:
        """Copy a finite value to an input; raises UnitError with the first element that is not finite."""
        array = self.arrays[name]
        array[...] = value
        if not np.isfinite(array).all():
            where = [int(i) for i in np.argwhere(~np.isfinite(array))[0]] if array.ndim else []
            raise UnitError(self.unit, f"input {name}{where or ''} is not a finite number")

    def get(self, name: str) -> Array:
        """The live array."""
        return self.arrays[name]
