"""A recording that stands out, of which two inputs are exchanged: the course of one is stated as that of the other.

Where the scenario meets the other recordings and not this one, the numbers of each two of its inputs take each other's
place, as two columns of a table or two programmes do that somebody exchanged. What then explains every channel as well
as the others are explained is what to look at first. Channels that read alike once they are exchanged are asked for
before (`diagnosis.check.swapped`).
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from itertools import combinations

from diagnosis.check.beside import Compared, Course
from diagnosis.check.input_runs import InputRuns, given_as, is_quick, of_one_element
from diagnosis.check.odd_one_out import as_explained, comparable, left, left_beside
from diagnosis.check.unit_of_input import WORSE, explained_with
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Input

#: Inputs beyond which pairs are not tried: each costs a simulation.
MOST = 12


def exchanged_inputs(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about two inputs; None where no single pair explains the recording.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
    """
    channels, courses = comparable(one), of_one_element(one)
    if one.base is None or not channels or not 2 <= len(courses) <= MOST or not is_quick(one.scenario):
        return None
    before, theirs = left_beside(one, others, left)
    enough = as_explained(theirs)
    if before < WORSE * enough:
        return None
    found = []
    with closing(InputRuns(one)) as runs:
        for a, b in combinations(courses, 2):
            if a.is_linear != b.is_linear:
                continue
            rest = runs.left_with(channels, (_with_that_of(a, b), _with_that_of(b, a)))
            if rest <= enough:
                found.append((rest, a, b))
    return _doubt(one, before, *found[0]) if len(found) == 1 else None


def _with_that_of(own: Course, other: Course) -> Input:
    """An input that is given the numbers of another, in its own unit."""
    return given_as(own, other.times, other.values)


def _doubt(one: Compared, before: float, rest: float, a: Course, b: Course) -> Doubt:
    what = f"with the numbers of {a.name} and {b.name} exchanged"
    remedy = (
        f"were the columns of {a.name} and {b.name} exchanged in this recording, or their programmes? Exchange them "
        "under `inputs` or `overrides`"
    )
    return explained_with(one, "exchanged", f"{a.name}, {b.name}", what, (before, rest), remedy)
