"""A recording that stands out, and what of the rig would have to be another in it for a while, or from an instant on.

A fan that is switched on, a part that gives way, wind that rises: where the scenario meets the other recordings and not
this one, each parameter of its Model Exchange FMUs, and each derivative of their states, is moved within one interval
of this recording. Intervals between ends of pieces are tried by what a small change in each piece does, added up; from
the best of each, amount, begin and end are fitted by simulations. What then explains every channel as well as the
others are explained is what to look at first. One channel proves nothing: some change gives it nearly any course.

Source: faults of a process that are abrupt, additive or in its parameters: Isermann, Fault-Diagnosis Systems, Springer
2006, chapter 5; Nelder, Mead, Computer Journal 7 (1965) 308-313.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.optimize import minimize

from cosim.formula import to_base
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.input_runs import is_quick, left_by, parts_of, readings_of
from diagnosis.check.odd_one_out import as_explained, comparable, in_words, left_beside, scaled_left
from diagnosis.check.straight_line import freed, line_basis
from diagnosis.check.timing import percent
from diagnosis.faults.law import LEAST_SHARE
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import ODD
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.changed_run import Changed, ChangedRuns
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.report.display import instant, number

#: Channels that have to be explained.
CHANNELS = 2
#: Macro-steps beyond which nothing is tried: a thousand simulations take minutes then.
MOST_STEPS = 10_000
#: Pieces of the recording at whose ends a change begins and ends at first.
PIECES = 16
#: Changes that are fitted: those of which least is left by what small changes do.
FITTED = 6
#: Simulations of a fit for each of its numbers.
EACH = 40
#: Changes that are told; of more that explain the recording the first are.
MOST = 3


@dataclass(frozen=True)
class _Fitted:
    """A change with its amount and interval [s], open where it lasts, and what is left of the channels at most."""

    changed: Changed
    amount: float
    begin: float
    end: float
    left: float


def changed_rig(one: Compared, others: Sequence[Compared]) -> Doubt | None:
    """A doubt about what was another for a while, never serious; None where nothing explains the recording.

    Args:
        one: A recording that stands out (`diagnosis.check.odd_one_out`).
        others: The other recordings of the same rig, which the scenario meets.
    """
    channels = comparable(one)
    is_short = one.scenario.time.macro_steps <= MOST_STEPS
    if not is_quick(one.scenario) or not is_short or len(channels) < CHANNELS:
        return None
    before, theirs = left_beside(one, others, scaled_left)
    enough = as_explained(theirs)
    if before <= enough:
        return None
    try:
        with closing(ChangedRuns(one.scenario)) as runs:
            found = [f for f in _Tried(runs, one, channels).fitted() if f.left <= enough]
    except (InputError, NotFast, CompilerError):
        return None
    return _doubt(one, sorted(found, key=lambda f: f.left), before, theirs) if found else None


class _Tried:
    """Changes of one recording.

    Args:
        runs: Of the recording.
        one: The recording.
        channels: Its channels that are compared, by name.
    """

    def __init__(self, runs: ChangedRuns, one: Compared, channels: dict[str, Beside]) -> None:
        self._runs, self._one, self._channels = runs, one, channels
        self._edges = np.linspace(one.begin, one.end, PIECES + 1)
        #: Of each channel what a straight line in its simulation explains, shape (readings, 2).
        self._lines = [line_basis(b.simulated_there) for b in channels.values()]
        #: What makes a sum of squares of the readings of a channel a share of their variance.
        self._scales = [len(b.times) ** -0.5 / float(np.std(b.measured)) for b in channels.values()]
        self._rest = self._freed(np.concatenate([b.measured for b in channels.values()]))

    def fitted(self) -> list[_Fitted]:
        """The changes that promise most, each where it explains the recording best."""
        base = self._readings(0, 0.0, self._one.begin, self._one.end)
        if base is None:
            return []
        starts = [s for n in range(len(self._runs.changes)) if (s := self._by_pieces(n, base)) is not None]
        best = sorted(starts, key=lambda s: s[0])[:FITTED]
        return [self._fit(number, amount, begin, end) for _, number, amount, begin, end in best]

    def _by_pieces(self, number: int, base: Array) -> tuple[float, int, float, float, float] | None:
        """What is left with the best interval between ends of pieces, the change, its amount, begin and end.

        None where the change does nothing, or a run fails.
        """
        first = self._runs.changes[number].first
        rows = [self._readings(number, first, a, b) for a, b in itertools.pairwise(self._edges.tolist())]
        done = [(row - base) / first for row in rows if row is not None]
        if len(done) < PIECES:
            return None
        summed = np.cumsum([np.zeros(len(base)), *map(self._freed, done)], axis=0)
        best = None
        for a, b in itertools.combinations(range(PIECES + 1), 2):
            row = summed[b] - summed[a]
            size = float(row @ row)
            if size <= 0.0:
                continue
            amount = float(row @ self._rest) / size
            lefts = [float(p @ p) for p in parts_of(self._channels, self._rest - amount * row)]
            if best is None or max(lefts) < best[0]:
                best = max(lefts), number, amount, float(self._edges[a]), float(self._edges[b])
        return best

    def _freed(self, row: Array) -> Array:
        """A row of all channels without what straight lines explain, its squares as shares of their variances."""
        parts = zip(parts_of(self._channels, row), self._lines, self._scales)
        return np.concatenate([scale * freed(own, line) for own, line, scale in parts])

    def _fit(self, number: int, amount: float, begin: float, end: float) -> _Fitted:
        """The amount and the interval that leave the least; an interval up to an end of the recording stays there."""
        changed, edges = self._runs.changes[number], self._edges
        amount = max(amount, 0.9 * LEAST_SHARE) if changed.is_share else amount
        lasts = end == edges[-1]
        wide = edges[1] - edges[0]
        free = [begin > edges[0], not lasts]
        at = np.array([begin, math.inf if lasts else end])

        def values(x: Array) -> tuple[float, float, float]:
            instants = at.copy()
            instants[free] += wide * x[1:]
            return float(amount * (1.0 + x[0])), float(instants[0]), float(instants[1])

        def cost(x: Array) -> float:
            size, first, last = values(x)
            is_in = edges[0] <= first < last and (lasts or last <= edges[-1])
            return self._left(number, size, first, last) if is_in else math.inf

        simplex = np.vstack(
            [np.zeros(1 + sum(free)), np.diag([0.25, *[-0.5 if begin > edges[0] else 0.5] * sum(free)])]
        )
        options: Any = {"initial_simplex": simplex, "maxfev": EACH * (1 + sum(free)), "xatol": 1e-3, "fatol": 1e-6}
        found = minimize(cost, np.zeros(1 + sum(free)), method="Nelder-Mead", options=options)
        return _Fitted(changed, *values(found.x), float(found.fun))

    def _left(self, number: int, amount: float, begin: float, end: float) -> float:
        """Largest share of a channel's variance that is left, scaled and shifted as suits best."""
        if self._runs.changes[number].is_share and amount <= LEAST_SHARE:
            return math.inf
        return left_by(self._results(number, amount, begin, end), self._channels, self._one)

    def _readings(self, number: int, amount: float, begin: float, end: float) -> Array | None:
        """Simulated readings of all channels one after another; None where the run fails."""
        results = self._results(number, amount, begin, end)
        if results is None:
            return None
        return np.concatenate([readings_of(results, b, self._one) for b in self._channels.values()])

    def _results(self, number: int, amount: float, begin: float, end: float) -> xr.Dataset | None:
        """See `ChangedRuns.results`; what lasts until the last reading lasts beyond the last step."""
        last = end if end < self._edges[-1] else 2.0 * self._edges[-1] - self._edges[0]
        return self._runs.results(number, amount, begin, last)


