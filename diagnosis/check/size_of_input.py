"""A recording that stands out, one of whose inputs acted by another size than is stated.

A course that is stated under `overrides` has no column whose unit could be read otherwise, and a pump that is worn has
no unit. Where the scenario meets the other recordings and not this one, the course of each input is taken so many
times as large in it, or with the opposite sign. What then explains every channel as well as the others are explained is
what to look at first; where the factor is that to another unit of the quantity, the unit is said.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass

import numpy as np

from cosim.unit.quantity import conversion
from diagnosis.check.beside import Beside, Compared, Course
from diagnosis.check.factors import best_logarithm
from diagnosis.check.input_runs import InputRuns, given_as, is_quick, of_one_element
from diagnosis.check.odd_one_out import as_explained, comparable, is_within, left, left_beside
from diagnosis.check.unit_of_input import WORSE, explained_with
from diagnosis.check.unit_of_one import NEAR, other_units
from diagnosis.judge.diagnosis import Doubt

#: Factors that are tried first; between the neighbours of the best one the size is found.
FACTORS = (0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.7, 2.5, 5.0, 10.0)
#: ln(factor) from which an input is another.
LEAST = 0.05


@dataclass(frozen=True)
class _Sized:
    """An input, how many times as large it acted, and the largest share of a channel's variance that is left then."""

    course: Course
    factor: float
    left: float

    @property
    def units(self) -> list[str]:
        """Units to which that is the factor."""
        return [
            unit
            for unit in other_units(self.course.unit)
            if abs(math.log(self.factor / conversion(unit, self.course.unit)[0])) < NEAR
            and conversion(unit, self.course.unit)[1] == 0.0
        ]


def size_of_input(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about the size of one input; None where none, or several, explain the recording.

    It is serious where a unit explains it, or where the recording moves within what the others move within: a law that
    acts at large values may act in one recording alone.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
    """
    channels = comparable(one)
    if one.base is None or not channels or not is_quick(one.scenario):
        return None
    before, theirs = left_beside(one, others, left)
    enough = as_explained(theirs)
    if before < WORSE * enough:
        return None
    moving = [c for c in of_one_element(one) if np.ptp(c.values) > 0.0]
    with closing(InputRuns(one)) as runs:
        every = [s for course in moving for s in (_sized(runs, channels, course), _turned(runs, channels, course))]
    found = [s for s in every if s.left <= enough and (s.factor < 0.0 or abs(math.log(s.factor)) > LEAST)]
    return _doubt(one, found[0], before, is_within(one, others)) if len(found) == 1 else None


def _sized(runs: InputRuns, channels: dict[str, Beside], course: Course) -> _Sized:
    """How many times as large an input explains most of the channel that it explains least."""

    def cost(logarithm: float) -> float:
        return _left(runs, channels, course, math.exp(logarithm))

    logarithm, least = best_logarithm(cost, [math.log(f) for f in FACTORS])
    return _Sized(course, math.exp(logarithm), least)


def _turned(runs: InputRuns, channels: dict[str, Beside], course: Course) -> _Sized:
    """The input with the opposite sign; nothing of an input that has one sign throughout, which its unit gives it."""
    is_of_both = np.min(course.values) < 0.0 < np.max(course.values)
    return _Sized(course, -1.0, _left(runs, channels, course, -1.0) if is_of_both else math.inf)


def _left(runs: InputRuns, channels: dict[str, Beside], course: Course, factor: float) -> float:
    """Share of the variance that is left of the channel that an input explains least, so many times as large."""
    return runs.left_with(channels, (given_as(course, course.times, factor * course.values),))


def _doubt(one: Compared, found: _Sized, before: float, is_within_others: bool) -> Doubt:
    name = found.course.name
    place = f"`inputs.{name}`" if found.course.is_recorded else f"the course of {name} under `overrides`"
    if found.factor < 0.0:
        remedy = f"was it connected the other way round, or is its sign another convention? Correct {place}"
        what = f"with the opposite sign of what is stated of {name}"
        return explained_with(one, "sign", name, what, (before, found.left), remedy)
    units = found.units
    as_if = f", as if it were in {' or '.join(units)} and not in {found.course.unit}," if units else ""
    what = f"with {found.factor:.3g} times what is stated of {name}{as_if}"
    remedy = f"in what was it written, or did it act by another size? Correct {place} of this recording"
    kind, is_serious = ("unit", True) if units else ("number", is_within_others)
    return explained_with(one, kind, name, what, (before, found.left), remedy, is_serious)
