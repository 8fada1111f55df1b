"""A channel of which the scenario explains next to nothing in any recording: are its inputs the ones that acted?

A number that is off, a law that is missing or a resonance that is elsewhere may do that too, so it is a question.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from diagnosis.check.beside import Beside, Compared
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt

#: Share of its variance up to which the simulation, scaled and offset as suits best, explains next to nothing.
NEXT_TO_NOTHING = 0.1
#: Recordings that have to say the same.
RECORDINGS = 2
#: How many times its noise a channel must change by.
MOVES = 10.0


def unfollowed(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about the inputs of all recordings, one for each channel; none is serious."""
    return list(_told(every))


def _told(every: Sequence[Compared]) -> Iterator[Doubt]:
    for name in dict.fromkeys(n for one in every for n in one.channels):
        having = [one for one in every if name in one.channels]
        shares = [_explained(one.channels[name]) for one in having]
        if len(having) < RECORDINGS or any(s is None or s > NEXT_TO_NOTHING for s in shares):
            continue
        largest = max(s for s in shares if s is not None)
        text = (
            f"in this and in every other recording that has it the scenario as it is explains at most "
            f"{percent(largest)} of the variance of {name}, however it is scaled and offset"
        )
        remedy = "are the inputs of scenario and recordings the ones that acted?"
        one = having[0]
        yield Doubt(one.recording.title, name, "programme", text, remedy, False, one.begin, one.end, 0.0)


def _explained(beside: Beside) -> float | None:
    """Squared correlation of readings and simulation; None where one of them hardly moves."""
    if not beside.is_comparable or not beside.moves or np.std(beside.measured) <= MOVES * beside.floor:
        return None
    return float(np.corrcoef(beside.measured, beside.simulated_there)[0, 1]) ** 2