def _doubt(one: Compared, found: Sequence[_Fitted], before: float, theirs: float) -> Doubt:
    told = " or ".join(_told(f, one) for f in found[:MOST])
    more = len(found) - MOST
    worst = max(f.left for f in found[:MOST])
    also = f" ({more} more of its numbers and derivatives do, too)" if more > 0 else ""
    text = (
        f"{in_words(before, theirs)}; "
        f"as if something of the rig was another, with {told}{also} it is at least {percent(1.0 - worst)} here too"
    )
    remedy = (
        "was something of the rig or around it switched, moved or touched then? If it is known, state it under "
        f"`overrides` of this recording, as a term that is added to `{found[0].changed.to}` of "
        f"`{found[0].changed.component}`; a law that only this recording reaches may look alike"
    )
    z = float(np.sqrt(before / max(found[0].left, 1e-12)))
    best = found[0]
    subject = f"{best.changed.component}.{best.changed.name}"
    return Doubt(one.recording.title, subject, ODD, text, remedy, False, best.begin, min(best.end, one.end), z)


def _told(fitted: _Fitted, one: Compared) -> str:
    changed, name = fitted.changed, f"{fitted.changed.component}.{fitted.changed.name}"
    unit = "" if changed.unit in ("", "1") else f" {changed.unit}"
    if changed.stated is not None:
        value = f"{name} = {changed.stated * (1.0 + fitted.amount):.3g}{unit} ({changed.stated:.4g} is stated)"
    else:
        amount = number(abs(fitted.amount) / to_base(changed.unit)[0], 2)
        value = f"der({name}) {'larger' if fitted.amount > 0.0 else 'smaller'} by {amount}{unit or ' 1'}/s"
    begins, lasts = fitted.begin > one.begin, fitted.end < one.end
    if begins and lasts:
        return f"{value} from about {instant(fitted.begin)} to {instant(fitted.end)} s"
    if begins:
        return f"{value} from about {instant(fitted.begin)} s on"
    return f"{value} until about {instant(fitted.end)} s" if lasts else f"{value} throughout"
