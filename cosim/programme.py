"""Quantities given over time: supply voltage, room and bath temperature."""

from __future__ import annotations

import bisect
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cosim.unit.protocol import (
    Array,
    ArrayStore,
    Causality,
    Coordinate,
    StepOutcome,
    StepStatus,
    Unit,
    Variable,
    seconds,
)


@dataclass(frozen=True)
class Course:
    """Course of one output over time.

    Args:
        times: Integer times [ns], rising, shape (points,).
        values: Values in `unit`, shape (points,) or (points, n).
        unit: Unit.
        dim: Name of the second dimension, or None.
        is_linear: Interpolated between the points; otherwise held from each point to the next.
    """

    times: tuple[int, ...]
    values: Array
    unit: str
    dim: str | None
    is_linear: bool

    def at(self, time: float) -> Array | float:
        """Value at a time [ns], shape (n,) or a number; before the first and after the last point their values hold."""
        point = max(bisect.bisect_right(self.times, time) - 1, 0)
        begin = self.times[point]
        left: Array | float = self._rows[point]
        if not self.is_linear or point + 1 == len(self.times) or time <= begin:
            return left
        # The formula of numpy.interp, in its order of operations, as in native/course.c.
        slope: Array | float = (self._rows[point + 1] - left) / float(self.times[point + 1] - begin)
        return slope * (time - begin) + left

    @cached_property
    def _rows(self) -> list[Any]:
        """Value of every point: floats (numpy's own scalars cost several times as much), or arrays."""
        return self.values.tolist() if self.values.ndim == 1 else list(self.values)


class ProgrammeUnit(Unit):
    """A source: its outputs are functions of time alone.

    Over a step its output is the value held from the begin of the step (a jump lies on the macro-step grid, which the
    scenario check makes sure of) or, where it is linear, the value at the middle of the step, so that the integral of
    a ramp over the step is exact.

    Args:
        name: Name of the component.
        courses: Output name to its course.
    """

    can_restore = True

    def __init__(self, name: str, courses: Mapping[str, Course]) -> None:
        self.name = name
        self.courses = dict(courses)
        self.coordinates: Mapping[str, Coordinate] = {}
        self.variables: Mapping[str, Variable] = {
            output: Variable(output, Causality.OUTPUT, c.values.shape[1:], c.unit, (c.dim,) if c.dim else ())
            for output, c in self.courses.items()
        }
        self._store = ArrayStore(name, self.variables)

    def set(self, name: str, value: Array) -> None:
        """It has no inputs."""
        raise KeyError(name)

    def get(self, name: str) -> Array:
        """Value over the last step."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """Values at the start time."""
        for name, course in self.courses.items():
            self._store.arrays[name][...] = course.at(time)

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Values held over [time, time + size)."""
        for name, course in self.courses.items():
            if len(course.times) > 1:
                self._store.arrays[name][...] = course.at(time + 0.5 * size if course.is_linear else time)
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict[str, np.ndarray[Any, Any]]:
        """The values held now."""
        return {name: array.copy() for name, array in self._store.arrays.items()}

    def resume(self, state: Mapping[str, np.ndarray[Any, Any]], time: int) -> None:
        """Hold the values of the checkpoint."""
        for name in self.courses:
            self._store.arrays[name][...] = state[name]

    def terminate(self) -> None:
        """Nothing is held."""

    def __repr__(self) -> str:
        ends = {n: (seconds(c.times[0]), seconds(c.times[-1])) for n, c in self.courses.items()}
        return f"ProgrammeUnit({self.name}, {ends})"
