"""Nothing moves: readings at one state say nothing of how a rig responds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import LEVEL
from diagnosis.check.quantiles import chi_square_beyond
from diagnosis.check.readings import measured_noise
from diagnosis.judge.diagnosis import Doubt

#: Kind of the doubt.
STILL = "still"


def still_doubts(every: Sequence[Compared]) -> list[Doubt]:
    """One doubt where in no recording any channel changes by more than its noise, by chi-square of each.

    A model that agrees with such readings is tested at one state alone, and any other that rests there agrees as well.
    """
    members = [b for one in every for b in one.channels.values()]
    if not members or not all(_is_still(b, len(members)) for b in members):
        return []
    text = "no channel of any recording changes by more than its noise: how the rig responds was not measured"
    remedy = "record the rig while it is driven: steps of its inputs, up and down"
    first = every[0]
    return [Doubt(first.recording.title, "channels", STILL, text, remedy, False, first.begin, first.end, 0.0)]


def _is_still(beside: Beside, tests: int) -> bool:
    values = beside.channel.values
    noise = max(beside.channel.deviation, measured_noise(beside), beside.channel.quantum / np.sqrt(12.0))
    if not noise > 0.0 or len(values) < 3:
        return False
    squares = float(np.sum(((values - values.mean()) / noise) ** 2))
    return bool(squares < chi_square_beyond(LEVEL / tests, len(values) - 1))
