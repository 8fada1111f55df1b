"""Exchanged columns, coils or strings: does another assignment of channels to what was simulated explain better?"""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from scipy.optimize import linear_sum_assignment

from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import Fit, design, fit, gain
from diagnosis.check.timing import critical, percent
from diagnosis.judge.diagnosis import Doubt


def swap_doubts(compared: Compared) -> list[Doubt]:
    """One doubt for each quantity whose channels are explained better in another order.

    Channels that are driven alike have simulated courses of one shape; since offset, gain and lags are free, no
    order of
    them explains more than another, and nothing is said.
    """
    kinds: dict[tuple[str, str], list[Beside]] = defaultdict(list)
    for b in compared.channels.values():
        if b.moves and len(b.pick) >= 24:
            kinds[b.channel.target.kind, b.channel.target.quantity].append(b)
    found = []
    for members in kinds.values():
        if len(members) > 1:
            found += _swaps(compared, members)
    return found


def _swaps(compared: Compared, members: list[Beside]) -> list[Doubt]:
    count = len(members)
    fits: list[list[Fit]] = [[_one(b, course) for course in members] for b in members]
    # relative to what each channel's own simulation explains
    gains = np.array([[gain(row[i], other) for other in row] for i, row in enumerate(fits)])
    rows, columns = linear_sum_assignment(gains, maximize=True)
    level = critical(float(count * (count - 1)))
    found = []
    for cycle in _cycles(rows, columns):
        # every channel of an exchange must gain: one that is wrong by itself has another fault
        own = [float(gains[i, columns[i]]) for i in cycle]
        if min(own) <= level:
            continue
        names = [members[i].channel.name for i in cycle]
        takes = ", ".join(f"`{members[i].channel.name}` reads like `{members[columns[i]].channel.name}`" for i in cycle)
        worst = min(cycle, key=lambda i: gains[i, columns[i]])
        text = (
            f"{takes}: so exchanged, the simulation explains at least "
            f"{percent(fits[worst][columns[worst]].share)} of "
            f"each, in place of {percent(fits[worst][worst].share)}"
        )
        remedy = "are the columns, or the wires, exchanged? Correct `column` of these channels"
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
                float(np.sqrt(min(own))),
            )
        )
    return found


def _one(beside: Beside, course: Beside) -> Fit:
    return fit(beside.measured, design(course, beside.times), beside.tolerance)


def _cycles(rows: np.ndarray, columns: np.ndarray) -> list[list[int]]:
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
