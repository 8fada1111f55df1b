"""Readings by themselves: noise, wild readings, gaps, readings that stand still, steps that the rig does not make."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import cast

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.check.beside import ROUNDING, Beside, Compared
from diagnosis.check.ends import range_doubts
from diagnosis.check.explain import LEVEL, explained
from diagnosis.check.feedthrough import QUIETER, quieter
from diagnosis.check.quantiles import chi_square_beyond, normal_beyond, student_beyond, student_log_height
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.noise import estimate_noise, is_unresolved, repeated
from diagnosis.report.display import instant

#: A noise is measured by its neighbours to within a factor: what filters and pickup do to neighbouring readings counts.
HONEST = 2.0
#: Neighbouring increments on each side whose mean an increment is compared with, and whose scatter.
SIDE, WIDE = 4, 12
#: Readings over which a course may go over from one line to another, and is no step then.
RAMPS = (5.0, 8.0)
#: A temperature that steps by so many times its largest change from one reading to the next elsewhere steps faster than
#: the rig makes it: a heat flow may double where another comes to it.
FASTER = 2.0
#: Largest steps that are left out where the tail of the noise is estimated: two stretches with two ends.
SPARED = 4
#: Degrees of freedom that the noise of a sensor is given; the likelihood chooses.
TAILS = (2.5, 3.0, 4.0, 6.0, 10.0, 30.0, 1000.0)


@dataclass(frozen=True)
class Jump:
    """An increment that its neighbours do not announce.

    Args:
        index: Of the reading after it.
        size: In the channel's unit.
        z: In deviations of an increment.
    """

    index: int
    size: float
    z: float


def reading_doubts(compared: Compared, is_timed: bool = True) -> list[Doubt]:
    """Doubts about the readings of every channel.

    Args:
        compared: A recording beside its simulation.
        is_timed: Whether the response follows the programme; else steps are not asked for: they may be the programme's.
    """
    found = []
    for beside in compared.channels.values():
        stuck = stuck_stretches(compared, beside)
        found += [*_noise(compared, beside), *_gaps(compared, beside), *range_doubts(compared, beside)]
        found += [_stuck(compared, beside, a, b) for a, b in stuck]
        steps = _steps(compared, beside) if is_timed else []
        found += [d for d in steps if not any(_near(beside, d, s) for s in stuck)]
    return found


def measured_noise(beside: Beside) -> float:
    """Standard deviation of a channel's readings by their neighbours, rounding included; see `quieter`."""
    if "noise" not in beside.memo:
        channel, own = beside.channel, beside.simulated
        plain = estimate_noise(channel.times, channel.values, channel.quantum)
        noise = plain if own is None else quieter(channel, own)
        least = ROUNDING * float(np.max(np.abs(channel.values), initial=0.0))
        beside.memo["noise"] = max(noise if noise < QUIETER * plain else plain, least)
    return cast(float, beside.memo["noise"])


def _near(beside: Beside, doubt: Doubt, stretch: tuple[int, int]) -> bool:
    """Whether a doubt is the end of a stretch that stands still."""
    times = beside.channel.times
    begin, end = times[max(stretch[0] - 1, 0)], times[min(stretch[1] + 1, len(times) - 1)]
    return bool(begin <= doubt.begin <= end or begin <= doubt.end <= end)


