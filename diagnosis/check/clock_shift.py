"""A clock that is seconds off, or runs wrong, on a slow rig: by likelihood, what a rig may have of itself profiled.

Each channel is its simulated course, moved by a shift or a rate that all channels share, behind a lag of its own
sensor, with two longer lags of any sign beside it (heat capacities and losses that are off), a level, a smooth
discrepancy and noise (`diagnosis.check.discrepancy`). A lag makes a response later too: a shift is reported only
where no lag explains as much.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared, direct, lagged
from diagnosis.check.discrepancy import Likelihoods, Thinned, likelihoods, thin
from diagnosis.check.explain import explained, explains
from diagnosis.check.jump import offsets
from diagnosis.check.late_input import gain_of_late_input
from diagnosis.check.quantiles import chi_square_beyond
from diagnosis.check.timing import critical, leading
from diagnosis.recording.series import sample

#: Longest shift that is tried, as a share of the recording; longer ones move the whole response
#: (`diagnosis.check.timing`).
LONGEST = 0.1
#: Shifts each way, and lags of a sensor; the longer ones are tried twice in series too (a mass before the sensor).
SHIFTS, LAGS = 9, 9
#: Lags beside the course that stand for wrong time constants, as shares of the recording.
SLOWER = (0.05, 0.2)
#: Channels that are asked; more of one rig share its clock.
MOST_CHANNELS = 2
#: Share of its range by which a course turns over: less is rounding, or a ripple of a solver.
TURN = 0.02
#: Instants at which an event is tried.
EVENTS = 100
#: Share of variance from which a response draws nearly all of the readings: what the model does not draw moves a
#: response in time by more than clocks are off where it is a twentieth of it.
DRAWN = 0.95
#: Gain from which a second channel supports a move that is decided by all together: one of 20 by chance.
SUPPORT = chi_square_beyond(0.05, 1)


@dataclass(frozen=True)
class Timed:
    """-2 log likelihood of one channel.

    Args:
        deviance: Smallest over ratios, shape (moves, lags).
        fits: Of every move with every lag, moves first.
        centres: Times of the blocks [s].
    """

    deviance: Array
    fits: Likelihoods
    centres: Array

    def steps(self, without: int, move: int) -> Array:
        """Gain of each block by a move over another one, both with their best lag, shape (blocks,)."""
        lags = self.deviance.shape[1]
        first, second = (k * lags + int(np.argmin(self.deviance[k])) for k in (without, move))
        return self.fits.gain_by_block(first, second)


@dataclass(frozen=True)
class Shift:
    """What the readings say about the clock.

    Args:
        size: Most probable shift, positive where the response comes later [s].
        interval: Where the likelihood is within the 95 % quantile of chi-square [s].
        lag: Most probable lag of the slowest sensor without a shift [s].
        gained: What the shift gains over every lag without a shift.
        alone: What the shift alone gains over nothing.
        rival: How much better the best lag alone is than the best shift alone.
        spread: `gained` without the stretch between two switches that says most for it.
        is_common: Whether two channels or more are off, each by itself, and none by something else: a clock that is off
            moves all readings alike. What one channel alone shows may be a fault of its own.
        rate: 1 / length of the recording where it is no shift but a clock that runs wrong [1/s]; else 0.
    """

    size: float
    interval: tuple[float, float]
    lag: float
    gained: float
    alone: float
    rival: float
    spread: float
    is_common: bool
    rate: float = 0.0

    @property
    def is_rate(self) -> bool:
        """Whether the clock runs wrong; `size` is then what it is off at the end."""
        return self.rate > 0.0

    @property
    def percent(self) -> float:
        """How wrong a clock runs [%]."""
        return 100.0 * self.rate * abs(self.size)


def asked(compared: Compared) -> list[Beside]:
    """Channels that tell the time best: temperatures and flows, and outputs of a component that follow its inputs.

    A level or a position may follow its inputs as they do. One that swings by itself says nothing of a clock: a
    frequency that is a little off moves its readings as a clock does.
    """
    found = [
        b
        for b in leading(compared)
        if b.channel.target.domain in ("thermal", "electrical")
        or (b.channel.target.is_component and not swings(compared, b))
    ]
    step = max(1, -(-len(found) // MOST_CHANNELS))
    return found[::step]


def swings(compared: Compared, beside: Beside) -> bool:
    """Whether the simulated channel turns more often than all that drives it.

    What follows its inputs through lags and integrators in series, none of them complex, cannot: such kernels diminish
    variation. Schoenberg, J. Anal. Math. 1 (1951) 331-374.
    """
    assert beside.simulated is not None
    inside = (beside.simulated.times >= compared.begin) & (beside.simulated.times <= compared.end)
    driven = sum(turns(c.at(beside.simulated.times[inside])) for c in compared.courses)
    # the course begins anywhere: an equilibrium that is left may add one turn for each state, two here
    return turns(beside.simulated.values[inside]) > driven + 2


def turns(values: Array) -> int:
    """How often a course turns over, by more than `TURN` of its range."""
    least = TURN * float(np.ptp(values)) if len(values) else 0.0
    if not least > 0.0:
        return 0
    count, way, extreme = 0, 0, float(values[0])
    for value in values:
        step = (value - extreme) * (way or 1)
        if way == 0 and abs(value - values[0]) > least:
            way, extreme = (1 if value > values[0] else -1), float(value)
        elif way and step > 0.0:
            extreme = float(value)
        elif way and step < -least:
            count, way, extreme = count + 1, -way, float(value)
    return count


def clock_shift(compared: Compared) -> Shift | None:
    """The shift of a recording's clock; None where nothing is driven, or nothing follows it."""
    leads = asked(compared)
    if not leads or not len(compared.switches()):
        return None
    span = compared.end - compared.begin
    least = reading_step(leads)
    longest = LONGEST * span
    if not longest > 4.0 * least:
        return None
    sizes = np.geomspace(least, longest, SHIFTS)
    shifts = np.concatenate([-sizes[::-1], [0.0], sizes])
    lags = lag_grid(least, longest)
    scale = np.array([[1.0, 0.0], [0.0, 1.0 / span]])  # a shift, and a rate that comes to as much at the end
    found = [_along(compared, leads, shifts, lags, unit) for unit in scale]
    known = [f for f in found if f is not None]
    return max(known, key=lambda f: f.gained) if known else None


