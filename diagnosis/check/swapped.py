"""Exchanged channels: does another assignment of channels to what was simulated explain better?

Two exchanged columns of a table, two exchanged sensors and two elements whose drives are exchanged leave the same
readings of one quantity. No data can tell them apart, so a doubt names all of them.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from scipy.optimize import linear_sum_assignment

from cosim.unit.protocol import AnyArray, Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import MOST_LEFT, Basis, Fit, basis, design, fit, gain
from diagnosis.check.timing import critical, percent
from diagnosis.judge.diagnosis import Doubt

#: Share of a gain within which a bound of it is not trusted: it is computed in another order.
SLACK = 1e-6
#: What explains the same readings of one quantity, and the effect of the catalogue that does.
WHICH = (
    "Their columns in the recording are exchanged, or the sensors on the rig (wrong identity), or what drives these "
    "elements: no reading of them tells which"
)
EXCHANGED = "wrong_identity"


def swap_doubts(compared: Compared) -> list[Doubt]:
    """One doubt for each quantity whose channels are explained better in another order.

    Channels that are driven alike have simulated courses of one shape; since offset, gain and lags are free, no
    order of
    them explains more than another, and nothing is said.
    """
    kinds: dict[tuple[str, str], list[Beside]] = defaultdict(list)
    for b in compared.channels.values():
        if b.moves and len(b.pick) >= 24 and not b.is_place:  # of places see `diagnosis.check.places`
            kinds[_kind(b)].append(b)
    found = []
    for members in kinds.values():
        if len(members) > 1:
            found += _swaps(compared, members)
    return found


def _kind(beside: Beside) -> tuple[str, str]:
    """Channels of one kind may be exchanged: the same quantity of elements, outputs of components in one unit."""
    target = beside.channel.target
    return ("component", target.si_unit) if target.is_component else (target.kind, target.quantity)


def _swaps(compared: Compared, members: list[Beside]) -> list[Doubt]:
    count = len(members)
    level = critical(float(count * (count - 1)))
    own_fits = [basis(b).fit(b.measured, b.tolerance) for b in members]
    as_simulated = np.array([[_is_nearer(b, course) for course in members] for b in members])
    if not _may_cycle((_most(members, own_fits) > level * (1.0 - SLACK)) | as_simulated):
        return []
    fits: list[list[Fit]] = [[_one(b, course) for course in members] for b in members]
    # relative to what each channel's own simulation explains
    gains = np.array([[gain(row[i], other) for other in row] for i, row in enumerate(fits)])
    # a lag makes the fast of two channels the slow one: what reads as the other is simulated is no loss then
    rows, columns = linear_sum_assignment(np.where(as_simulated, np.maximum(gains, 0.0), gains), maximize=True)
    found = []
    for cycle in cycles(rows, columns):
        # every channel of an exchange must gain: one that is wrong by itself has another fault
        own = [float(gains[i, columns[i]]) for i in cycle]
        if max(own) <= level or not all(g > level or as_simulated[i, columns[i]] for g, i in zip(own, cycle)):
            continue
        names = [members[i].channel.name for i in cycle]
        takes = ", ".join(f"`{members[i].channel.name}` reads like `{members[columns[i]].channel.name}`" for i in cycle)
        gaining = [i for i in cycle if gains[i, columns[i]] > level]
        worst = min(gaining, key=lambda i: gains[i, columns[i]])
        text = (
            f"{takes}: so exchanged, the simulation explains at least "
            f"{percent(fits[worst][columns[worst]].share)} of the variance of "
            f"{'each' if len(gaining) == len(cycle) else members[worst].channel.name}, in place of "
            f"{percent(fits[worst][worst].share)}. {WHICH}"
        )
        remedy = (
            "look which of them are exchanged; `column` of these channels puts columns and sensors right, the scenario "
            "what drives them"
        )
        found.append(
            Doubt(
                compared.recording.title,
                ", ".join(names),
                "swapped",
                text,
                remedy,
                True,
                compared.begin,
                compared.end,
                float(np.sqrt(max(min(own), level))),
                same_as=(EXCHANGED,) if len(cycle) == 2 else (),
            )
        )
    return found


def _most(members: list[Beside], own: list[Fit]) -> Array:
    """Bound of what each channel (row) gains by the simulation of each other (column), shape (members, members).

    Weights of any sign leave no more than weights that are not negative, and no more samples are independent than
    those of the channel's own residual. All channels that are read together need one product for each simulation.
    """
    found = np.zeros((len(members), len(members)))
    together: dict[bytes, list[int]] = {}
    for i, b in enumerate(members):
        together.setdefault(b.times.tobytes(), []).append(i)
    floor = np.finfo(float).tiny
    for j, course in enumerate(members):
        for rows in together.values():
            first = members[rows[0]]
            is_own = np.array_equal(first.times, course.times)
            base = basis(course) if is_own else Basis(design(course, first.times))
            least = base.least(np.stack([members[i].measured for i in rows], axis=1))
            for i, left in zip(rows, least.tolist()):
                squares = left + len(own[i].residual) * own[i].floor
                found[i, j] = own[i].independent * np.log(max(own[i].squares, floor) / max(squares, floor))
    np.fill_diagonal(found, 0.0)
    return found


def _may_cycle(is_better: AnyArray) -> bool:
    """Whether channels that gain by another's simulation, shape (members, members), can form a cycle."""
    left = is_better.copy()
    while True:
        lost = left.any(axis=1) & ~left.any(axis=0) | left.any(axis=0) & ~left.any(axis=1)
        if not lost.any():
            return bool(left.any())
        left[lost], left[:, lost] = False, False


def _is_nearer(beside: Beside, course: Beside) -> bool:
    """Whether a channel reads as another one is simulated, rather than as it is: a quarter of the squares at most.

    As simulated, without an offset, a gain and a lag: by these a slow channel explains the readings of a fast one.
    """
    left = [float(np.mean((beside.measured - b.at(beside.times)) ** 2)) + beside.tolerance**2 for b in (beside, course)]
    return left[1] < MOST_LEFT**2 * left[0]


def _one(beside: Beside, course: Beside) -> Fit:
    return fit(beside.measured, design(course, beside.times), beside.tolerance)


def cycles(rows: np.ndarray, columns: np.ndarray) -> list[list[int]]:
    """Cycles of a permutation that move something."""
    left, found = set(rows.tolist()), []
    while left:
        begin = min(left)
        cycle, i = [], begin
        while i in left:
            left.discard(i)
            cycle.append(i)
            i = int(columns[i])
        if len(cycle) > 1:
            found.append(cycle)
    return found