def _noise(compared: Compared, beside: Beside) -> list[Doubt]:
    """Stated noise against the scatter between neighbours: chi-square of their differences.

    Readings that repeat a value, of a sensor that stands still or is at an end of its range, say nothing of its noise.
    Deviations of single readings hold what neighbours share (a marker at rest has the same error in all pictures), so
    that less scatter is no doubt of them.
    """
    channel = beside.channel
    if not channel.is_deviation_given or len(channel.values) < 32:
        return []
    stated = float(np.hypot(channel.deviation, channel.quantum / np.sqrt(12.0)))
    seen = measured_noise(beside)
    degrees = len(channel.values) / 3.0  # a bend takes three readings
    ratio = seen / stated
    tail = LEVEL / len(compared.channels)
    least, most = chi_square_beyond(1.0 - tail, degrees), chi_square_beyond(tail, degrees)
    is_small = degrees * (ratio * HONEST) ** 2 < least
    if is_small and channel.is_of_each_reading:
        return []
    moving = ~repeated(channel.values)
    if is_small and not moving.all():
        count = int(np.count_nonzero(moving))
        own = estimate_noise(channel.times[moving], channel.values[moving], channel.quantum) if count >= 32 else stated
        degrees, seen, ratio = count / 3.0, own, own / stated
        if not degrees * (ratio * HONEST) ** 2 < chi_square_beyond(1.0 - tail, max(degrees, 1.0)):
            return []
    if not is_small and not degrees * (ratio / HONEST) ** 2 > most:
        return []
    if not is_small and is_unresolved(channel.times, channel.values, channel.quantum):
        return []
    way = "less" if is_small else "more"
    is_rounded = stated > 1.005 * channel.deviation
    rounded = f" ({compared.units.text(stated, channel.unit)} with the rounding)" if is_rounded else ""
    text = (
        f"stated is a noise of {compared.units.text(channel.deviation, channel.unit)}{rounded}; "
        "neighbouring readings scatter by "
        f"{compared.units.text(seen, channel.unit)}, {max(ratio, 1 / ratio):.3g} times {way}"
    )
    remedy = f"correct `channels.{channel.name}.noise`, or leave it out: then it is estimated"
    if is_small:
        remedy = (
            f"does the noise of neighbouring readings correlate, as behind a filter? Then it is right; else {remedy}"
        )
    return [
        Doubt(
            compared.recording.title,
            channel.name,
            "noise",
            text,
            remedy,
            False,
            compared.begin,
            compared.end,
            float(abs(np.log(ratio)) * np.sqrt(2.0 * degrees)),
        )
    ]


def _gaps(compared: Compared, beside: Beside) -> list[Doubt]:
    """Stretches without readings that chance does not leave, where readings are lost one by one."""
    channel = compared.whole.channels[beside.channel.name]
    steps = np.diff(channel.times)
    usual = float(np.median(steps))
    lost = np.maximum(np.round(steps / usual) - 1.0, 0.0)
    share = float(np.sum(lost[lost < 4]) / max(len(steps), 1))
    # of readings lost independently with this share, a run of n has the probability share^n at each place
    allowed = np.log(LEVEL / (len(steps) * len(compared.channels))) / np.log(min(max(share, 1.0 / len(steps)), 0.5))
    found = []
    for i in np.flatnonzero(lost > max(float(allowed), 3.0)):
        begin, end = float(channel.times[i]), float(channel.times[i + 1])
        text = f"no readings from {instant(begin)} to {instant(end)} s, where one every {instant(usual, 3)} s is usual"
        found.append(
            Doubt(
                compared.recording.title,
                channel.name,
                "sensor",
                text,
                "nothing is judged there; was the sensor or the logger off?",
                False,
                begin,
                end,
                float(lost[i]),
            )
        )
    return found


def stuck_stretches(compared: Compared, beside: Beside) -> list[tuple[int, int]]:
    """First and last reading of stretches of equal readings that cannot be chance.

    Equal readings are chance where nothing moves and a sensor rounds. They are not where the reading after them has to
    catch up at once: a step beyond those of its neighbours and of the noise, after readings without any noise. At an
    end of
    the range a sensor clips, or a current is off: that is no fault.
    """
    channel = beside.channel
    values = channel.values
    if len(values) < 16:
        return []
    edges = np.concatenate([[0], np.flatnonzero(np.diff(values) != 0.0) + 1, [len(values)]])
    noise = max(
        channel.deviation if channel.is_deviation_given else measured_noise(beside), channel.quantum / np.sqrt(12.0)
    )
    limit = normal_beyond(LEVEL / (2.0 * len(values) * len(compared.channels))) * np.sqrt(2.0)
    low, high = float(np.min(values)), float(np.max(values))
    found = []
    for first, after in itertools.pairwise(edges):
        length = int(after - first)
        if length < 4 or values[first] in (low, high) or channel.is_clipped[first]:
            continue
        own = _freedom(values, int(first), int(after))
        if length <= own:
            continue
        if after < len(values):
            step = abs(float(values[after] - values[first]))
            is_caught_up = step > limit * noise and step > _usual_step(values, int(first), int(after))
            if not is_caught_up or _is_driven(beside, int(after)):
                continue
        elif not _moves_within(beside, int(first), int(after), limit * noise):
            continue
        found.append((int(first), int(after) - 1))
    return found


