"""Does the response follow this programme: another run's, a late one, a clock that runs wrong, other switches?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from cosim.components import nanoseconds
from cosim.unit import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import LEVEL, Fit, design, explained, fit, gain
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Channel

#: Channels of one recording that are asked for timing; more of the same rig say the same again.
MOST_CHANNELS = 12
#: Shifts each way and factors on time each way that are tried.
SHIFTS, FACTORS = 40, 24
#: Greatest factor on time that is called a drifting clock; beyond it the unit of time is asked for.
FASTEST = 0.3
#: Instants at which an unknown switch may lie.
INSTANTS = 120


@dataclass(frozen=True)
class Rival:
    """Another explanation of a recording's timing.

    Args:
        kind: Of the doubt.
        subject: What it concerns.
        text: What the readings do, in plain words, with `{own}` and `{other}` for shares of variance.
        remedy: What to look at.
        gains: Per channel, after the price of what was chosen.
        own: Share of variance that the recording's own conditions explain, median over channels.
        other: Share that this explanation explains.
    """

    kind: str
    subject: str
    text: str
    remedy: str
    gains: Array
    own: float
    other: float

    @property
    def gain(self) -> float:
        """Median over channels: one faulty sensor does not decide, and channels of one rig are not independent."""
        return float(np.median(self.gains))


def critical(tests: float) -> float:
    """Gain that one more degree of freedom reaches by chance in `LEVEL` of recordings, over so many tests.

    Wilks' theorem with Bonferroni's correction; a median over channels exceeds it less often than one channel.
    """
    return float(chi2.isf(LEVEL / tests, 1))


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
    rivals = [
        *_other_runs(compared, others, leads),
        *_shifts(compared, leads, own),
        *_factors(compared, leads, own),
        *_switches(compared, leads, own),
    ]
    rivals = [r for r in rivals if r.gain > critical(4.0)]
    if not rivals:
        return []
    best = max(rivals, key=lambda r: r.gain)
    text = best.text.format(own=percent(best.own), other=percent(best.other))
    return [Doubt(compared.recording.title, best.subject, best.kind, text, best.remedy, True,
                  compared.begin, compared.end, float(np.sqrt(best.gain)))]  # fmt: skip


def percent(share: float) -> str:
    """A share as a person reads it: never 100 % of what is not whole.

    >>> percent(0.99987), percent(0.5), percent(0.0)
    ('99.99 %', '50 %', '0 %')
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
    """Shifts that are no doubt [s]; later also by the lag stated for the sensor, since several lags look like a delay."""
    bound = resolution(compared, channel)
    late = np.linspace(0.0, channel.lag_bound, 9)[1:] if channel.lag_bound else np.zeros(0)
    return np.concatenate([np.linspace(-bound, bound, 5), bound + late])


def _within(compared: Compared, beside: Beside, course: Beside, inside: Array | None = None) -> Fit:
    """The best fit with clock and sensor within their bounds."""
    shifts = allowed(compared, beside.channel)
    fits = [explained(beside, course, beside.times - d, inside) for d in shifts]
    return min(fits, key=lambda f: f.squares)


def _own(compared: Compared, beside: Beside) -> Fit:
    return _within(compared, beside, beside)


def _shares(fits: Sequence[Fit]) -> float:
    return float(np.median([f.share for f in fits]))


def _other_runs(compared: Compared, others: Sequence[Compared], leads: Sequence[Beside]) -> list[Rival]:
    found = []
    for other in others:
        pairs = [(b, other.channels[b.channel.name]) for b in leads if b.channel.name in other.channels]
        pairs = [(b, o) for b, o in pairs if o.simulated is not None]
        if not pairs:
            continue
        gains, mine, theirs = [], [], []
        for b, o in pairs:
            assert o.simulated is not None
            inside = b.times <= o.simulated.times[-1]
            if np.count_nonzero(inside) < max(24, 0.5 * len(inside)):
                continue
            own, another = _within(compared, b, b, inside), _within(compared, b, o, inside)
            gains.append(gain(own, another))
            mine.append(own)
            theirs.append(another)
        if gains:
            title = other.recording.title
            found.append(Rival(
                "other run", "inputs" if compared.recording.inputs else "overrides",
                f"the programme of `{title}` explains {{other}} of these readings, their own {{own}}",
                f"is the input or the programme that of `{title}`? Exchange them, or correct `overrides` and `inputs`",
                np.array(gains) - 2.0 * np.log(max(len(others), 1)), _shares(mine), _shares(theirs),
            ))  # fmt: skip
    return found


