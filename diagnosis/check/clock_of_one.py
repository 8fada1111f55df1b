"""A clock that is off in one recording alone, seen beside the other recordings.

A number that is off or a law that is missing may move a response in time, but it does so in every recording. Where
the scenario meets a channel in the other recordings and, by a straight line from its clock to that of the scenario,
in this one too, its clock is off. A resonance that moves with its amplitude does the same to all channels of a
recording that is driven harder than the others, or that moves freely by another size: none such is reported. A sensor
that answers more slowly in one recording makes its readings late as well: what explains more of them is reported, or
both.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, minimize_scalar

from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import independent
from diagnosis.check.jump import INSTANTS, SIZES, Jump, best_jump, offsets
from diagnosis.check.timing import percent, resolution
from diagnosis.judge.diagnosis import Doubt
from diagnosis.report.display import instant

#: Share of a channel's variance that the scenario leaves at most where it meets it, all numbers as they are.
MET = 0.05
#: How many times more it leaves of the one whose clock is off, and by how many times that clock worsens the others.
TIMES, WORSE = 4.0, 2.0
#: Shares of the readings that count, least misfits first: at a switch a reading is of one side or the other, and moves
#: there by a hair. Of what follows its input at once a clock moves readings at switches alone, so that then all count.
COUNTED = (0.95, 1.0)
#: How far a clock may be off at either end, as a share of the readings' duration, and most offsets tried at each end.
LONGEST, MOST_OFFSETS = 0.03, 121
#: Other recordings that have to be met: of two, either may be the odd one.
OTHERS = 2
#: Range of a simulated channel in a recording, beside the largest of the others, up to which none is driven harder.
HARDER = 1.1
#: Changes of inputs from which a straight line of offsets is no row of theirs, and constant shifts that are compared.
CHANGES, SHIFTS = 4, 41
#: What recordings are compared with.
AS_IT_IS, RECALIBRATED = "the scenario as it is", "the scenario with its numbers fitted"
#: Smallest and largest jump that is tried, in how far the straight line of offsets is off.
ABOUT = (0.2, 2.0)
#: Standard normal quantile of 97.5 %.
_QUANTILE = 1.959964
#: Lags that are tried, as shares of the readings' duration: a lag moves less than a clock that is off by as much, so
#: that longer ones are. -2 log likelihood by which a lag and a clock are told apart: one of 20,000 by chance.
LAGS, APART = tuple(np.geomspace(3e-5, 0.3, 33).tolist()), 20.0


@dataclass(frozen=True)
class _Clock:
    """A channel's clock, positive where it shows a later time.

    Args:
        offset: In the middle of its readings [s].
        rate: By how much of each of its own seconds it is farther ahead, 1.
        spread: 95 % of the rate are within so much of it, 1.
        left: Share of the variance that the scenario leaves of the channel then.
        half: Half of the time from the first reading to the last [s].
        counted: Share of the readings that count for what is left.
    """

    offset: float
    rate: float
    spread: float
    left: float
    half: float
    counted: float

    @property
    def is_rate(self) -> bool:
        """Whether it runs wrong, and is not only ahead or behind: what it has at the begin is less than what comes."""
        at_begin = self.offset - self.rate * self.half
        return abs(self.rate) > self.spread and abs(at_begin) < abs(self.rate) * self.half

    def moves(self, beside: Beside) -> Array:
        """Offsets of the readings of any recording, if its clock were off like this one [s]."""
        if self.is_rate:
            return self.rate * _since(beside)
        return np.full(len(beside.times), self.offset)

    def rest(self, beside: Beside) -> Array:
        """What it leaves of any recording of the channel, SI."""
        return _rest(beside, self.moves(beside))

    def is_beyond(self, one: Compared, beside: Beside, row: float) -> bool:
        """Whether it is farther off than readings and rows of inputs leave open, the latter [s]."""
        within = resolution(one, beside.channel) + row
        return float(np.abs(self.moves(beside)).max()) > within or _drifts(one, beside, self, within)

    def in_words(self) -> str:
        """What is off."""
        if self.is_rate:
            # its own seconds are counted, of which 1 + r are one where it runs r too fast
            rates = [self.rate + side * self.spread for side in (-1.0, 0.0, 1.0)]
            low, middle, high = sorted(100.0 * abs(rate / (1.0 - rate)) for rate in rates)
            way = "fast" if self.rate > 0.0 else "slow"
            told = f"that runs {middle:.3g} % too {way} ({low:.3g} to {high:.3g} %, 95 %)"
        else:
            told = f"that is {instant(abs(self.offset), 3)} s {'ahead' if self.offset > 0.0 else 'behind'}"
        return f"{percent(1.0 - self.left)} with a clock {told}"


def clocks_of_one(every: Sequence[Compared], simulated: str = AS_IT_IS) -> list[Doubt]:
    """Doubts about the clock of a channel in one recording; all are serious.

    Args:
        every: Recordings beside their simulations.
        simulated: What was simulated, for people.
    """
    found = []
    for one in every:
        others = [o for o in every if o is not one]
        if len(others) >= OTHERS:
            found += list(_of_recording(one, others, simulated))
    return found


def _of_recording(one: Compared, others: Sequence[Compared], simulated: str) -> Iterator[Doubt]:
    told: set[str] = set()
    for counted in COUNTED:
        found = [d for d in _by_share(one, others, simulated, counted) if d.subject not in told]
        told |= {d.subject for d in found}
        yield from found


def _by_share(one: Compared, others: Sequence[Compared], simulated: str, counted: float) -> Iterator[Doubt]:
    """Doubts by such a share of the readings."""
    own = {name: _left(b, counted) for name, b in one.channels.items() if _is_told(b)}
    for name, left in own.items():
        beside = one.channels[name]
        same = [o.channels[name] for o in others if name in o.channels and _is_told(o.channels[name])]
        usual = [_left(b, counted) for b in same]
        if len(usual) < OTHERS or max(usual) > MET or left < max(TIMES * max(usual), _noise(beside)):
            continue
        # what the scenario lacks of the rig shows in other channels more than a clock does in this one
        if _deviations(beside, counted) < _elsewhere(name, others, counted):
            continue
        # other channels of the rig that are met say that it is not the rig
        is_alone = any(n != name and v <= MET for n, v in own.items())
        ranges = [float(np.ptp(b.simulated_there)) / float(np.ptp(beside.simulated_there)) for b in same]
        if not is_alone and max(ranges) < 1.0 / HARDER:
            continue
        # how fast a motion is that nothing drives depends on its size, and so does what a missing law does to it
        if not is_alone and not len(one.switches()) and not any(1.0 / HARDER <= r <= HARDER for r in ranges):
            continue
        clock = _clock(beside, counted)
        every = (clock, _jumped(beside, clock, counted), _lag(beside, counted))
        found = [r for r in every if r is not None and TIMES * r.left <= left and r.left <= MET]
        told_apart = _best(beside, found)
        if any(isinstance(r, _Lag) and r.is_open for r in told_apart):
            continue  # something is slower than any sensor that is asked for
        # rows that were written late move all that follows their input, and not one channel alone
        row = 0.0 if is_alone and len(one.switches()) >= CHANGES else _row(one)
        # what the others do not notice may be theirs too: a number that is off shows most where a run is long
        if not told_apart or not all(
            r.is_beyond(one, beside, row) and sum(_left_of(b, r.rest(b), counted) for b in same) >= WORSE * sum(usual)
            for r in told_apart
        ):
            continue
        counts = f"of the {100.0 * counted:.0f} % of its readings that {simulated} misses least, it"
        told = (
            f"{counts if counted < 1.0 else simulated} explains at least {percent(1.0 - max(usual))} of the variance "
            f"of {name} in each other recording that shows it and "
            f"{percent(max(1.0 - left, 0.0))} in this one, but {{}}"
        )
        z = float(np.sqrt(left / max(min(r.left for r in told_apart), _noise(beside))))
        kind, text, remedy = _in_words(told_apart)
        if counted == 1.0:  # what steps with its input tells a time no better than it is read
            text += f", told by readings {instant(float(np.median(np.diff(beside.times))), 2)} s apart"
        yield Doubt(one.recording.title, name, kind, told.format(text), remedy, True, one.begin, one.end, z)


def _best(beside: Beside, found: Sequence[_Reason]) -> list[_Reason]:
    """Those that explain the readings as well as the best, by what they leave and as many as are independent."""
    if not found:
        return []
    count = min(independent(r.rest(beside)) for r in found)
    weights = [count * float(np.log(r.left + _noise(beside))) for r in found]
    return [r for r, weight in zip(found, weights) if weight <= min(weights) + APART]


def _in_words(found: Sequence[_Reason]) -> tuple[str, str, str]:
    """Kind of doubt, what explains the readings of one recording, and the remedy: a clock, a slower sensor, or both."""
    clock = "compare two instants that both clocks know, and correct the times of this column's table"
    slower = "what was changed at this sensor (a filter, its mounting)? State its lag (`lag_bound`), or leave it out"
    first, *others = (r.in_words() for r in found)
    is_clock = [isinstance(r, _Clock | _Jumped) for r in found]
    if others:
        text = f"{', '.join((first, *others[:-1]))}, and {others[-1]}: the{' two' if len(found) == 2 else 'se'} "
        text += "cannot be told apart"
        return ("clock", text, clock) if all(is_clock) else ("late", text, f"{clock}; or {slower}")
    if is_clock[0]:
        return "clock", first, clock
    return "sensor", f"{first}: the sensor answered more slowly than in the others", slower


@dataclass(frozen=True)
class _Lag:
    """A channel behind a first-order lag.

    Args:
        lag: Time constant [s].
        left: Share of the variance that it leaves of the channel.
        is_open: Whether it is the longest that is tried: a longer one may leave less.
    """

    lag: float
    left: float
    is_open: bool = False

    def rest(self, beside: Beside) -> Array:
        """What it leaves of any recording of the channel, SI."""
        return np.asarray(beside.measured - beside.behind(self.lag))

    def is_beyond(self, one: Compared, beside: Beside, row: float) -> bool:
        """Whether it is longer than what is stated and readings and rows of inputs leave open, the latter [s]."""
        return self.lag > beside.channel.lag_bound + resolution(one, beside.channel) + row

    def in_words(self) -> str:
        """What is off."""
        return f"{percent(1.0 - self.left)} behind a lag of {instant(self.lag, 3)} s"


@dataclass(frozen=True)
class _Jumped:
    """A channel's clock that is right at first.

    Args:
        jump: From when on, and by how much it shows a later time.
        since: Begin of the readings [s].
        left: Share of the variance that the scenario leaves of the channel then.
    """

    jump: Jump
    since: float
    left: float

    def moves(self, beside: Beside) -> Array:
        """Offsets of the readings of any recording, if its clock jumped as long after its begin [s]."""
        return offsets(_since(beside), self.jump.size, self.jump.at - self.since)

    def rest(self, beside: Beside) -> Array:
        """What it leaves of any recording of the channel, SI."""
        return _rest(beside, self.moves(beside))

    def is_beyond(self, one: Compared, beside: Beside, row: float) -> bool:
        """Whether it is farther off than readings and rows of inputs leave open, the latter [s]."""
        return abs(self.jump.size) > resolution(one, beside.channel) + row

    def in_words(self) -> str:
        """What is off."""
        return f"{percent(1.0 - self.left)} if {self.jump.in_words()}"


#: What may make the readings of one recording late or early.
_Reason = _Clock | _Jumped | _Lag


def _jumped(beside: Beside, clock: _Clock | None, counted: float) -> _Jumped | None:
    """The jump that leaves least of a channel; None where no clock is off, or where it is at an end of the readings."""
    if clock is None:
        return None
    about = float(np.abs(clock.moves(beside)).max())
    if not about:  # no clock makes it better
        return None
    begin, end = float(beside.times[0]), float(beside.times[-1])

    def squares(jumps: Array) -> Array:
        return np.array([float(np.sum(_rest(beside, offsets(beside.times, size, at)) ** 2)) for size, at in jumps])

    found = best_jump(begin, end, about * np.geomspace(*ABOUT, SIZES), squares)
    apart = (end - begin) / (INSTANTS + 1)
    if not begin + apart < found.at < end - apart:
        return None
    return _Jumped(found, begin, _left(beside, counted, offsets(beside.times, found.size, found.at)))


def _lag(beside: Beside, counted: float) -> _Lag | None:
    """The first-order lag that leaves least of a channel; None where that is the shortest tried."""
    tried = [float(np.ptp(beside.times)) * share for share in LAGS]
    left = [_left_of(beside, beside.measured - beside.behind(lag), counted) for lag in tried]
    best = int(np.argmin(left))
    if best == 0:
        return None
    if best == len(tried) - 1:
        return _Lag(tried[best], left[best], is_open=True)
    ends = float(np.log(tried[best - 1])), float(np.log(tried[best + 1]))
    finer = minimize_scalar(
        lambda x: _left_of(beside, beside.measured - beside.behind(float(np.exp(x))), counted),
        bounds=ends,
        method="bounded",
    )
    return _Lag(float(np.exp(finer.x)), float(finer.fun))


def _drifts(one: Compared, beside: Beside, clock: _Clock, within: float) -> bool:
    """Whether a clock runs wrong by more than any constant shift explains that is no doubt.

    What a reading or a row of an input leaves open is one shift, or another one at each change of the input: a straight
    line follows a few of them, and is another thing from `CHANGES` on.

    Args:
        one: The recording.
        beside: Its channel.
        clock: The straight line of offsets.
        within: Shifts up to which are no doubt [s].
    """
    if not clock.is_rate or (_row(one) > 0.0 and len(one.switches()) < CHANGES):
        return False
    shifts = np.linspace(-within, within, SHIFTS)
    constant = min(_left(beside, clock.counted, np.full(len(beside.times), s)) for s in shifts)
    return constant > TIMES * max(clock.left, _noise(beside))


def _row(one: Compared) -> float:
    """Longest time between two rows of an input that holds its values [s]: it changed somewhere within it."""
    rows = [c.times for c in one.courses if c.is_recorded and not c.is_linear and len(c.times) > 1]
    return max((float(np.median(np.diff(times))) for times in rows), default=0.0)


def _is_told(beside: Beside) -> bool:
    """Whether a channel moves so much more than its noise that a twentieth of its variance is no noise."""
    return beside.is_comparable and beside.moves and float(np.var(beside.measured)) > (10.0 * beside.floor) ** 2


def _since(beside: Beside) -> Array:
    return np.asarray(beside.times - beside.times[0])


def _left(beside: Beside, counted: float, offsets: Array | None = None) -> float:
    """Share of a channel's variance that the scenario leaves, with its clock off by so much at each reading."""
    return _left_of(beside, _rest(beside, offsets), counted)