def reading_step(leads: list[Beside]) -> float:
    """Time between two readings of the channel that is read most often [s]."""
    return min(float(np.median(np.diff(b.channel.times))) for b in leads)


def lag_grid(least: float, longest: float) -> Array:
    """Lags of a sensor that are tried [s]: none, one from `least` on, and, negative by convention, the same twice."""
    once = np.geomspace(0.5 * least, longest, LAGS)
    return np.concatenate([[0.0], once, -once[LAGS // 3 :: 2]])


def _along(compared: Compared, leads: list[Beside], sizes: Array, lags: Array, unit: Array) -> Shift | None:
    """Shifts alone, or rates alone; None where the best lies beyond what is tried: `timing` asks for such."""
    coarse = _total(leads, sizes[:, None] * unit, lags)[0]
    best = int(np.argmin(coarse[:, 1]))
    near = sizes[max(best - 1, 0)], sizes[min(best + 1, len(sizes) - 1)]
    if not near[0] < sizes[best] < near[1]:
        return None
    fine = np.unique(np.concatenate([np.linspace(*near, 13), [0.0]]))
    sums, timed, slow = _total(leads, fine[:, None] * unit, lags)
    profile = sums[:, 1]
    zero = int(np.flatnonzero(fine == 0.0)[0])
    top = int(np.argmin(profile))
    inside = fine[profile < profile[top] + chi_square_beyond(0.05, 1)]
    step = float(near[1] - near[0]) / 12.0
    alone = coarse[:, 0]
    return Shift(
        float(fine[top]),
        (float(inside.min()) - step, float(inside.max()) + step),
        float(slow[zero]),
        float(profile[zero] - profile[top]),
        float(alone[SHIFTS] - alone.min()),
        float(alone.min() - coarse[SHIFTS, 1]),
        spread_gain(compared, timed, zero, top),
        _is_common([t.deviance.min(axis=1) for t in timed], zero, top),
        float(unit[1]),
    )


def _is_common(profiles: list[Array], zero: int, top: int) -> bool:
    """Whether two channels or more ask for a move, and none of them for another one.

    Args:
        profiles: -2 log likelihood of each channel along the moves, shape (moves,) each.
        zero: Number of no move.
        top: Number of the move that all together ask for.
    """
    asking = [p[zero] - p[top] > SUPPORT for p in profiles]
    agreeing = [p[top] - p.min() < critical(1.0) for p in profiles]
    return sum(asking) > 1 and all(agreeing)


def _total(leads: list[Beside], moves: Array, lags: Array) -> tuple[Array, list[Timed], Array]:
    """Sum over channels: shape (moves, 2), the columns without a lag and with each channel's best; and the parts.

    The third is the largest best lag of any channel at each move [s].
    """
    timed = timed_channels(leads, moves, lags)
    plain = np.sum([t.deviance[:, 0] for t in timed], axis=0)
    free = np.sum([t.deviance.min(axis=1) for t in timed], axis=0)
    slow = np.max([np.abs(lags)[t.deviance.argmin(axis=1)] for t in timed], axis=0)
    return np.stack([plain, free], axis=1), timed, slow


def event_gain(compared: Compared) -> float:
    """What an event gains in -2 log likelihood: from some instant on every channel responds by another size.

    A coil that opens, or a heater that gives less, moves a response by as much as a clock does that is off.
    """
    instants = np.linspace(compared.begin, compared.end, EVENTS + 2)[1:-1]
    return _gain_of(compared, lambda times, course: [_after(times, course, t) for t in instants])


def direct_gain(compared: Compared) -> float:
    """What sensors gain in -2 log likelihood that answer the inputs at once, beside what the body does."""
    return _gain_of(compared, lambda times, course: [direct(compared, times)])


def growth_gain(compared: Compared, is_late: bool = False) -> float:
    """What a response, of the body or of a sensor, gains that grows or fades steadily: a drift, wear, an input's too.

    Seen beside the course it moves as one does whose clock runs wrong.

    Args:
        compared: The recording.
        is_late: Whether it is asked beside a response that comes late: what answers an input at once comes early.
    """

    def of_the_body(times: Array, course: Array) -> list[Array]:
        share = _share(times)
        return [np.array([course * share, course * share**2])]

    def of_the_inputs(times: Array, course: Array) -> list[Array]:
        inputs = direct(compared, times)
        return [np.concatenate([inputs, inputs * _share(times)])]

    by_body = _gain_of(compared, of_the_body)
    return by_body if is_late else max(by_body, _gain_of(compared, of_the_inputs))


def input_gain(compared: Compared, found: Shift) -> float:
    """What one input gains that is late or early by itself: a dead time, or a clock of its logger.

    The only input that moves is no rival of a clock that is off, which moves all readings as it does; it is one of a
    clock that runs wrong.
    """
    if not found.is_rate and sum(np.ptp(c.values) > 0.0 for c in compared.courses) < 2:
        return -np.inf
    leads = asked(compared)
    lags = lag_grid(reading_step(leads), LONGEST * (compared.end - compared.begin))
    stays = np.zeros((1, 2))
    return gain_of_late_input(compared, leads, lambda b: float(timed_channel(b, stays, lags).deviance.min()))


def _share(times: Array) -> Array:
    """Share of a recording that is over, 0 to 1."""
    return np.asarray((times - times[0]) / max(float(times[-1] - times[0]), 1e-300))


def _gain_of(compared: Compared, beside_course: Callable[[Array, Array], list[Array]]) -> float:
    """The most that columns beside each channel's course gain, the same set for all channels.

    Args:
        compared: The recording.
        beside_course: Times of a channel and its course to sets of columns, shape (columns, readings) each.
    """
    totals = []
    for beside in asked(compared):
        at = thinned(beside)
        plain = _columns(beside, at.times, np.zeros((1, 2)), np.zeros(1))
        sets = np.array([np.concatenate([plain[0], more]) for more in beside_course(at.times, plain[0, 0])])
        without, by_set = (_likelihoods(beside, at, c).deviance for c in (plain, sets))
        totals.append(without.min() - by_set)
    return float(np.sum(totals, axis=0).max())


def _after(times: Array, course: Array, instant: float) -> Array:
    """The course from an instant on, at once and as slow bodies follow it, shape (1 + lags, readings)."""
    part = course * (times >= instant)
    span = float(times[-1] - times[0])
    return np.array([part, *(lagged(times, part, share * span) for share in SLOWER)])


def thinned(beside: Beside) -> Thinned:
    """Readings of a channel that are not at a limit."""
    inside = ~beside.channel.is_clipped
    return thin(beside.channel.times[inside], beside.channel.values[inside])


def order(beside: Beside) -> int:
    """2 where a body's heat capacity, inertia or volume leaves kinks of a switch, 1 where steps are left of it."""
    return 1 if beside.channel.target.domain in ("electrical", "stiffness") else 2


def moved_shares(leads: Sequence[Beside], moved: Callable[[Array], Array]) -> list[tuple[float, float]]:
    """Share of variance that the response explains of each channel, as it is and moved.

    Args:
        leads: The channels.
        moved: Times of readings to those of the response [s].
    """
    return [(explained(b, b).share, explained(b, b, moved(b.times)).share) for b in leads]


def is_drawn(shares: Sequence[tuple[float, float]]) -> bool:
    """Whether the moved response draws nearly all of the readings, or the move takes away most of what is left.

    Of a rig that responds faster than its model, a resonance that is higher, say, a shift takes away a little, by a
    likelihood that no lag reaches, and leaves a lot.
    """
    own, moved = (float(np.median(s)) for s in zip(*shares))
    return moved > DRAWN or explains(own, moved)


def timed_channels(leads: list[Beside], moves: Array, lags: Array) -> list[Timed]:
    """Likelihood of every channel, see `timed_channel`."""
    return [timed_channel(b, moves, lags) for b in leads]


def timed_channel(beside: Beside, moves: Array, lags: Array) -> Timed:
    """Likelihood of a channel for each move of its course and each lag.

    Args:
        beside: The channel, and the course that explains it.
        moves: Shift [s] and rate of the readings' clock, and how far it jumps [s] and when [s] where they have that,
            shape (moves, 2 or 4).
        lags: Of its sensor, as `lag_grid` gives them.
    """
    at = thinned(beside)
    fits = _likelihoods(beside, at, _columns(beside, at.times, moves, lags))
    return Timed(fits.deviance.reshape(len(moves), len(lags)), fits, at.centres)


def _likelihoods(beside: Beside, at: Thinned, columns: Array) -> Likelihoods:
    """Of sets of columns at a channel's thinned readings, shape (sets, columns, readings)."""
    return likelihoods(at, columns, order(beside), beside.channel.deviation)


def _columns(beside: Beside, times: Array, moves: Array, lags: Array) -> Array:
    """Courses that explain a channel, shape (moves * lags, columns, readings)."""
    series = beside.simulated
    assert series is not None
    span = float(times[-1] - times[0])
    scale = max(float(np.std(series.values)), 1e-300)
    every = []
    for lag in lags:
        own = lagged(series.times, series.values, abs(float(lag))) if lag else series.values
        if lag < 0.0:
            own = lagged(series.times, own, -float(lag))
        slower = [lagged(series.times, own, share * span) for share in SLOWER]
        every.append([own, *slower])
    found = np.empty((len(moves), len(lags), 1 + len(SLOWER), len(times)))
    for i, (shift, rate, *jump) in enumerate(moves):
        when = (times - shift) / (1.0 + rate)
        if jump:
            when = when - offsets(times, *jump)
        for j, rows in enumerate(every):
            found[i, j, 0] = sample(series, when) if not lags[j] else np.interp(when, series.times, rows[0])
            for n, row in enumerate(rows[1:]):
                found[i, j, n + 1] = np.interp(when, series.times, row)
    flat = found.reshape(-1, 1 + len(SLOWER), len(times))
    return np.asarray((flat - flat[..., :1]) / scale)


def spread_gain(compared: Compared, timed: list[Timed], zero: int, top: int) -> float:
    """Gain of all stretches between switches but the one that says most for a shift."""
    ends = compared.switches()
    groups = np.zeros(len(ends) + 1)
    for one in timed:
        np.add.at(groups, np.searchsorted(ends, one.centres), one.steps(zero, top))
    return float(groups.sum() - groups.max())