def _freedom(values: Array, first: int, after: int) -> float:
    """Length that runs of equal readings reach by chance, with the share of equal neighbours elsewhere."""
    outside = np.ones(len(values) - 1, dtype=bool)
    outside[first : after - 1] = False
    equal = (np.diff(values) == 0.0)[outside]
    share = (np.count_nonzero(equal) + 1.0) / (len(equal) + 2.0)
    return float(1.0 + np.log(LEVEL / len(values)) / np.log(share))


def _usual_step(values: Array, first: int, after: int) -> float:
    """Largest of the increments around a stretch, without those at its ends."""
    steps = np.abs(np.diff(values))
    around = np.concatenate([steps[max(first - 9, 0) : max(first - 1, 0)], steps[after : after + 8]])
    return float(np.max(around, initial=0.0)) * 2.0


def _is_driven(beside: Beside, after: int) -> bool:
    """Whether the simulation steps as well between a reading and the one before it, by half of what was read or more.

    A voltage that follows its input at once, and a sensor that rounds more than it scatters, repeat one value until
    the input changes.
    """
    if beside.simulated is None:
        return False
    times, values = beside.channel.times, beside.channel.values
    # a row of an input may be late by a reading
    ends = times[max(after - 2, 0)], times[min(after + 1, len(times) - 1)]
    before, then = beside.at(np.array(ends))
    step = float(values[after] - values[after - 1])
    return bool((then - before) * np.sign(step) > 0.5 * abs(step))


def _moves_within(beside: Beside, first: int, after: int, least: float) -> bool:
    """Whether the simulation moves in a stretch at the end of the recording."""
    if beside.simulated is None:
        return False
    course = beside.at(beside.channel.times[first:after])
    before = beside.at(beside.channel.times[:after])
    gain = np.ptp(beside.channel.values[:first]) / max(float(np.ptp(before)), 1e-300) if first > 8 else 0.0
    return bool(min(gain, 1.0) * np.ptp(course) > 2.0 * least)


def _stuck(compared: Compared, beside: Beside, first: int, last: int) -> Doubt:
    channel = beside.channel
    begin, end = float(channel.times[first]), float(channel.times[last])
    caught = (
        f", then {compared.units.text(channel.values[last + 1] - channel.values[last], channel.unit)} more at once"
        if (last + 1 < len(channel.values))
        else " to the end, while the rest moves"
    )
    count = last - first + 1
    text = f"{count} equal readings from {instant(begin)} to {instant(end)} s{caught}: the sensor stood still"
    shift = abs(float(channel.values[min(last + 1, len(channel.values) - 1)] - channel.values[last]))
    return Doubt(
        compared.recording.title,
        channel.name,
        "sensor",
        text,
        "leave these readings empty in the table; look at plug and logger",
        True,
        begin,
        end,
        shift / max(channel.deviation, 1e-300),
    )


def far(values: Array, noise: float, tests: float, width: int = 0) -> float:
    """Size that noise alone reaches with the probability `LEVEL` among so many tests.

    Real sensors have wilder readings than a normal distribution: Student's t by maximum likelihood (Lange, Little,
    Taylor,
    J. Am. Stat. Assoc. 84 (1989) 881-896), of the scale of the noise at least.

    Args:
        values: Draws of it, a few of which may be none; shape (draws,).
        noise: Standard deviation of a draw by the channel's noise.
        tests: Number of tests.
        width: Draws on each side that one step moves as well; the `SPARED` largest steps do not tell the tail.
    """
    kept = np.ones(len(values), dtype=bool)
    for _ in range(SPARED if len(values) > 8 * SPARED * (width + 1) else 0):
        peak = int(np.argmax(np.where(kept, np.abs(values), -1.0)))
        kept[max(peak - width, 0) : peak + width + 1] = False
    values = values[kept]
    middle = float(np.median(np.abs(values)))
    best: tuple[float, float] | None = None
    for tail in TAILS:
        scale = max(middle / _quantile(0.25, tail), noise)
        spread = 0.5 * (tail + 1.0) * float(np.sum(np.log1p((values / scale) ** 2 / tail)))
        likelihood = len(values) * (_log_height(tail) - np.log(scale)) - spread
        limit = scale * _quantile(LEVEL / (2.0 * tests), tail)
        if best is None or likelihood > best[0]:
            best = likelihood, limit
    assert best is not None
    return best[1]


@cache
def _quantile(probability: float, tail: float) -> float:
    """Value that Student's t exceeds with a probability; asked for again with every channel."""
    return student_beyond(probability, tail)