def _rest(beside: Beside, offsets: Array | None) -> Array:
    """What the scenario leaves of a channel, with its clock off by so much at each reading, SI."""
    return np.asarray(beside.measured - beside.at(beside.times if offsets is None else beside.times - offsets))


def _left_of(beside: Beside, rest: Array, counted: float) -> float:
    """Share of a channel's variance that is left, of what some description of its readings leaves."""
    return max(_mean_square(rest, counted) - beside.floor**2, 0.0) / float(np.var(beside.measured))


def _mean_square(rest: Array, counted: float) -> float:
    """Of such a share of the misfits, the least ones first."""
    return float(np.mean(np.sort(rest**2)[: int(np.ceil(counted * len(rest)))]))


def _deviations(beside: Beside, counted: float) -> float:
    """Root mean square of what the scenario leaves of a channel, in deviations of its noise."""
    size = float(np.sqrt(_mean_square(_rest(beside, None), counted)))
    return size / beside.floor if beside.floor > 0.0 else float("inf")


def _elsewhere(name: str, others: Sequence[Compared], counted: float) -> float:
    """Most that the scenario leaves of any other channel in the other recordings, in deviations of its noise."""
    channels = (b for o in others for n, b in o.channels.items() if n != name and _is_told(b) and b.floor > 0.0)
    return max((_deviations(b, counted) for b in channels), default=0.0)


