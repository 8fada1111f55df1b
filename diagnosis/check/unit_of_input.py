"""A recording that stands out, one of whose recorded inputs is in another unit than it states.

Where the scenario meets the other recordings and not this one, the numbers of each of its columns of inputs are read in
every other unit of their quantity. What then explains every channel as well as the others are explained is what to
look at first.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import replace

import numpy as np

from cosim.unit.quantity import conversion
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.input_runs import InputRuns, is_quick
from diagnosis.check.odd_one_out import as_explained, comparable, left, left_beside
from diagnosis.check.timing import percent
from diagnosis.check.unit_of_one import other_units
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Input

#: How many times more the unit that is stated leaves.
WORSE = 4.0
#: Units beyond which they say nothing.
MOST = 2


def unit_of_input(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about the unit of one recorded input; None where no unit of a single input explains the recording.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
    """
    channels = comparable(one)
    if one.base is None or not one.recording.inputs or not channels or not is_quick(one.scenario):
        return None
    before, theirs = left_beside(one, others, left)
    enough = as_explained(theirs)
    if before < WORSE * enough:
        return None
    with closing(InputRuns(one)) as runs:
        found = [(i, u, rest) for i in one.recording.inputs for u, rest in _each(runs, channels, i) if rest <= enough]
    if not 0 < len(found) <= MOST or len({(i.component, i.output) for i, _, _ in found}) > 1:
        return None
    return _doubt(one, found[0][0], [u for _, u, _ in found], before, max(rest for *_, rest in found))


def _each(runs: InputRuns, channels: dict[str, Beside], given: Input) -> Iterator[tuple[str, float]]:
    """Every other unit of an input, with the largest share of a channel's variance that is left with it."""
    for unit in other_units(given.unit):
        factor, offset = conversion(unit, given.unit)
        yield unit, runs.left_with(channels, (replace(given, values=factor * given.values + offset),))


def _doubt(one: Compared, given: Input, units: Sequence[str], before: float, rest: float) -> Doubt:
    name = f"{given.component}.{given.output}"
    what = f"with its column of {name} in {' or '.join(units)} and not in {given.unit}"
    remedy = (
        f"in what was this column logged? Correct `inputs.{name}.unit` of this recording, or state under `overrides` "
        "what was another in it"
    )
    return explained_with(one, "unit", name, what, (before, rest), remedy)


def explained_with(
    one: Compared, kind: str, name: str, what: str, left_of: tuple[float, float], remedy: str, is_serious: bool = True
) -> Doubt:
    """The doubt about an input with which, taken otherwise, a recording is explained as the others are.

    Args:
        one: The recording.
        kind: Of the doubt.
        name: Of the input.
        what: How it is taken.
        left_of: Largest share of a channel's variance that is left as it is stated, and then.
        remedy: What to look at.
        is_serious: Whether nothing is searched.
    """
    before, rest = left_of
    text = (
        f"the scenario explains as little as {percent(max(1.0 - before, 0.0))} of the variance of a channel of this "
        f"recording; {what} at least {percent(1.0 - rest)} of each channel's, about as much as in the other recordings"
    )
    z = float(np.sqrt(before / max(rest, 1e-12)))
    return Doubt(one.recording.title, name, kind, text, remedy, is_serious, one.begin, one.end, z)
