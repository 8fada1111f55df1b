"""One recording that the scenario misses while it meets the others: what is wrong is of that recording alone.

A wrong number or a law that is missing acts in all recordings, if all of them reach where it acts. Where the scenario
as it is explains nearly all of the others and not this one, its input, its start or its day is another one. Which of
them, the readings need not show.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.check.beside import Compared
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt

#: Share of their variance that the scenario explains of the others, all numbers as they are.
MET = 0.95
#: How many times more of its variance is left of a recording that stands out, and how much of it at least: any model
#: leaves a hundredth (`diagnosis.check.beside.DISCREPANCY`).
TIMES, LEAST = 10.0, 0.01
#: Share of the variance of a channel that is left, scaled and shifted as suits best, of a recording one of whose
#: inputs hardly is the one that acted: the same numbers explain the others.
HALF = 0.5
#: Other recordings that have to be met: one alone may be the odd one itself.
OTHERS = 2


@dataclass(frozen=True)
class _Left:
    """Shares of a channel's variance that the scenario leaves: as it is, and scaled and shifted as suits best."""

    name: str
    as_is: float
    scaled: float


def odd_ones(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about recordings that stand out from the others, one each; serious where little of one is explained."""
    channels = [_left(one) for one in every]
    left = [max((c.as_is for c in own), default=None) for own in channels]
    found = []
    for number, (one, own) in enumerate(zip(every, left)):
        others = [v for i, v in enumerate(left) if i != number and v is not None]
        if own is None or len(others) < OTHERS or max(others) > 1.0 - MET or own < max(TIMES * max(others), LEAST):
            continue
        told = f"at least {percent(1.0 - max(others))} of the variance of each other recording that can be compared"
        text = f"the scenario as it is explains {told} and {percent(max(1.0 - own, 0.0))} of this one's"
        worst = max(channels[number], key=lambda c: c.scaled)
        if worst.scaled >= HALF:
            text += f", of {worst.name} at most {percent(1.0 - worst.scaled)} however it is scaled and shifted"
        remedy = (
            "a wrong number shows in all of them, and so does a missing law unless only this one reaches where it "
            "acts: look at this recording's input, start and day first"
        )
        z = float(np.sqrt(own / max(*others, 1e-12)))
        found.append(
            Doubt(
                one.recording.title,
                "all channels",
                "odd one out",
                text,
                remedy,
                worst.scaled >= HALF,
                one.begin,
                one.end,
                z,
            )
        )
    return found


def _left(one: Compared) -> list[_Left]:
    """What is left of each channel; empty where nothing can be compared.

    Of channels that change by far more than their noise: of others the noise is the variance.
    """
    shares = []
    for name, beside in one.channels.items():
        if not beside.is_comparable:
            continue
        total = float(np.var(beside.measured))
        if total <= (TIMES * beside.floor) ** 2:
            continue
        rest = beside.measured - beside.simulated_there
        as_is = max(float(np.mean(rest**2)) - beside.floor**2, 0.0) / total
        moves = float(np.std(beside.simulated_there)) > 0.0
        followed = float(np.corrcoef(beside.measured, beside.simulated_there)[0, 1]) if moves else 0.0
        shares.append(_Left(name, as_is, 1.0 - max(followed, 0.0) ** 2))
    return shares
