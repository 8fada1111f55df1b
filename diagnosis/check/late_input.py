"""An input whose column is late or early in one recording, while the other inputs of it are not.

What moves all readings against all inputs is a clock of the recording (`diagnosis.check.clock_shift`). A logger of its
own for one input, as of the wind, moves that input alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Course

#: Share of the recording by which an input may be late, and most shifts that are tried before the best is refined.
LONGEST, MOST_SHIFTS = 0.1, 60
#: Correlation of an input with itself below which a shift is another one: no coarser steps are tried.
ALIKE = 0.7
#: How often the step is halved from the best shift.
HALVINGS = 8


@dataclass(frozen=True)
class Late:
    """How late an input is.

    Args:
        course: Of the input, as stated.
        shift: What its times have to be moved by [s]: it acted later where that is positive.
        left: Share of the variance that it then leaves of the channel that it explains least.
        resolution: Last step of the search [s].
    """

    course: Course
    shift: float
    left: float
    resolution: float


def late(
    course: Course, span: tuple[float, float], step: float, missed: Callable[[Array, Array], float]
) -> Late | None:
    """The shift with which the least is missed; None where the input hardly moves, or too fast for so many shifts.

    Args:
        course: Of the input, as stated.
        span: Begin and end of the recording [s].
        step: Macro-step [s]: what is no longer is an error of the coupling.
        missed: What a course, times [s] and values, leaves of the readings.
    """
    longest = LONGEST * (span[1] - span[0])
    width = max(_memory(course, span), step)
    if not np.ptp(course.values) > 0.0 or 2.0 * longest / width > MOST_SHIFTS:
        return None
    times, values = np.asarray(course.times), np.asarray(course.values)

    def of(shift: float) -> float:
        return missed(times + shift, values)

    count = int(np.ceil(longest / width))
    found = {float(s): of(float(s)) for s in width * np.arange(-count, count + 1)}
    best = min(found, key=lambda s: found[s])
    for _ in range(HALVINGS):
        width *= 0.5
        found |= {s: of(s) for s in (best - width, best + width)}
        best = min(found, key=lambda s: found[s])
    return Late(course, best, found[best], width) if abs(best) > 2.0 * step else None


def _memory(course: Course, span: tuple[float, float]) -> float:
    """Longest shift [s] after which the input is still like itself."""
    grid = np.linspace(*span, 2000)
    values = np.asarray(course.at(grid))
    values = values - values.mean()
    size = float(values @ values)
    if not size > 0.0:
        return span[1] - span[0]
    for lag in range(1, len(grid) // 4):
        if float(values[lag:] @ values[:-lag]) < ALIKE * size:
            return float(grid[lag] - grid[0])
    return float(grid[len(grid) // 4] - grid[0])
