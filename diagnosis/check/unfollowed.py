"""A channel of which the scenario explains next to nothing in any recording: are its inputs the ones that acted?

A number that is off, a law that is missing or a resonance that is elsewhere may do that too, so it is a question. It
is none where the readings follow the inputs by no response with memory at all, while the simulation does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from diagnosis.check.beside import Beside, Compared
from diagnosis.check.response import Followed, followed
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt

#: Share of its variance up to which the simulation, scaled and offset as suits best, explains next to nothing.
NEXT_TO_NOTHING = 0.1
#: Recordings that have to say the same.
RECORDINGS = 2
#: How many times its noise a channel must change by.
MOVES = 10.0
#: Share of a simulated channel that a response to the inputs has to predict, to say anything of the measured one.
SHOWN = 0.5
#: Share of a channel's variance that is taken for nothing where a size is asked for.
LEAST = 1e-4


def unfollowed(every: Sequence[Compared]) -> list[Doubt]:
    """Doubts about channels that the scenario does not explain in any recording, and about the inputs of these.

    One is serious where its readings show no answer to any input, and the simulation does: the inputs are not those
    that acted on it, or its column is of something else.
    """
    return [_doubt(every, name, share, _without_answer(every, name)) for name, share in _asked(every)]


def _asked(every: Sequence[Compared]) -> Iterator[tuple[str, float]]:
    """Channels of which next to nothing is explained, with the largest share in a recording."""
    for name in dict.fromkeys(n for one in every for n in one.channels):
        shares = [_explained(one.channels[name]) for one in every if name in one.channels]
        known = [s for s in shares if s is not None]
        if len(shares) >= RECORDINGS and len(known) == len(shares) and max(known) <= NEXT_TO_NOTHING:
            yield name, max(known)


def _without_answer(every: Sequence[Compared], name: str) -> Followed | None:
    """How far inputs predict a channel that shows no answer to them; None where it does, or might."""
    having = [one for one in every if name in one.channels and one.channels[name].is_comparable]
    found = followed(having, name)
    is_told = found is not None and found.simulated >= SHOWN and found.measured <= NEXT_TO_NOTHING
    return found if is_told else None


def _doubt(every: Sequence[Compared], name: str, share: float, answer: Followed | None) -> Doubt:
    one = next(one for one in every if name in one.channels)
    text = (
        f"in this and in every other recording that has it the scenario as it is explains at most "
        f"{percent(share)} of the variance of {name}, however it is scaled and offset"
    )
    if answer is None:
        remedy = "are the inputs of scenario and recordings the ones that acted?"
        return Doubt(one.recording.title, name, "programme", text, remedy, False, one.begin, one.end, 0.0)
    text += (
        f", and no response with memory joins these readings to the inputs: fitted to half of each recording it "
        f"predicts {percent(answer.measured)} of the other half, and {percent(answer.simulated)} of what is simulated"
    )
    remedy = (
        "compare the programme, or the recorded input, with what was played and with what the actuator did; is it the "
        "column of this channel?"
    )
    z = float(np.sqrt(answer.simulated / max(answer.measured, LEAST)))
    return Doubt(one.recording.title, name, "no answer", text, remedy, True, one.begin, one.end, z)


def _explained(beside: Beside) -> float | None:
    """Squared correlation of readings and simulation; None where one of them hardly moves."""
    if not beside.is_comparable or not beside.moves or np.std(beside.measured) <= MOVES * beside.floor:
        return None
    return float(np.corrcoef(beside.measured, beside.simulated_there)[0, 1]) ** 2
