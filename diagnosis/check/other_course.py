"""A recording that stands out, whose readings follow another course of one input than the one that is stated.

A slow rig forgets the switches of its input, so that readings of another run resemble what the stated course gives.
Where the scenario meets the other recordings, that input is estimated from the readings: as a course of equal steps,
by least squares, within the range that it has in all recordings. If it then explains every channel, and is unlike the
stated course over most of the recording, the stated course is not the one that acted.

One channel proves nothing, since some input gives it nearly any course; and a law of the rig that acts for a while,
as a force does, leaves a course that is the stated one for the rest of the time. So does an input that is not applied
for a while, or does not move (`diagnosis.check.pause`): that is said, and the search finds its begin and end. An input
that is late or early as a whole, while others are not, has a clock of its own (`diagnosis.check.late_input`).

Source: estimation of an unknown input by constrained least squares, Maciejowski, Predictive Control with Constraints,
Pearson 2002, chapter 2; Gauss-Newton steps for models that are not linear.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from itertools import pairwise

import numpy as np
from scipy.optimize import lsq_linear

from cosim.components import nanoseconds
from cosim.run import RunStopped
from cosim.unit.protocol import Array
from cosim.unit.quantity import parse_unit
from diagnosis.check.beside import Beside, Compared, Course
from diagnosis.check.input_runs import InputRuns, given_as, is_quick, of_one_element, parts_of
from diagnosis.check.odd_one_out import comparable, left, most_left, scaled_left
from diagnosis.check.pause import NOTHING, STAYED, Pause, paused
from diagnosis.check.timing import percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import ODD

#: Steps of the estimated course.
STEPS = 24
#: Gauss-Newton steps, each of as many simulations.
ROUNDS = 2
#: Share of the variance of every channel that has to be explained: that from which the other recordings count as met.
MET = 0.95
#: Share of its variance that the stated course has to leave of a channel: the recording is not met at all.
MISSED = 0.5
#: Channels that have to answer to the input.
CHANNELS = 2
#: Share of an input's range by which numbers of the model that are off may take the estimate beyond it.
BEYOND = 0.1
#: Correlation with the stated course below which an estimate is unlike it: courses of ten levels that have nothing to
#: do with each other stay below it in 98 of 100 draws. Share of the range by which one differs at least.
UNLIKE, APART = 0.7, 0.2
#: How many times more the stated course leaves of a channel, scaled and shifted too, than one that pauses or is late.
PAUSED = 10.0
#: Macro-steps beyond which intervals are not sought in inputs of which no other course explains the readings.
MOST_PAUSES = 10_000
#: How many times the largest misfit of any other recording a reading is off that has departed.
DEPARTED = 1.5
#: Deviations of the noise from which a channel answers to an input that is higher by half its range.
ANSWERS = 10.0


def other_course(one: Compared, others: Sequence[Compared], least: float = MISSED) -> Doubt | None:
    """A doubt about the input whose stated course is not the one that acted; None where no single one is.

    It is not serious where the stated course acted but for an interval: the search looks for it.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
        least: Share of its variance that the stated course leaves of a channel at least. Below `MISSED`, where the
            recording is met for the most part, intervals alone are sought, and no other course is estimated.
    """
    channels = comparable(one)
    if one.base is None or not is_quick(one.scenario) or len(channels) < CHANNELS:
        return None
    missed = most_left(channels.values(), left)
    if missed < least:
        return None
    with closing(InputRuns(one)) as runs:
        found = _other_courses(runs, others, channels) if missed >= MISSED else []
        is_short = one.scenario.time.macro_steps <= MOST_PAUSES
        asked = [course for course, *_ in found] or (of_one_element(one) if is_short else [])
        of_pause = _paused(runs, others, channels, asked)
    return of_pause or (_doubt(one, channels, *found[0]) if len(found) == 1 else None)


def _other_courses(
    runs: InputRuns, others: Sequence[Compared], channels: dict[str, Beside]
) -> list[tuple[Course, float, float]]:
    """Inputs of which another course explains the readings, with the share explained and the likeness to the stated."""
    found, one = [], runs.one
    for course in of_one_element(one):
        alike = [c for o in (one, *others) for c in o.courses if c.name == course.name]
        low, high = (float(f([f(c.values) for c in alike])) for f in (np.min, np.max))
        if high <= low:
            continue  # a constant everywhere has no range
        margin = BEYOND * (high - low)
        told = _estimated(runs, channels, course, (low - margin, high + margin))
        if told is not None:
            found.append((course, *told))
    return found


def _paused(
    runs: InputRuns, others: Sequence[Compared], channels: dict[str, Beside], courses: Sequence[Course]
) -> Doubt | None:
    since = _departure(channels, others)
    as_stated = most_left(channels.values(), scaled_left)
    every = [pause for course in courses for pause in _pauses(runs, channels, course, since)]
    pauses = [p for p in every if p.left < min(1.0 - MET, as_stated / PAUSED)]
    return _of_pause(runs.one, channels, min(pauses, key=lambda p: p.left)) if pauses else None


def _estimated(
    runs: InputRuns, channels: dict[str, Beside], course: Course, bounds: tuple[float, float]
) -> tuple[float, float] | None:
    """Least share explained of a channel, and correlation with the stated course; None if that course may have acted.

    Args:
        runs: Of the recording.
        channels: Its channels that are compared, by name.
        course: Of the input, as stated.
        bounds: Of its values.
    """
    one = runs.one
    knots = np.linspace(one.begin, one.end, STEPS + 1)
    knots[0] = min(knots[0], one.scenario.time.start.to("s"))
    held = knots if course.is_linear else knots[:-1]
    stated = _means(course, knots) if not course.is_linear else course.at(knots)
    values = np.clip(stated, *bounds)
    weights = np.concatenate([np.full(len(b.times), 1.0 / _size(b)) for b in channels.values()])
    measured = np.concatenate([b.measured for b in channels.values()])
    step = 0.5 * (bounds[1] - bounds[0])
    try:
        for _ in range(ROUNDS):
            here = runs.readings(channels, (given_as(course, held, values),))
            rows = []
            for k in range(len(held)):
                other = values.copy()
                other[k] += step if values[k] + step <= bounds[1] else -step
                rows.append((runs.readings(channels, (given_as(course, held, other),)) - here) / (other[k] - values[k]))
            slopes = np.array(rows).T
            risen = parts_of(channels, slopes.sum(axis=1) * step)
            if sum(_answers(b, part) for b, part in zip(channels.values(), risen)) < CHANNELS:
                return None
            goal = measured - here + slopes @ values
            values = np.asarray(lsq_linear(slopes * weights[:, None], goal * weights, bounds).x)
        after = parts_of(channels, runs.readings(channels, (given_as(course, held, values),)))
    except RunStopped:
        return None
    explained = 1.0 - max(scaled_left(b, part) for b, part in zip(channels.values(), after))
    likeness = _likeness(stated, values, bounds)
    return None if explained < MET or likeness >= UNLIKE else (explained, likeness)


def _departure(channels: dict[str, Beside], others: Sequence[Compared]) -> float | None:
    """When the first channel departs from its simulation by more than channels of the others ever do, to stay [s]."""
    found = []
    for name, beside in channels.items():
        there = [o.channels[name] for o in others if name in comparable(o)]
        if not there:
            return None
        most = DEPARTED * max(float(np.abs(b.measured - b.simulated_there).max()) for b in there)
        is_away = np.abs(beside.measured - beside.simulated_there) > max(most, DEPARTED * beside.floor)
        runs = np.flatnonzero(is_away[2:] & is_away[1:-1] & is_away[:-2])
        found += [float(beside.times[max(runs[0] - 1, 0)])] if len(runs) else []
    return min(found, default=None)


def _pauses(runs: InputRuns, channels: dict[str, Beside], course: Course, since: float | None) -> list[Pause]:
    """Intervals without which the stated course explains most: it was not applied then, or did not move."""
    one, missed = runs.one, runs.missed_with(channels, course)
    step = nanoseconds(one.scenario.time.macro_step) * 1e-9
    is_temperature = parse_unit(course.unit).dimensionality == parse_unit("K").dimensionality  # its zero is not nothing
    kinds = [] if is_temperature or not np.any(course.values) else [NOTHING]
    kinds += [STAYED] if np.ptp(course.values) > 0.0 else []
    return [paused(course, kind, (one.begin, one.end), step, missed, since) for kind in kinds]


def _likeness(stated: Array, values: Array, bounds: tuple[float, float]) -> float:
    """Correlation of two courses; where one hardly changes, 1 if they agree most of the time and else 0."""
    width = bounds[1] - bounds[0]
    if np.std(values - stated) < APART * width and abs(np.mean(values - stated)) < APART * width:
        return 1.0
    if np.ptp(stated) < APART * width or np.ptp(values) < APART * width:
        return float(np.mean(np.abs(values - stated) < APART * width) > 0.5)
    return float(np.corrcoef(stated, values)[0, 1])


def _means(course: Course, knots: Array) -> Array:
    """Means of a course between knots."""
    fine = np.linspace(0.0, 1.0, 50, endpoint=False)
    return np.array([float(np.mean(course.at(a + fine * (b - a)))) for a, b in pairwise(knots.tolist())])


def _answers(beside: Beside, part: Array) -> bool:
    """Whether a channel answers to an input that is higher by half its range from the begin on."""
    return bool(np.max(np.abs(part)) > ANSWERS * beside.floor)


def _size(beside: Beside) -> float:
    return float(np.std(beside.measured))


def _of_pause(one: Compared, channels: dict[str, Beside], pause: Pause) -> Doubt:
    lefts = {n: left(b, b.simulated_there) for n, b in channels.items()}
    text = (
        f"{stated_share(pause.course, lefts)}; as if {pause.kind} from about {pause.begin:.6g} to {pause.end:.6g} s, "
        f"at least {percent(1.0 - pause.left)} of each channel's, scaled and shifted as suits best; the other "
        "recordings are met with their courses"
    )
    remedy = f"what acted at `{pause.course.name}` then? State it under `overrides`, or give its column"
    z = float(np.sqrt(max(lefts.values()) / max(pause.left, 1e-6)))
    return Doubt(one.recording.title, pause.course.name, ODD, text, remedy, False, pause.begin, pause.end, z)


def stated_share(course: Course, lefts: dict[str, float]) -> str:
    worst = max(lefts, key=lambda n: lefts[n])
    origin = "recorded" if course.is_recorded else "stated"
    mine = percent(max(1.0 - lefts[worst], 0.0))
    return f"with the {origin} course of {course.name} the scenario explains {mine} of the variance of {worst}"


def _doubt(one: Compared, channels: dict[str, Beside], course: Course, explained: float, likeness: float) -> Doubt:
    lefts = {n: left(b, b.simulated_there) for n, b in channels.items()}
    text = (
        f"{stated_share(course, lefts)}; with another one within the range of all recordings, which is unlike it "
        f"(correlation {likeness:.2f}), at least {percent(explained)} of each channel's, scaled and shifted as suits "
        f"best; the other recordings are met with theirs"
    )
    remedy = (
        f"is the column of `inputs.{course.name}` of another run? Give the one that was logged with these readings"
        if course.is_recorded
        else f"was this programme of `{course.name}` played? State the one that was, under `overrides`, or its column"
    )
    title, z = one.recording.title, float(np.sqrt(max(lefts.values()) / max(1.0 - explained, 1e-6)))
    return Doubt(title, course.name, "programme", text, remedy, True, one.begin, one.end, z)