def _shifts(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> list[Rival]:
    """The whole response earlier or later than its programme."""
    bound = max(resolution(compared, b.channel) for b in leads)
    span = compared.end - compared.begin
    if not 2.0 * bound < 0.5 * span:
        return []
    sizes = np.geomspace(1.5 * bound, 0.5 * span, SHIFTS)
    slowest = max(b.channel.lag_bound for b in leads)
    price = 2.0 * np.log(2.0 * SHIFTS)
    best: tuple[float, Array, float, list[Fit]] | None = None
    for shift in (*-sizes[::-1], *sizes[sizes > slowest + bound]):
        fits = [explained(b, b, b.times - shift) for b in leads]
        gains = np.array([gain(a, f) for a, f in zip(own, fits)]) - price
        if best is None or np.median(gains) > best[0]:
            best = float(np.median(gains)), gains, float(shift), fits
    assert best is not None
    _, gains, shift, fits = best
    ends = np.concatenate([[compared.begin], compared.switches(), [compared.end]])
    way = "later" if shift > 0 else "earlier"
    if abs(shift) < np.min(np.diff(ends)):
        stated = max(b.channel.offset_bound for b in leads)
        text = (f"the response comes {abs(shift):.3g} s {way} than its programme, where at most {stated:.3g} s are stated: "
                "moved by that, it explains {other} of the readings, as it is {own}")  # fmt: skip
        remedy = "correct `time.zero` or the programme's times, or state the clock's `offset_bound`"
        return [Rival("dead time", "time", text, remedy, gains, _shares(own), _shares(fits))]
    text = (f"the readings do not change when the programme does: {abs(shift):.3g} s {way} it would explain {{other}} of "
            "them, as it is {own}")  # fmt: skip
    remedy = "is this the programme that was run? Correct `overrides`, `inputs` or `time.zero`"
    return [Rival("programme", _driver(compared), text, remedy, gains, _shares(own), _shares(fits))]


def _factors(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> list[Rival]:
    """A clock that runs too fast or too slow."""
    bound = max(resolution(compared, b.channel) for b in leads)
    span = compared.end - compared.begin
    least = 1.5 * bound / span
    if not least < FASTEST:
        return []
    sizes = np.geomspace(least, FASTEST, FACTORS)
    price = 2.0 * np.log(2.0 * FACTORS)
    best: tuple[float, Array, float, list[Fit]] | None = None
    for size in (*-sizes[::-1], *sizes):
        fits = [explained(b, b, b.times / (1.0 + size)) for b in leads]
        gains = np.array([gain(a, f) for a, f in zip(own, fits)]) - price
        if best is None or np.median(gains) > best[0]:
            best = float(np.median(gains)), gains, float(size), fits
    assert best is not None
    _, gains, size, fits = best
    text = (f"the readings' clock runs {100.0 * abs(size):.2g} % too {'fast' if size > 0 else 'slow'}: so corrected, the "
            "programme explains {other} of the readings, as it is {own}")  # fmt: skip
    remedy = "compare two instants that both clocks know; correct the column of times or its unit"
    return [Rival("clock", "time", text, remedy, gains, _shares(own), _shares(fits))]


def _driver(compared: Compared) -> str:
    """Name of what changes."""
    return next((c.name for c in compared.courses if c.switches().size), "programme")


def _switches(compared: Compared, leads: Sequence[Beside], own: Sequence[Fit]) -> list[Rival]:
    """As many switches as the programme has, at other instants, explain more than the programme does.

    Own explanation: the simulated course and steps of any size at the instants of the programme, behind one lag. Rival:
    steps at instants that are chosen one after the other, behind one lag.
    """
    switches = compared.switches()
    count = len(switches)
    if count > 12:  # a recorded course that moves all the time: its instants are no statement
        return []
    span = compared.end - compared.begin
    grid = compared.begin + span * (np.arange(INSTANTS) + 0.5) / INSTANTS
    far = np.min(np.abs(grid[:, None] - switches[None, :]), axis=1) > max(
        max(resolution(compared, b.channel) for b in leads), span / INSTANTS
    )
    gains, mine, theirs, instants = [], [], [], []
    for b, plain in zip(leads, own):
        given = _with_steps(b, switches)
        given = min((given, plain), key=lambda f: f.squares)
        chosen, free = _greedy(b, grid, count + 1)
        # a count of instants was chosen from the grid; the simulated course and its lags were spared
        gains.append(gain(given, free) - 2.0 * (count + 1) * np.log(INSTANTS))
        mine.append(given)
        theirs.append(free)
        instants.append(chosen)
    # what nobody's programme has: instants away from its switches
    nearest = [t for t in instants[int(np.argmax(gains))] if far[int(np.argmin(np.abs(grid - t)))]]
    if not nearest:
        return []
    listed = ", ".join(f"{t:.3g}" for t in sorted(nearest)[:4])
    text = (f"the readings change at {listed} s, where the programme does not; switches there explain {{other}} of them, "
            f"those of the programme ({', '.join(f'{t:.3g}' for t in switches[:4])} s) {{own}}")  # fmt: skip
    remedy = "is this the programme that was run? Correct `overrides`, or give the recorded input under `inputs`"
    return [Rival("programme", _driver(compared), text, remedy, np.array(gains), _shares(mine), _shares(theirs))]


def _responses(times: Array, instants: Array, lag: float) -> Array:
    """Steps at instants behind a lag [s], shape (samples, instants)."""
    since = times[:, None] - instants[None, :]
    return np.where(since > 0.0, -np.expm1(-np.maximum(since, 0.0) / lag), 0.0)


def _with_steps(beside: Beside, switches: Array) -> Fit:
    base = design(beside, beside, beside.times, beside.times)
    fits = [
        fit(beside.measured, np.hstack([base, _responses(beside.times, switches, lag)]), beside.tolerance)
        for lag in _step_lags(beside)
    ]
    return min(fits, key=lambda f: f.squares)


def _step_lags(beside: Beside) -> Array:
    return np.geomspace(beside.lags[0], beside.lags[-1], 8)


def _greedy(beside: Beside, grid: Array, count: int) -> tuple[list[float], Fit]:
    """Orthogonal matching pursuit of steps behind one lag, over the lags."""
    measured = beside.measured - beside.measured.mean()
    best: tuple[list[float], Fit] | None = None
    for lag in _step_lags(beside):
        atoms = _responses(beside.times, grid, float(lag))
        basis = np.ones((len(measured), 1)) / np.sqrt(len(measured))
        left, chosen = measured, []
        for _ in range(count):
            free = atoms - basis @ (basis.T @ atoms)
            sizes = np.linalg.norm(free, axis=0)
            scores = np.where(sizes > 1e-6 * np.sqrt(len(measured)), np.abs(free.T @ left) / np.maximum(sizes, 1e-12), 0.0)
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
