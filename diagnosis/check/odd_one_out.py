"""One recording that the scenario misses while it meets the others: what is wrong is of that recording alone.

A wrong number or a law that is missing acts in all recordings. Where the scenario as it is explains nearly all of the
others and not this one, its input, its start or its day is another one. Which of them, the readings need not show.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.check.beside import Compared
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import FEWEST_VALUES

#: Share of their variance that the scenario explains of the others, all numbers as they are.
MET = 0.95
#: How many times more of its variance is left of a recording that stands out.
TIMES = 10.0
#: Share of the variance of each channel that is left of a recording whose input is hardly the one that acted: nothing
#: of its course is explained, while the same numbers explain the others.
NOTHING = 0.9
#: Other recordings that have to be met: one alone may be the odd one itself.
OTHERS = 2


def odd_ones(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about recordings that stand out from the others, one each; serious where nothing of one is explained."""
    shares = [_left(one) for one in every]
    left = [max(own, default=None) for own in shares]
    found = []
    for number, (one, own) in enumerate(zip(every, left)):
        others = [v for i, v in enumerate(left) if i != number and v is not None]
        if own is None or len(others) < OTHERS or max(others) > 1.0 - MET or own < TIMES * max(others):
            continue
        told = f"at least {percent(1.0 - max(others))} of the variance of each other recording"
        text = f"the scenario as it is explains {told} and {percent(max(1.0 - own, 0.0))} of this one's"
        remedy = (
            "a wrong number or a missing law would show in all of them: look at this recording's input, start and day"
        )
        is_serious = min(shares[number]) >= NOTHING
        z = float(np.sqrt(own / max(*others, 1e-12)))
        found.append(
            Doubt(one.recording.title, "all channels", "odd one out", text, remedy, is_serious, one.begin, one.end, z)
        )
    return found


def _left(one: Compared) -> list[float]:
    """Share of each channel's variance that the scenario as it is leaves; empty where nothing can be compared.

    Of channels that change by far more than their noise: of others the noise is the variance.
    """
    shares = []
    for beside in one.channels.values():
        if beside.simulated is None or len(beside.pick) < FEWEST_VALUES:
            continue
        total = float(np.var(beside.measured))
        if total <= (TIMES * beside.floor) ** 2:
            continue
        rest = float(np.mean((beside.measured - beside.simulated_there) ** 2))
        shares.append(max(rest - beside.floor**2, 0.0) / total)
    return shares
