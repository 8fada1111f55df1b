"""An input whose column is late or early in one recording, while the other inputs of it are not.

What moves all readings against all inputs is a clock of the recording (`diagnosis.check.clock_shift`). A logger of its
own for one input, as of the wind, moves that input alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace

import numpy as np

from cosim.components import nanoseconds
from cosim.run import RunStopped
from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared, Course
from diagnosis.check.input_runs import InputRuns, given_as, is_quick, of_one_element, parts_of
from diagnosis.check.odd_one_out import comparable, left, scaled_left
from diagnosis.check.other_course import CHANNELS, MET, PAUSED, stated_share
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.series import series_of

#: Share of the recording by which an input may be late, and most shifts that are tried before the best is refined.
LONGEST, MOST_SHIFTS = 0.1, 60
#: Correlation of an input with itself below which a shift is another one: no coarser steps are tried.
ALIKE = 0.7
#: How often the step is halved from the best shift.
HALVINGS = 8
#: Times each way by which an input is moved where a clock seems to run wrong, and how often the best is refined.
SIZES, FINER = 7, 3


@dataclass(frozen=True)
class Late:
    """How late an input is.

    Args:
        course: Of the input, as stated.
        shift: What its times have to be moved by [s]: it acted later where that is positive.
        left: Share of the variance that it then leaves of the channel that it explains least.
    """

    course: Course
    shift: float
    left: float


def late_input(one: Compared) -> Doubt | None:
    """A serious doubt about the input that is late or early as a whole; None where no single one is.

    What explains one channel alone is of its sensor as well, and what moves all inputs as far is the clock of the
    readings.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
    """
    channels = comparable(one)
    if one.base is None or not is_quick(one.scenario):
        return None
    lefts = [scaled_left(b, b.simulated_there) for b in channels.values()]
    moving = [c for c in of_one_element(one) if np.ptp(c.values) > 0.0]
    if sum(share > 1.0 - MET for share in lefts) < CHANNELS or len(moving) < 2:
        return None
    least = min(1.0 - MET, max(lefts) / PAUSED)
    step = nanoseconds(one.scenario.time.macro_step) * 1e-9
    with closing(InputRuns(one)) as runs:
        tried = [_late(c, (one.begin, one.end), step, runs.missed_with(channels, c)) for c in moving]
        found = min((f for f in tried if f is not None), key=lambda f: f.left, default=None)
        if found is None or found.left >= least:
            return None
        others = tuple(given_as(c, np.asarray(c.times) + found.shift, c.values) for c in moving)
        try:
            together = parts_of(channels, runs.readings(channels, others))
        except RunStopped:
            together = []
    if together and max(scaled_left(b, part) for b, part in zip(channels.values(), together)) < least:
        return None
    return _of_late(one, channels, found)


def gain_of_late_input(one: Compared, asked: Sequence[Beside], misfit: Callable[[Beside], float]) -> float:
    """What a time by which one input is late or early gains over none, the best of all inputs that move.

    A dead time of one input among several is neither a lag nor a shift of all readings. -inf where nothing moves, or a
    simulation takes longer than compiled code does.

    Args:
        one: Any recording.
        asked: Channels that are asked.
        misfit: -2 log likelihood of a channel, as a number that falls where its simulated course explains it better.
    """
    if one.base is None or not is_quick(one.scenario):
        return -np.inf
    with closing(InputRuns(one)) as runs:
        return _gain(runs, asked, misfit)


def _gain(runs: InputRuns, asked: Sequence[Beside], misfit: Callable[[Beside], float]) -> float:
    one = runs.one
    source = one.recording.path / "recording.yaml"

    def missed(course: Course, shift: float) -> float:
        try:
            results = runs.results([given_as(course, np.asarray(course.times) + shift, course.values)])
        except RunStopped:
            return np.inf
        return sum(misfit(replace(b, simulated=series_of(results, b.channel.target, source))) for b in asked)

    sizes = np.geomspace(nanoseconds(one.scenario.time.macro_step) * 1e-9, LONGEST * (one.end - one.begin), SIZES)
    gains = [-np.inf]
    without = sum(misfit(b) for b in asked)
    for course in (c for c in of_one_element(one) if np.ptp(c.values) > 0.0):
        found = {float(s): missed(course, float(s)) for s in (*-sizes, *sizes)}
        best, ratio = min(found, key=lambda s: found[s]), float(sizes[1] / sizes[0])
        for _ in range(FINER):
            ratio = float(np.sqrt(ratio))
            found |= {s: missed(course, s) for s in (best / ratio, best * ratio)}
            best = min(found, key=lambda s: found[s])
        gains.append(without - found[best])
    return max(gains)


def _late(
    course: Course, span: tuple[float, float], step: float, missed: Callable[[Array, Array], float]
) -> Late | None:
    """The shift with which the least is missed; None where it is none, or the input moves too fast for so many shifts.

    Args:
        course: Of the input, as stated.
        span: Begin and end of the recording [s].
        step: Macro-step [s]: what is no longer is an error of the coupling.
        missed: What a course, times [s] and values, leaves of the readings.
    """
    longest = LONGEST * (span[1] - span[0])
    width = max(_memory(course, span), step)
    if 2.0 * longest / width > MOST_SHIFTS:
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
    return Late(course, best, found[best]) if abs(best) > 2.0 * step else None


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


def _of_late(one: Compared, channels: dict[str, Beside], found: Late) -> Doubt:
    lefts = {n: left(b, b.simulated_there) for n, b in channels.items()}
    origin = "column" if found.course.is_recorded else "programme"
    how = f"{abs(found.shift):.2g} s {'later' if found.shift > 0.0 else 'earlier'}"
    text = (
        f"{stated_share(found.course, lefts)}; as if it acted {how} than its {origin} says, at "
        f"least {percent(1.0 - found.left)} of each channel's, scaled and shifted as suits best; the other "
        "recordings are met with their courses"
    )
    remedy = (
        f"compare the clock of `{found.course.name}` with that of the readings, and correct the times of its {origin}"
    )
    z = float(np.sqrt(max(lefts.values()) / max(found.left, 1e-6)))
    return Doubt(one.recording.title, found.course.name, "clock", text, remedy, True, one.begin, one.end, z)
