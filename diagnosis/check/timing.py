"""Does the response follow this programme: another run's, a late one, a clock that runs wrong, other switches?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from cosim.components import nanoseconds
from cosim.unit.protocol import Array
from diagnosis.check.beside import DISCREPANCY, Beside, Compared, direct
from diagnosis.check.explain import LEVEL, Fit, design, explained, explains, fit, gain
from diagnosis.check.jump import REMEDY, SIZES, TRIED, best_jump, offsets
from diagnosis.check.quantiles import chi_square_beyond, chi_square_tail
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Channel
from diagnosis.recording.series import sample
from diagnosis.report.display import instant

#: Channels of one recording that are asked for timing; more of the same rig say the same again.
MOST_CHANNELS = 6
#: Shifts each way and factors on time each way that are tried.
SHIFTS, FACTORS = 24, 16
#: Shifts between the neighbours of the best one that are tried.
FINER = 9
#: Greatest factor on time that is called a drifting clock; beyond it the unit of time is asked for.
FASTEST = 0.3
#: What a clock that is wrong explains, as `Rival.text` has it.
_CORRECTED = ": so corrected, the programme explains {other} of the variance of the readings, as it is {own}"
#: Largest jump of a clock that is tried, as a share of the recording.
FARTHEST = 0.25
#: Bends of a sensor's characteristic that are tried, at quantiles of what it should read.
KNOTS = 8
#: Share of what the programme leaves that switches at free instants leave at most: with a dozen of them any slow course
#: can be drawn, so that they have to explain nearly all of it.
FREE_LEFT = 0.2
#: Instants at which an unknown switch may lie.
INSTANTS = 120

#: Gain in -2 log likelihood, size, and fits of the channels.
_Tried = tuple[float, float, list[Fit]]


@dataclass(frozen=True)
class Rival:
    """Another explanation of a recording's timing.

    Args:
        kind: Of the doubt.
        subject: What it concerns.
        text: What the readings do, in plain words, with `{own}` and `{other}` for shares of variance.
        remedy: What to look at.
        gain: -2 log likelihood gained, after the price of what was chosen.
        own: Share of variance that the recording's own conditions explain, median over channels.
        other: Share that this explanation explains.
    """

    kind: str
    subject: str
    text: str
    remedy: str
    gain: float
    own: float
    other: float


@cache
def critical(tests: float) -> float:
    """Gain that one more degree of freedom reaches by chance in `LEVEL` of recordings, over so many tests.

    Wilks' theorem with Bonferroni's correction; a median over channels exceeds it less often than one channel.
    """
    return chi_square_beyond(LEVEL / tests, 1)


def leading(compared: Compared) -> list[Beside]:
    """Channels that tell the time best: those whose simulation moves, temperatures and flows before positions.

    Extensions, curvature and the like depend on thresholds that a model may miss altogether.
    """
    moving = [b for b in compared.channels.values() if b.moves and len(b.pick) >= 24]
    direct = [b for b in moving if b.channel.target.domain in ("thermal", "electrical")]
    chosen = direct or moving
    step = max(1, -(-len(chosen) // MOST_CHANNELS))
    return chosen[::step]


def timing_doubts(compared: Compared, others: Sequence[Compared]) -> list[Doubt]:
    """At most one doubt: the explanation of the timing that beats the recording's own conditions by most.

    Args:
        compared: The recording.
        others: The other recordings of the same rig.
    """
    leads = leading(compared)
    if not leads or not len(compared.switches()):
        return []
    own = [_own(compared, b) for b in leads]
    rivals = [*_other_runs(compared, others, leads), *_shifts(compared, leads, own), *_factors(compared, leads, own)]
    rivals = [r for r in rivals if r.gain > critical(4.0) and explains(r.own, r.other)]
    if not rivals:
        return []
    best = max(rivals, key=lambda r: r.gain)
    return [_doubt(compared, _or_jump(compared, leads, own, best))]


def switch_doubts(compared: Compared) -> list[Doubt]:
    """At most one doubt: the readings change at other instants than the programme.

    To be asked where no known explanation is found: another run, a clock, exchanged columns, a sign.
    """
    leads = leading(compared)
    if not leads or not len(compared.switches()):
        return []
    found = _switches(compared, leads, [_own(compared, b) for b in leads])
    return [_doubt(compared, r) for r in found if r.gain > critical(4.0) and explains(r.own, r.other, FREE_LEFT)]


def _doubt(compared: Compared, best: Rival) -> Doubt:
    text = best.text.format(own=percent(best.own), other=percent(best.other))
    z = float(np.sqrt(best.gain))
    title, begin, end = compared.recording.title, compared.begin, compared.end
    return Doubt(title, best.subject, best.kind, text, best.remedy, True, begin, end, z)


def percent(share: float) -> str:
    """A share as a person reads it: never 100 % of what is not whole.

    >>> percent(0.99987), percent(0.5), percent(0.0)
    ('99.98 %', '50 %', '0 %')
    """
    if share > 0.99:
        return f"{min(np.floor(1e4 * share) / 100, 99.99):.4g} %"
    return f"{100.0 * share:.2g} %"


def resolution(compared: Compared, channel: Channel) -> float:
    """Shift in time that is no doubt [s]: the bound stated for the clock, a reading, an output and a macro-step."""
    time = compared.scenario.time
    steps = (nanoseconds(time.output_step) + nanoseconds(time.macro_step)) * 1e-9
    return channel.offset_bound + float(np.median(np.diff(channel.times))) + steps


def allowed(compared: Compared, channel: Channel) -> Array:
    """Shifts that are no doubt [s]; later also by the stated lag of the sensor: several lags look like a delay."""
    bound = resolution(compared, channel)
    late = np.linspace(0.0, channel.lag_bound, 9)[1:] if channel.lag_bound else np.zeros(0)
    return np.concatenate([np.linspace(-bound, bound, 5), bound + late])


def within(compared: Compared, beside: Beside, course: Beside, inside: Array | None = None) -> Fit:
    """The best fit with clock and sensor within their bounds."""
    shifts = allowed(compared, beside.channel)
    fits = [explained(beside, course, beside.times - d, inside) for d in shifts]
    return min(fits, key=lambda f: f.squares)


def _own(compared: Compared, beside: Beside) -> Fit:
    return within(compared, beside, beside)


def together(leads: Sequence[Beside], own: Sequence[Fit], gains: Array) -> float:
    """Gain of all channels together: their median, so that one faulty sensor does not decide, by independent channels.

    The number of independent ones is (sum l)^2 / sum l^2 over the eigenvalues l of the correlation of what the
    recording's
    own conditions leave (Bretherton et al., J. Climate 12 (1999) 1990-2009).
    """
    if len(leads) < 2:
        return float(np.median(gains))
    grid = np.linspace(max(b.times[0] for b in leads), min(b.times[-1] for b in leads), 400)
    rows = np.stack([np.interp(grid, b.times[-len(f.residual) :], f.residual) for b, f in zip(leads, own)])
    sizes = np.linalg.eigvalsh(np.nan_to_num(np.corrcoef(rows), nan=0.0))
    return float(np.median(gains)) * float(sizes.sum() ** 2 / np.sum(sizes**2))


def _shares(fits: Sequence[Fit]) -> float:
    return float(np.median([f.share for f in fits]))


def _other_runs(compared: Compared, others: Sequence[Compared], leads: Sequence[Beside]) -> list[Rival]:
    found = []
    for other in others:
        pairs = [(b, other.channels[b.channel.name]) for b in leads if b.channel.name in other.channels]
        pairs = [(b, o) for b, o in pairs if o.simulated is not None]
        if not pairs:
            continue
        gains, mine, theirs, asked = [], [], [], []
        for b, o in pairs:
            assert o.simulated is not None
            inside = b.times <= o.simulated.times[-1]
            if np.count_nonzero(inside) < max(24, 0.5 * len(inside)):
                continue
            own, another = within(compared, b, b, inside), within(compared, b, o, inside)
            gains.append(gain(own, another))
            mine.append(own)
            theirs.append(another)
            asked.append(b)
        if gains:
            title = other.recording.title
            found.append(
                Rival(
                    "other run",
                    "inputs" if compared.recording.inputs else "overrides",
                    f"the programme of `{title}` explains {{other}} of the variance of these readings, their own "
                    "{own}",
                    f"is the programme that of `{title}`? Exchange them, or correct `overrides` and `inputs`",
                    together(asked, mine, np.array(gains)) - 2.0 * np.log(len(others)),
                    _shares(mine),
                    _shares(theirs),
                )
            )
    return found


def between(low: float, high: float) -> str:
    """An interval of times, for people."""
    return f"{instant(low, 3)} to {instant(high, 3)}"


def _shifts(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> list[Rival]:
    """The whole response earlier or later than its programme."""
    bound = max(resolution(compared, b.channel) for b in leads)
    span = compared.end - compared.begin
    if not 2.0 * bound < 0.5 * span:
        return []
    sizes = np.geomspace(1.5 * bound, 0.5 * span, SHIFTS)
    slowest = max(b.channel.lag_bound for b in leads)
    price = 2.0 * np.log(2.0 * SHIFTS)

    def moved(shift: float) -> tuple[float, float, list[Fit]]:
        fits = [explained(b, b, b.times - shift) for b in leads]
        return together(leads, own, np.array([gain(a, f) for a, f in zip(own, fits)])) - price, shift, fits

    tried = [moved(float(s)) for s in (*-sizes[::-1], *sizes[sizes > slowest + bound])]
    tried, (gained, shift, fits) = _refined(tried, moved, sizes[1] / sizes[0])
    low, high = _interval([(g, s) for g, s, _ in tried], shift)
    if shift < 0.0 and gained < _direct_gain(compared, leads, own) + critical(1.0):
        return []
    ends = np.concatenate([[compared.begin], compared.switches(), [compared.end]])
    way = "later" if shift > 0 else "earlier"
    # moved beyond its shortest part a programme may be another one, but not where it explains what a model explains
    if abs(shift) < np.min(np.diff(ends)) or _shares(fits) > 1.0 - DISCREPANCY**2:
        stated = max(b.channel.offset_bound for b in leads)
        text = (
            f"the response comes {instant(abs(shift), 3)} s {way} than {compared.drive} "
            f"({between(low, high)} s, 95 %), where at most {instant(stated, 3)} s are stated: "
            "moved by that, it explains {other} of the variance of the readings, as it is {own}"
        )
        remedy = "correct `time.zero` or the programme's times, or state the clock's `offset_bound`"
        return [Rival("dead time", "time", text, remedy, gained, _shares(own), _shares(fits))]
    text = (
        f"the readings do not change when the programme does: {instant(abs(shift), 3)} s {way} "
        f"({between(low, high)} s, 95 %) "
        "it would explain {other} of their variance, as it is {own}"
    )
    remedy = "is this the programme that was run? Correct `overrides`, `inputs` or `time.zero`"
    return [Rival("programme", driver(compared), text, remedy, gained, _shares(own), _shares(fits))]


def _refined(tried: list[_Tried], asked: Callable[[float], _Tried], ratio: float) -> tuple[list[_Tried], _Tried]:
    """All that was tried and the best of it: more exactly than on the grid, whose ends are no bounds, if it is told.

    Args:
        tried: On the grid.
        asked: Tries a size.
        ratio: Of two sizes of the grid, one after the other.
    """
    best = max(tried, key=lambda one: one[0])
    if best[0] > critical(4.0):
        tried = [*tried, *map(asked, (best[1] * ratio ** np.linspace(-1.0, 1.0, FINER)).tolist())]
    return tried, max(tried, key=lambda one: one[0])


def _interval(tried: Sequence[tuple[float, float]], best: float) -> tuple[float, float]:
    """Sizes that the 95 % quantile of chi-square allows, without their sign, as far as the next ones that were tried.

    Args:
        tried: Gain in -2 log likelihood and size of all that were tried.
        best: The size that gains most.
    """
    gains = {abs(size): gained for gained, size in tried if size * best > 0.0}
    sizes = sorted(gains)
    level = gains[abs(best)] - chi_square_beyond(0.05, 1)
    inside = [n for n, size in enumerate(sizes) if gains[size] > level]
    return sizes[max(inside[0] - 1, 0)], sizes[min(inside[-1] + 1, len(sizes) - 1)]


def _direct_gain(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> float:
    """What sensors gain that answer the inputs at once, beside their own course: their readings come early."""
    with_inputs = [fit(b.measured, design(b, b.times), b.tolerance, direct(compared, b.times).T) for b in leads]
    return together(leads, own, np.array([gain(a, f) for a, f in zip(own, with_inputs)]))


def _factors(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> list[Rival]:
    """A clock that runs too fast or too slow."""
    bound = max(resolution(compared, b.channel) for b in leads)
    span = compared.end - compared.begin
    least = 1.5 * bound / span
    if not least < FASTEST:
        return []
    sizes = np.geomspace(least, FASTEST, FACTORS)
    price = 2.0 * np.log(2.0 * FACTORS)

    def run_at(size: float) -> tuple[float, float, list[Fit]]:
        fits = [explained(b, b, b.times / (1.0 + size)) for b in leads]
        return together(leads, own, np.array([gain(a, f) for a, f in zip(own, fits)])) - price, size, fits

    tried = [run_at(float(size)) for size in (*-sizes[::-1], *sizes)]
    tried, (gained, size, fits) = _refined(tried, run_at, sizes[1] / sizes[0])
    low, high = (100.0 * v for v in _interval([(g, s) for g, s, _ in tried], size))
    text = (
        f"the readings' clock runs {100.0 * abs(size):.2g} % too {'fast' if size > 0 else 'slow'} ({low:.2g} to "
        f"{high:.2g} %, 95 %){_CORRECTED}"
    )
    remedy = "compare two instants that both clocks know; correct the column of times or its unit"
    return [Rival("clock", "time", text, remedy, gained, _shares(own), _shares(fits))]


def _or_jump(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit], best: Rival) -> Rival:
    """What explains most, or a clock that is right at first and off from an instant on, or both.

    A clock that is off throughout is one that jumps before anything is driven, and is said in fewer words; one that
    runs wrong is off by as much in the middle.
    """
    bound, span = max(resolution(compared, b.channel) for b in leads), compared.end - compared.begin
    if not 1.5 * bound < FARTHEST * span:
        return best
    price = 2.0 * np.log(TRIED)

    def fits(size: float, at: float) -> list[Fit]:
        return [explained(b, b, b.times - offsets(b.times, size, at)) for b in leads]

    def lost(jumps: Array) -> Array:
        every = [[gain(a, f) for a, f in zip(own, fits(size, at))] for size, at in jumps.tolist()]
        return -np.array([together(leads, own, np.array(gains)) for gains in every])

    jump = best_jump(compared.begin, compared.end, np.geomspace(1.5 * bound, FARTHEST * span, SIZES), lost)
    gained = -jump.value - price
    limit = critical(4.0)
    if gained < best.gain + (-limit if best.kind == "clock" else limit):
        return best
    if gained < best.gain + limit:
        return replace(best, text=f"{best.text}; or {jump.in_words()}: these cannot be told apart")
    shares = _shares(own), _shares(fits(jump.size, jump.at))
    return Rival("clock", "time", f"{jump.in_words()}{_CORRECTED}", REMEDY, gained, *shares)


def driver(compared: Compared) -> str:
    """Name of what changes."""
    return next((c.name for c in compared.courses if c.switches().size), "programme")


def _switches(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> list[Rival]:
    """Switches at other instants than the programme's explain the readings, and the programme does not.

    Three tests, all of which must hold: the programme leaves more than a model's discrepancy (chi-square over
    independent samples), also with a sensor whose characteristic bends; as many switches of any size at free instants
    behind one lag leave no more than that; and at most half of the switches to which the simulation responds are among
    these instants: what a rig does of itself comes beside them.

    Nothing is said where the last test would say the same of the simulation, which does follow its programme: the
    course of a rig that integrates or swings is drawn by steps at instants that are none of its switches.
    """
    switches = compared.switches()
    if len(switches) > 12:  # a recorded course that moves all the time: its instants are no statement
        return []
    span = compared.end - compared.begin
    grid = compared.begin + span * (np.arange(INSTANTS) + 0.5) / INSTANTS
    pairs = []
    for b, plain in zip(leads, own):
        chosen, free = _greedy(b, b.measured, grid, len(switches) + 1)
        near = resolution(compared, b.channel) + 1.5 * span / INSTANTS
        is_other = _are_others(switches, chosen, near)
        if is_other:  # and would the simulation's own switches be found?
            is_other = not _are_others(switches, _greedy(b, b.simulated_there, grid, len(switches) + 1)[0], near)
        excess, left = min(discrepant(plain), discrepant(_bent(b))), discrepant(free)
        pairs.append((excess if is_other and left < critical(4.0) else 0.0, plain, free, chosen, near))
    gained = float(np.sort([p[0] for p in pairs])[(len(pairs) - 1) // 2])  # one channel of two does not decide
    if not gained > 0.0:
        return []
    chosen, near = max(pairs, key=lambda p: p[0])[3:]
    others = [t for t in chosen if np.min(np.abs(switches - t)) > near]
    if not others:
        return []
    text = (
        f"the readings change at about {listed(others)} s, where the programme does not: switches at free "
        f"instants explain {{other}} of their variance, the programme (switches at {listed(switches)} s) {{own}}"
    )
    remedy = "is this the programme that was run? Correct `overrides`, or give the recorded input under `inputs`"
    shares = _shares([p[1] for p in pairs]), _shares([p[2] for p in pairs])
    return [Rival("programme", driver(compared), text, remedy, gained, *shares)]


def _are_others(switches: Array, chosen: Sequence[float], near: float) -> bool:
    """Whether at most half of the switches [s] are near chosen instants [s]."""
    return bool(sum(min(abs(t - c) for c in chosen) < near for t in switches) <= 0.5 * len(switches))


def _bent(beside: Beside) -> Fit:
    """The best fit by a sensor whose characteristic bends: one that clips changes only when the programme does."""
    assert beside.simulated is not None
    own = sample(beside.simulated, beside.times)
    # a sensor that clips bends where so many readings as it has at its ends lie beyond
    shares = [np.mean(beside.measured <= beside.measured.min()), np.mean(beside.measured < beside.measured.max())]
    knots = np.unique(np.quantile(own, [*np.linspace(0.0, 1.0, KNOTS + 2)[1:-1], *shares]))
    bends = np.maximum(own[:, None] - knots, 0.0)
    return fit(beside.measured, design(beside, beside.times), beside.tolerance, bends)


def discrepant(found: Fit) -> float:
    """How far a fit is from a model with its usual discrepancy, as a chi-square with one degree of freedom.

    What is left, over the discrepancy that a model may have, is a chi-square with as many degrees as samples are
    independent.
    """
    degrees = found.independent
    left = float(found.residual @ found.residual) / len(found.residual) / found.floor
    return chi_square_beyond(max(chi_square_tail(degrees * left, degrees), 1e-300), 1)


def listed(instants: Sequence[float] | Array) -> str:
    few = [f"{t:.3g}" for t in sorted(instants)]
    return ", ".join(few[:4]) + (", ..." if len(few) > 4 else "")


def _responses(times: Array, instants: Array, lag: float) -> Array:
    """Steps at instants behind a lag [s], shape (samples, instants)."""
    since = times[:, None] - instants[None, :]
    return np.where(since > 0.0, -np.expm1(-np.maximum(since, 0.0) / lag), 0.0)


def _step_lags(beside: Beside) -> Array:
    return np.geomspace(beside.lags[0], beside.lags[-1], 8)


def _greedy(beside: Beside, values: Array, grid: Array, count: int) -> tuple[list[float], Fit]:
    """Orthogonal matching pursuit of steps behind one lag, over the lags, for values at the picked samples."""
    measured = values - values.mean()
    best: tuple[list[float], Fit] | None = None
    for lag in _step_lags(beside):
        atoms = _responses(beside.times, grid, float(lag))
        basis = np.ones((len(measured), 1)) / np.sqrt(len(measured))
        left, chosen = measured, []
        for _ in range(count):
            free = atoms - basis @ (basis.T @ atoms)
            sizes = np.linalg.norm(free, axis=0)
            scores = np.where(
                sizes > 1e-6 * np.sqrt(len(measured)), np.abs(free.T @ left) / np.maximum(sizes, 1e-12), 0.0
            )
            index = int(np.argmax(scores))
            if not scores[index] > 0.0:
                break
            basis = np.hstack([basis, free[:, index : index + 1] / sizes[index]])
            left = measured - basis @ (basis.T @ measured)
            chosen.append(float(grid[index]))
        found = Fit(left, beside.tolerance**2, float(measured @ measured))
        if best is None or found.squares < best[1].squares:
            best = chosen, found
    assert best is not None
    return best