@cache
def _log_height(tail: float) -> float:
    """Logarithm of the density of Student's t at 0."""
    return student_log_height(tail)


def jumps(values: Array, noise: float, tests: float) -> list[Jump]:
    """Increments that stand out among their neighbours.

    An increment less the mean of its neighbours is compared with the noise of the whole channel and, where the
    increments
    around it scatter more than noise does, with their own scatter: a kink makes large increments too, one after the
    other.

    Args:
        values: Shape (samples,).
        noise: Standard deviation of a reading.
        tests: Among so many increments one false jump has the probability `LEVEL`.
    """
    steps: Array = np.diff(values)
    if len(steps) < 2 * WIDE + 1:
        return []
    weights = np.concatenate([np.ones(SIDE), [0.0], np.ones(SIDE)])
    means = np.convolve(steps, weights, "same") / np.convolve(np.ones(len(steps)), weights, "same")
    sizes = steps - means
    scatter = noise * np.sqrt(2.0 * (1.0 + 1.0 / (2 * SIDE)))
    limit = far(sizes, scatter, tests, SIDE)
    found = []
    for i in np.flatnonzero(np.abs(sizes) > limit):
        around = np.concatenate([steps[max(i - WIDE, 0) : i], steps[i + 1 : i + 1 + WIDE]])
        # the opposite step of a short stretch may be among them
        around = around[np.abs(around) < np.max(np.abs(around))]
        degrees = len(around) - 1
        if degrees < WIDE - 1:
            continue
        own, size = float(np.std(around, ddof=1)), float(abs(sizes[i]))
        is_rough = degrees * own**2 > chi_square_beyond(LEVEL, degrees) * scatter**2
        if is_rough and size <= student_beyond(LEVEL / (2.0 * tests), degrees) * own:
            continue
        # a wild reading goes and comes back: the level after the step is that before it
        after, before = values[i + 1 : i + 1 + SIDE], values[max(i + 1 - SIDE, 0) : i + 1]
        if abs(float(np.median(after) - np.median(before)) - float(sizes[i])) > 0.5 * size:
            continue
        found.append(Jump(int(i) + 1, float(sizes[i]), size / scatter))
    return _apart(found, SIDE)


def _apart(found: Sequence[Jump], reach: int) -> list[Jump]:
    """Of steps within reach of one another the largest."""
    kept: list[Jump] = []
    for one in found:
        if kept and one.index - kept[-1].index <= reach:
            kept[-1] = max(kept[-1], one, key=lambda j: j.z)
        else:
            kept.append(one)
    return kept