def _noise(beside: Beside) -> float:
    """Share of a channel's variance that is noise."""
    return float(beside.floor**2 / np.var(beside.measured))


def _clock(beside: Beside, counted: float) -> _Clock | None:
    """The straight line of offsets that leaves least; None where that is at an end of what is tried."""
    span, since = float(np.ptp(beside.times)), _since(beside)
    speed = float(np.sqrt(np.mean((np.diff(beside.simulated_there) / np.diff(beside.times)) ** 2)))
    longest = LONGEST * span
    # half the time in which the channel moves by its deviation: the least is found from there
    step = max(0.5 * float(np.std(beside.simulated_there)) / speed, 2.0 * longest / MOST_OFFSETS)
    count = int(longest / step)
    tried = step * np.arange(-count, count + 1) if count else np.array([-longest, 0.0, longest])
    weights = np.column_stack([1.0 - since / span, since / span])

    def misfit(ends: Array) -> Array:
        return _rest(beside, weights @ ends)

    squares = [(float(np.sum(misfit(np.array([a, b])) ** 2)), a, b) for a in tried for b in tried]
    _, *start = min(squares)
    fitted = least_squares(misfit, start, bounds=(-longest - step, longest + step), x_scale=step)
    if np.abs(fitted.x).max() > longest:
        return None
    scatter = float(np.mean(fitted.fun**2)) * len(since) / independent(fitted.fun)
    jacobian: Array = np.asarray(fitted.jac)
    spread = np.linalg.pinv(jacobian.T @ jacobian) * scatter
    slope = np.array([-1.0, 1.0]) / span
    deviation = float(np.sqrt(slope @ spread @ slope))
    left = _left(beside, counted, weights @ fitted.x)
    return _Clock(float(fitted.x.mean()), float(slope @ fitted.x), _QUANTILE * deviation, left, 0.5 * span, counted)
