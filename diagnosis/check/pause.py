"""An input that was not applied for a while, or did not move: the stated course but for one interval."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Course

#: Pieces of the recording at whose ends an interval is sought first, and how often steps are halved from there.
PIECES, HALVINGS = 12, 5
#: Lengths of intervals from where readings depart, each half of the one before.
SHORTER = 8
#: What an input does in the interval.
NOTHING, STAYED = "nothing acted", "it did not move"


@dataclass(frozen=True)
class Pause:
    """An interval in which an input is not what its course says.

    Args:
        course: Of the input, as stated.
        kind: What it does in the interval.
        begin: Of the interval [s].
        end: Of the interval [s].
        left: Share of the variance that it leaves of the channel that it explains least.
    """

    course: Course
    kind: str
    begin: float
    end: float
    left: float


def paused(
    course: Course,
    kind: str,
    span: tuple[float, float],
    step: float,
    missed: Callable[[Array, Array], float],
    since: float | None = None,
) -> Pause:
    """The interval with which the least is missed.

    Every interval between ends of pieces is tried, and those of several lengths that begin where readings depart; from
    the best one begin and end move by halved steps (compass search; Kolda, Lewis, Torczon, SIAM Review 45 (2003)
    385-482).

    Args:
        course: Of the input, as stated.
        kind: What it does in the interval.
        span: Begin and end of the recording [s].
        step: Macro-step, within which a linear course changes at both ends [s].
        missed: What a course, times [s] and values, leaves of the readings.
        since: When readings depart from what the stated course gives [s]; None: it is not known.
    """
    ends = np.linspace(*span, PIECES + 1)

    def of(interval: tuple[float, float]) -> float:
        begin, end = interval
        return missed(*_with_pause(course, kind, begin, end, step)) if end - begin > 2.0 * step else np.inf

    tried = list(itertools.combinations(ends.tolist(), 2))
    if since is not None:
        lengths = (span[1] - since) * 0.5 ** np.arange(SHORTER)
        tried += [(since, float(since + length)) for length in lengths]
    values = [of(interval) for interval in tried]
    least = min(values)
    best = tried[values.index(least)]
    width = min((span[1] - span[0]) / PIECES, best[1] - best[0])
    for _ in range(HALVINGS):
        width *= 0.5
        moves = [(a * width, b * width) for a, b in itertools.product((-1, 0, 1), repeat=2) if a or b]
        near = [(max(best[0] + a, span[0]), min(best[1] + b, span[1])) for a, b in moves]
        found = {interval: of(interval) for interval in near}
        other = min(found, key=lambda i: found[i])
        if found[other] < least:
            best, least = other, found[other]
    return Pause(course, kind, *best, least)


def _with_pause(course: Course, kind: str, begin: float, end: float, step: float) -> tuple[Array, Array]:
    """Times [s] and values of a course but for an interval."""
    times = np.asarray(course.times)
    before, after = times < begin, times > end
    ends = np.array([begin, end])
    first, last = np.interp(ends, times, course.values) if course.is_linear else course.at(ends)
    inner = 0.0 if kind == NOTHING else first
    edges = [(begin, first), (begin + step, inner), (end - step, inner)] if course.is_linear else [(begin, inner)]
    middle = np.array([*edges, (end, last)])
    return (
        np.concatenate([times[before], middle[:, 0], times[after]]),
        np.concatenate([course.values[before], middle[:, 1], course.values[after]]),
    )