def level_shifts(values: Array, noise: float, tests: float) -> list[Jump]:
    """Steps of the mean: lines through `WIDE` readings before and after, where both fit and do not meet.

    The generalised likelihood ratio of a step at a known instant between two lines, over all instants (Basseville,
    Nikiforov, Detection of Abrupt Changes, 1993, ch. 2). Where a line does not fit within the noise (chi-square),
    the signal bends and
    nothing is said; the step itself must happen from one reading to the next: a ramp over some readings between the
    same two lines must explain them worse.

    Args:
        values: Shape (samples,).
        noise: Standard deviation of a reading.
        tests: Among so many instants one false step has the probability `LEVEL`.
    """
    width, count = WIDE, len(values)
    if count < 4 * width:
        return []
    index = np.arange(width) - 0.5 * (width - 1)
    windows = np.lib.stride_tricks.sliding_window_view(values, width)
    means, slopes = windows.mean(axis=1), windows @ index / float(index @ index)
    left = np.sum((windows - means[:, None] - slopes[:, None] * index) ** 2, axis=1) / noise**2
    # window k ends before reading k + width, where window k + width begins
    before, after = slice(0, count - 2 * width + 1), slice(width, count - width + 1)
    sizes = (means - 0.5 * width * slopes)[after] - (means + 0.5 * width * slopes)[before]
    deviation = noise * np.sqrt(2.0 * (1.0 / width + 0.25 * width**2 / float(index @ index)))
    limit = far(sizes, deviation, tests, width)
    most = chi_square_beyond(LEVEL, width - 2)
    sharp = np.abs(np.diff(values)[width - 1 : count - width] - sizes) < 0.5 * np.abs(sizes) + 3.0 * noise
    sharp &= _is_sudden(values, noise)
    good = (np.abs(sizes) > limit) & (left[before] < most) & (left[after] < most) & sharp
    every = [
        Jump(int(k) + width, float(sizes[k]), float(abs(sizes[k]) / deviation))
        for k in np.flatnonzero(good)
        if _least_step(values[k : k + 2 * width]) > limit
    ]
    return _apart(every, width // 2)


def _least_step(window: Array) -> float:
    """Smallest step between two lines when any one reading is left out: beside a step one wild reading weighs most.

    Args:
        window: Readings of which a half lies before the step, shape (2 width,).
    """
    half, places = len(window) // 2, np.arange(len(window))
    index = places - half + 0.5

    def end(own: AnyArray) -> float:
        return float(np.polyval(np.polyfit(index[own], window[own], 1), 0.0))

    kept = [places != n for n in places]
    ends = np.array([[end(k & (places < half)), end(k & (places >= half))] for k in kept])
    return float(np.min(np.abs(ends[:, 1] - ends[:, 0])))


def _is_sudden(values: Array, noise: float) -> AnyArray:
    """Whether a step between two lines explains `WIDE` readings before and after better than a course without one.

    A course that goes over in the same place within `RAMPS` readings, with its two lines, must lose by the likelihood
    ratio: twice the logarithm of the odds of 20 to 1, for as many as are tried. Shape (count - 2 WIDE + 1,).
    """
    width = WIDE
    windows = np.lib.stride_tricks.sliding_window_view(values, 2 * width)
    index = np.arange(2 * width) - width + 0.5

    def left(length: float) -> Array:
        share = np.clip(index / length + 0.5, 0.0, 1.0)
        basis = np.column_stack([np.ones(2 * width), index, np.maximum(index, 0.0), share])
        q, _ = np.linalg.qr(basis)
        return np.asarray(np.sum((windows - (windows @ q) @ q.T) ** 2, axis=1) / noise**2)

    least = left(1e-9)
    return np.asarray(np.min([left(length) for length in RAMPS], axis=0) - least > 2.0 * np.log(20.0 * len(RAMPS)))


def _merged(sudden: Sequence[Jump], shifts: Sequence[Jump]) -> list[Jump]:
    """Both kinds, each step once."""
    others = [s for s in shifts if all(abs(s.index - j.index) > WIDE // 2 for j in sudden)]
    return sorted([*sudden, *others], key=lambda j: j.index)


def _steps(compared: Compared, beside: Beside) -> list[Doubt]:
    """Single wild readings, and steps up and down again."""
    channel = beside.channel
    noise = float(max(measured_noise(beside), channel.deviation, channel.quantum / np.sqrt(12.0)))
    if len(channel.values) < 32 or not noise > 0.0:
        return []
    residual = _residual(beside)
    tests = float(len(residual) * len(compared.channels))
    wild = _wild(residual, noise, tests)
    for index in np.flatnonzero(wild):
        wild[index] = not _at_switch(compared, channel.times, int(index))
    clean = residual.copy()
    clean[wild] = np.interp(channel.times[wild], channel.times[~wild], residual[~wild])
    found = [_wild_doubt(compared, beside, residual - clean, wild, noise)] if wild.any() else []
    both = _merged(jumps(clean, noise, 2.0 * tests), level_shifts(clean, noise, 2.0 * tests))
    every = [j for j in both if not _at_switch(compared, channel.times, j.index)]
    calm = channel.values.copy()
    calm[wild] = np.interp(channel.times[wild], channel.times[~wild], calm[~wild])
    return found + _stretches(compared, beside, every, noise, calm)


def _residual(beside: Beside) -> Array:
    """Readings less what a recalibrated simulation explains, at every sample: steps at switches are gone."""
    channel = beside.channel
    if not beside.moves:
        return channel.values
    if len(beside.pick) == len(channel.values):
        return explained(beside, beside).residual
    return explained(replace(beside, pick=np.arange(len(channel.values))), beside).residual


def _wild(residual: Array, noise: float, tests: float) -> AnyArray:
    """Readings far from the cubic through two neighbours on each side, where that and their line agree."""
    found = np.zeros(len(residual), dtype=bool)
    line = 0.5 * (residual[1:-3] + residual[3:-1])
    cubic = (-residual[:-4] + 8.0 * line - residual[4:]) / 6.0
    off = residual[2:-2] - cubic
    curved = np.maximum(np.abs(cubic - line), np.abs(residual[3:-1] - residual[1:-3]))
    limit = far(off, noise * np.sqrt(1.0 + 34.0 / 36.0), tests, 2)
    found[2:-2] = (np.abs(off) > limit) & (np.abs(off) > 4.0 * curved)
    return found


def _wild_doubt(compared: Compared, beside: Beside, off: Array, wild: AnyArray, noise: float) -> Doubt:
    channel = beside.channel
    places = np.flatnonzero(wild)
    worst = int(places[np.argmax(np.abs(off[places]))])
    times = channel.times[places]
    count = f"{len(places)} readings are" if len(places) > 1 else "one reading is"
    text = (
        f"{count} far from both neighbours, the farthest at {instant(channel.times[worst])} s by "
        f"{compared.units.text(off[worst], channel.unit)}, {abs(off[worst]) / noise:.3g} times the noise"
    )
    return Doubt(
        compared.recording.title,
        channel.name,
        "sensor",
        text,
        "leave wild readings empty in the table, if they are the logger's",
        False,
        float(times[0]),
        float(times[-1]),
        float(abs(off[worst]) / noise),
    )


def _at_switch(compared: Compared, times: Array, index: int) -> bool:
    """Whether a programme changes within the margin, or within two readings, of an increment."""
    margin = compared.recording.switch_margin
    low, high = times[max(index - 3, 0)] - margin, times[min(index + 2, len(times) - 1)] + margin
    switches = compared.switches()
    return bool(((switches >= low) & (switches <= high)).any())


def _fastest(values: Array, steps: Sequence[Jump]) -> float:
    """Largest change from one reading to the next beside all steps, at least the smallest that is written down."""
    changes = np.abs(np.diff(values))
    kept = np.ones(len(changes), dtype=bool)
    for step in steps:
        kept[max(step.index - 2, 0) : step.index + 1] = False
    return float(np.max(changes[kept], initial=0.0)) or float(np.min(changes[changes > 0.0], initial=np.inf))


def _stretches(compared: Compared, beside: Beside, every: Sequence[Jump], noise: float, calm: Array) -> list[Doubt]:
    """Steps that are undone later, and, of a temperature, steps that stay.

    Args:
        compared: A recording beside its simulation.
        beside: The channel.
        every: Its steps.
        noise: Standard deviation of a reading.
        calm: The readings without single wild ones, shape (samples,).
    """
    channel = beside.channel
    is_body = channel.unit == "K"  # a heat capacity does not step there and back; currents and positions may
    left = list(every)
    found, stays = [], []
    while left:
        first = left.pop(0)
        # both sizes are differences of two readings less means of neighbours
        slack = normal_beyond(LEVEL) * noise * np.sqrt(2.0 * 2.0 * (1.0 + 1.0 / (2 * SIDE))) + 0.1 * abs(first.size)
        back = next((j for j in left if abs(j.size + first.size) < slack), None)
        if back is not None:
            left.remove(back)
            if back.index - first.index < SIDE:  # too short for a fault with begin and end: wild readings
                continue
            begin, end = float(channel.times[first.index]), float(channel.times[back.index - 1])
            text = (
                f"from {instant(begin)} to {instant(end)} s the readings stand "
                f"{compared.units.text(first.size, channel.unit)} "
                f"{'higher' if first.size > 0 else 'lower'}, with a step at both ends within one reading"
            )
            remedy = "leave this stretch empty in the table, or correct it; look at plug and amplifier"
            found.append((text.replace("stand -", "stand "), remedy, begin, end, min(first.z, back.z)))
        elif min(first.index, len(channel.values) - first.index) >= SIDE:  # else wild readings at an end
            stays.append(first)
    fastest = _fastest(calm, every)  # it may change as fast as it does elsewhere
    stays = [j for j in stays if is_body and abs(j.size) > FASTER * fastest]
    if stays:
        worst = max(stays, key=lambda j: j.z)
        begin, end = float(channel.times[worst.index]), float(channel.times[-1])
        more = f" (the largest of {len(stays)} steps)" if len(stays) > 1 else ""
        text = (
            f"at {instant(begin)} s the readings step by {compared.units.text(worst.size, channel.unit)} from one "
            f"reading to the next{more}, {abs(worst.size) / fastest:.2g} times as much as anywhere else but at "
            f"single wild readings"
        )
        found.append((text, "was the sensor moved or knocked off? Use `begin` and `end`", begin, end, worst.z))
    return [
        Doubt(compared.recording.title, channel.name, "sensor", text, remedy, is_body, begin, end, z)
        for text, remedy, begin, end, z in found
    ]
