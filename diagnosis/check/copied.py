"""An input column that stands in two recordings to the last digit, while the readings of one do not follow it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.check.beside import Compared, Course
from diagnosis.check.timing import critical, leading, percent, within
from diagnosis.judge.diagnosis import Doubt

#: Changes of a recorded input from which two equal columns are a copy: a programme of fewer is run twice on purpose.
CHANGES = 8
#: Share of the readings' variance that such a column explains at most where it was another run's, and at least in the
#: recording that it comes from.
NOT_FOLLOWED, FOLLOWED = 0.5, 0.9


def copied_doubts(one: Compared, others: Sequence[Compared]) -> list[Doubt]:
    """At most one doubt: a recorded input is that of another recording, whose readings follow it, as these do not.

    Args:
        one: The recording.
        others: The other recordings of the same rig.
    """
    found = [(c, o) for c in one.courses for o in others if _is_copy(c, o.courses)]
    own = _followed(one) if found else 1.0
    for course, other in found:
        there = _followed(other)
        if own < NOT_FOLLOWED and there > FOLLOWED:
            text = (
                f"its recorded values are, to the last digit, those of `{other.recording.title}`; they explain "
                f"{percent(there)} of the variance of the readings there and {percent(own)} here: they are of another "
                f"run than these readings"
            )
            remedy = f"give the column that was logged together with `{one.recording.title}`"
            z = float(np.sqrt(critical(1.0)))
            return [Doubt(one.recording.title, course.name, "input", text, remedy, True, one.begin, one.end, z)]
    return []


def _is_copy(course: Course, others: Sequence[Course]) -> bool:
    """Whether a recorded input that changes often is the same in another recording."""
    if not course.is_recorded or len(course.switches()) < CHANGES:
        return False
    return any(o.name == course.name and o.is_recorded and np.array_equal(o.values, course.values) for o in others)


def _followed(compared: Compared) -> float:
    """Share of the variance that the simulation explains behind any lag: the median over the leading channels."""
    shares = [within(compared, b, b).share for b in leading(compared)]
    return float(np.median(shares)) if shares else 1.0
