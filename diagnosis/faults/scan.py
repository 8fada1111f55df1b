"""Scores of faults with begin and end: the best interval of each sensor and of each input, and what chance gives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.faults.intervals import Best, Pieces, best_constant, best_interval, best_ramp, best_single, cuts_of
from diagnosis.faults.law import (
    DRIFT,
    FEWEST,
    FEWEST_OF_DRIFT,
    OF_TIME,
    OFFSET,
    RISE,
    SCALED,
    STUCK,
    is_one_of,
)
from diagnosis.faults.readings import ACTS, Readings
from diagnosis.models.protocol import Scaled
from diagnosis.recording.equal_readings import FEWEST_EQUAL
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import HUBER
from diagnosis.search.problem import Term
from diagnosis.search.score import Projection, Score, Scoring
from diagnosis.search.switches import costs_of

#: Pieces of a channel whose ends are tried as begin and end of a fault; around the best of them every sample is tried.
PIECES = 24
#: Pieces of which a sensor that is stuck is tried to hold.
STUCK_PIECES = 64
#: Begins and ends of an input that stays: what it stays at changes with the begin.
HELD_BEGINS, HELD_ENDS = 24, 12
#: Of intervals that were simulated at another fit, the best of which are simulated again: what an input does changes
#: little from one fit to the next, and what the fit leaves is known without a simulation.
HELD_AGAIN = 12
#: Share of what a lag of some size does with which it may fit: others are nearer there.
NEARLY = (0.6, 1.6)
#: Begins and ends that are tried at once near the best; the number of intervals grows with the square of it.
MOST_CUTS = 400

#: Into how many parts pieces at the ends of an input's interval are cut, and share of the largest gain of any input
#: from which one is cut finer.
FINER, WORTH = 4, 0.1

Lead = tuple[Term, tuple[float, ...]] | None


class _Collected:
    """Scores so far."""

    def __init__(self, draws: int) -> None:
        self.scores: list[Score] = []
        self.tried = 0
        self.chance: Array = np.zeros(draws)
        self.leads: list[Lead] = [None] * draws

    def add(self, term: Term, best: Best, edges: Array) -> None:
        """The best interval of a term, its price taken off; `edges` are the times between its pieces."""
        self.tried += best.tried
        self.score(term, best.gain, (best.amount, float(edges[best.first]), float(edges[best.last])))
        for n, (gain, (first, last, amount)) in enumerate(zip((best.chance - term.price).tolist(), best.leads)):
            if gain > self.chance[n]:
                self.chance[n] = gain
                self.leads[n] = (term, (amount, float(edges[first]), float(edges[last])))

    def score(self, term: Term, gain: float, values: tuple[float, ...]) -> None:
        """One interval of a term."""
        if gain > term.price:
            self.scores.append(Score(term, values, gain - term.price, 1.0))

    def scoring(self) -> Scoring:
        return Scoring(sorted(self.scores, key=lambda s: -s.gain), self.tried, self.chance, tuple(self.leads))


def sensor_scores(
    base: Fit, projection: Projection, scaled: Scaled, tracks: Sequence[tuple[Readings, Sequence[Term]]]
) -> Scoring:
    """Scores of faults of sensors; their directions are known without a simulation.

    Where a sensor that holds its value reads as one with an offset would, it has the nulls of that.

    Args:
        base: Converged fit.
        projection: Of that fit, with nulls.
        scaled: What wrapping models make of changes of residuals.
        tracks: Channels with the terms that may be added there; of each kind the first is tried.
    """
    found = _Collected(projection.draws)
    for readings, terms in tracks:
        if np.count_nonzero(readings.used) <= FEWEST:
            continue
        kinds: dict[str, Term] = {}
        for term in terms:
            kinds.setdefault(term.identifier, term)
        for term in kinds.values():
            if term.identifier == STUCK.identifier:
                _stuck(found, base, scaled, readings, term)
            elif term.identifier == DRIFT.identifier:
                _ramp(found, projection, scaled, readings, term)
            elif is_one_of(term.identifier, OF_TIME):
                _late(found, base, projection, scaled, readings, term)
            else:
                _box(found, projection, scaled, readings, term, _unit(base, readings, term))
    return found.scoring()


def _unit(base: Fit, readings: Readings, term: Term) -> Array:
    """What a fault of strength 1 adds to the plain residuals where it acts, shape (samples,)."""
    if term.identifier == OFFSET.identifier:
        return np.full(len(readings.measured), -1.0 / readings.deviation)
    if not is_one_of(term.identifier, (SCALED, RISE)):
        raise NotImplementedError(
            f"what a {term.identifier} of strength 1 adds to a reading stands nowhere: say it here"
        )
    return -readings.rise(readings.plain(base.residuals[readings.own]))


def _box(
    found: _Collected, projection: Projection, scaled: Scaled, readings: Readings, term: Term, unit: Array
) -> None:
    """Score an offset or a gain, which adds a multiple of `unit` within its interval."""
    count = len(readings.measured)
    cuts = cuts_of(count, PIECES)
    bounds = (term.parameters[0].lower, term.parameters[0].upper)
    best = best_interval(_directions(projection, scaled, readings, cuts, unit), FEWEST, bounds)
    if best is None:
        return
    found.add(term, best, readings.edges[cuts])
    if len(cuts) <= count and best.gain > term.price:
        better, finer = _refined(projection, scaled, readings, (cuts, unit), best, bounds)
        if better.gain > best.gain:
            edges = readings.edges[finer]
            found.scores.pop()
            found.score(term, better.gain, (better.amount, float(edges[better.first]), float(edges[better.last])))


def _ramp(found: _Collected, projection: Projection, scaled: Scaled, readings: Readings, term: Term) -> None:
    """Score a drift, between the pieces of a channel; begin and end are moved by samples once it is fitted."""
    count = len(readings.measured)
    cuts = cuts_of(count, PIECES)
    edges = readings.edges[cuts]
    whole = -readings.ramp(float(edges[0]), float(edges[-1])) / readings.deviation
    level = np.full(count, -1.0 / readings.deviation)
    pieces = _directions(projection, scaled, readings, cuts, level, whole)
    bounds = (term.parameters[0].lower, term.parameters[0].upper)
    best = best_ramp(pieces, (edges - edges[0]) / (edges[-1] - edges[0]), FEWEST_OF_DRIFT, bounds)
    if best is not None:
        found.add(term, best, edges)


def _late(found: _Collected, base: Fit, projection: Projection, scaled: Scaled, readings: Readings, term: Term) -> None:
    """Score a lag, or a clock that is off, from begin to end of the recording: of each of several sizes what it does.

    A size that is tried is nearly right where its effect fits with about its own size.
    """
    act = ACTS[term.identifier]
    plain = readings.plain(base.residuals[readings.own])
    span = readings.span
    sizes = np.array(term.parameters[0].starts)
    moved = np.array([act(readings, plain, float(s), span.begin, span.end) for s in sizes]) - plain
    products = projection.pieces(scaled(readings.residuals(moved), readings.own), readings.own)
    best = best_single(Pieces(*products, np.full(len(sizes), np.count_nonzero(readings.used))), NEARLY)
    if best is not None:

        def to_size(number: int, share: float) -> float:
            return float(np.clip(share * sizes[number], term.parameters[0].lower, term.parameters[0].upper))

        leads = tuple((0, 1, to_size(first, share)) for first, _, share in best.leads)
        ends = replace(best, first=0, last=1, amount=to_size(best.first, best.amount), leads=leads)
        found.add(term, ends, np.array([span.begin, span.end]))


def _refined(
    projection: Projection,
    scaled: Scaled,
    readings: Readings,
    tried: tuple[AnyArray, Array],
    best: Best,
    bounds: tuple[float, float],
) -> tuple[Best, AnyArray]:
    """The best interval near another one, down to single samples, with the cuts that it counts in.

    Where there are too many samples to try each begin with each end, every n-th is tried first, and each near the best
    of them then.
    """
    (cuts, unit), count = tried, len(readings.measured)
    while True:
        near = [np.arange(cuts[max(e - 1, 0)], cuts[min(e + 1, len(cuts) - 1)] + 1) for e in (best.first, best.last)]
        step = -(-sum(len(n) for n in near) // MOST_CUTS)
        found = cuts[[best.first, best.last]]
        finer = np.unique(np.concatenate([[0], *(n[::step] for n in near), found, [count]]))
        better = best_interval(_directions(projection, scaled, readings, finer, unit).without_nulls(), FEWEST, bounds)
        if better is None:
            return best, cuts
        best, cuts = better, finer
        if step == 1:
            return best, cuts


def _directions(projection: Projection, scaled: Scaled, readings: Readings, cuts: AnyArray, *units: Array) -> Pieces:
    """Directions of an offset or a gain in pieces of a channel; of several courses one after the other."""
    inside = np.arange(len(readings.measured))[None, :]
    boxes = (inside >= cuts[:-1, None]) & (inside < cuts[1:, None])
    inward = np.vstack([np.where(boxes, unit, 0.0) for unit in units])
    rows = scaled(readings.residuals(inward), readings.own)
    return Pieces(*projection.pieces(rows, readings.own), np.add.reduceat(readings.used.astype(int), cuts[:-1]))


def _stuck(found: _Collected, base: Fit, scaled: Scaled, readings: Readings, term: Term) -> None:
    factor = scaled(readings.used.astype(np.float64)[None], readings.own)[0]
    residuals = base.residuals[readings.own]
    own = readings.measured / readings.deviation
    best = best_constant(residuals, factor * own, FEWEST_EQUAL, factor != 0.0, STUCK_PIECES, own)
    if best is not None:
        first, last, gain = best
        found.score(term, gain, (1.0, float(readings.edges[first]), float(readings.edges[last])))


def held_scores(
    base: Fit,
    projection: Projection,
    scaled: Scaled,
    terms: Sequence[tuple[Term, slice]],
    at: Callable[[Term, Array], Array],
    known: dict[Term, Array],
) -> Scoring:
    """Scores of inputs that stayed from some instant on, each of many intervals simulated; there are no nulls of it.

    What stays depends on the begin, so that intervals are no sums of pieces.

    Args:
        base: Converged fit.
        projection: Of that fit.
        scaled: What wrapping models make of changes of residuals.
        terms: Faults with the residuals of their recordings.
        at: Changes of all residuals by a term, of its values in shape (points, 3) to (points, residuals).
        known: Changes of its recording's residuals by a term in every interval, at an earlier fit; filled where it is
            without them.
    """
    found = _Collected(projection.draws)
    for term, own in terms:
        intervals = _held_intervals(term)

        tried = np.arange(len(intervals))
        if term in known:
            before = _gains(base, own, scaled(known[term].astype(np.float64), own))
            tried = np.argsort(-before, kind="stable")[:HELD_AGAIN]
        changes = at(term, np.column_stack([np.ones(len(tried)), intervals[tried]]))[:, own]
        with np.errstate(over="ignore"):  # of a run that goes away; its gain is none
            known.setdefault(term, changes.astype(np.float32))
        gains = _gains(base, own, scaled(changes, own))
        best = int(np.argmax(gains))
        found.tried += len(intervals)
        if np.isfinite(gains[best]):
            found.score(term, float(gains[best]), (1.0, *map(float, intervals[tried[best]])))
    return found.scoring()


def level_scores(
    base: Fit,
    projection: Projection,
    scaled: Scaled,
    terms: Sequence[tuple[Term, slice]],
    at: Callable[[Term, Array], Array],
    known: tuple[int, dict[Term, Array]],
) -> Scoring:
    """Scores of inputs that stood at another value; there are no nulls of it.

    In each piece the input is simulated at two values, and what lies between and beyond is a straight line; pieces add
    up. The best value follows for every interval, and the best intervals are simulated.

    Args:
        base: Converged fit.
        projection: Of that fit.
        scaled: What wrapping models make of changes of residuals.
        terms: Faults with the residuals of their recordings.
        at: Changes of all residuals by a term, of its values in shape (points, 4) to (points, residuals).
        known: Into how many pieces a recording is cut, and changes of its recording's residuals by a term at both
            values in every piece, at an earlier fit, shape (2, pieces, residuals); filled where it is without them.
    """
    pieces, rows_of = known
    found = _Collected(projection.draws)
    for term, own in terms:
        _, begin, _, level = term.parameters
        edges = np.linspace(begin.lower, begin.upper, pieces + 1)
        two = np.array([level.lower, level.upper])
        if term not in rows_of:
            values = np.array([(1.0, a, b, v) for v in two for a, b in pairwise(edges.tolist())])
            rows_of[term] = at(term, values)[:, own].reshape(2, pieces, -1)
        low, high = (scaled(r, own) for r in rows_of[term])
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            continue
        slope = (high - low) / (two[1] - two[0])
        best = _best_levels(base.residuals[own], low - two[0] * slope, slope, (level.lower, level.upper))
        tried = np.array([(1.0, edges[i], edges[j], v) for i, j, v in best])
        gains = _gains(base, own, scaled(at(term, tried)[:, own], own))
        top = int(np.argmax(gains))
        found.tried += pieces * (pieces + 1) // 2
        if np.isfinite(gains[top]):
            found.score(term, float(gains[top]), tuple(tried[top].tolist()))
    return found.scoring()


def _gains(base: Fit, own: slice, changes: Array) -> Array:
    """What changes of a recording's residuals gain, without another fit; -inf where one is not finite.

    Args:
        base: Converged fit.
        own: Residuals of the recording.
        changes: As wrapping models scale them, shape (points, residuals of the recording).
    """
    rows = np.repeat(base.residuals[None], len(changes), axis=0)
    rows[:, own] += changes
    gains = base.cost - np.array(costs_of(rows, base, [base.point] * len(changes)))
    return np.where(np.isfinite(gains), gains, -np.inf)


def _best_levels(
    residuals: Array, constant: Array, slope: Array, bounds: tuple[float, float]
) -> list[tuple[int, int, float]]:
    """Intervals that leave least: first piece, piece after the last, value within its bounds.

    Args:
        residuals: Shape (residuals,).
        constant: What the value 0 changes in each piece, shape (pieces, residuals).
        slope: What each unit of the value changes.
        bounds: Of the value.
    """
    count = len(slope)
    sums = [np.vstack([np.zeros(slope.shape[1]), np.cumsum(rows, axis=0)]) for rows in (constant, slope)]
    found = []
    for i in range(count):
        for j in range(i + 1, count + 1):
            rest, direction = residuals + sums[0][j] - sums[0][i], sums[1][j] - sums[1][i]
            size = float(direction @ direction)
            value = float(np.clip(-(direction @ rest) / size, *bounds)) if size > 0.0 else bounds[0]
            left = rest + value * direction
            clipped = np.minimum(np.abs(left), HUBER)
            found.append((float(np.sum(clipped * (2.0 * np.abs(left) - clipped))), i, j, value))
    return [(i, j, value) for _, i, j, value in sorted(found)[:HELD_AGAIN]]


def _held_intervals(term: Term) -> Array:
    """Begins and ends [s] that are tried of an input that stays, shape (intervals, 2)."""
    _, begin, _ = term.parameters
    begins = np.linspace(begin.lower, begin.upper, HELD_BEGINS + 1)
    ends = begins[:: HELD_BEGINS // HELD_ENDS]
    return np.array([(a, b) for a in begins for b in ends if a < b])


def input_scores(
    projection: Projection,
    scaled: Scaled,
    terms: Sequence[tuple[Term, slice]],
    slopes: Callable[[Term, Array], Array],
    pieces: int,
    rounds: int = 0,
) -> Scoring:
    """Scores of inputs that were another within an interval; responses to pieces of it add up along a straight line.

    Sensors are scored to a sample. An input whose interval is shorter than a piece would stay behind one of them that
    shows what is left of it, so that the pieces at both ends of the best interval are cut finer.

    Args:
        projection: Of the converged fit, with nulls.
        scaled: What wrapping models make of changes of residuals.
        terms: Faults with the residuals of their recordings.
        slopes: Derivatives of all residuals by the strength of a term in intervals, shape (intervals, 2).
        pieces: Into how many a recording is cut.
        rounds: How often they are cut finer.
    """
    found = _Collected(projection.draws)
    tracks = []
    for term, own in terms:
        _, begin, _ = term.parameters
        track = _Track(projection, scaled, term, own, partial(slopes, term))
        best = track.best(np.linspace(begin.lower, begin.upper, pieces + 1))
        if best is not None:
            found.add(term, best, track.edges)
            tracks.append((track, best))
    most = max((best.gain for _, best in tracks), default=0.0)
    for track, coarse in tracks:
        best = coarse
        for _ in range(rounds if coarse.gain > max(track.term.price, WORTH * most) else 0):
            best = track.best(_finer(track.edges, best)) or best
        if best.gain > coarse.gain:
            found.scores = [s for s in found.scores if s.term != track.term]
            found.score(track.term, best.gain, (best.amount, *track.edges[[best.first, best.last]].tolist()))
    return found.scoring()


class _Track:
    """An input of a recording with what a fault of it does in pieces, each of which is simulated once."""

    def __init__(
        self, projection: Projection, scaled: Scaled, term: Term, own: slice, slopes: Callable[[Array], Array]
    ) -> None:
        self.term, self.edges = term, np.zeros(0)
        self._projection, self._scaled, self._own, self._slopes = projection, scaled, own, slopes
        self._rows: dict[tuple[float, float], Array] = {}

    def best(self, edges: Array) -> Best | None:
        """The best interval between edges [s], by nulls where it is asked first; None where none can be seen."""
        is_first = not self._rows
        intervals = [(float(a), float(b)) for a, b in pairwise(edges)]
        new = [i for i in intervals if i not in self._rows]
        if new:
            self._rows.update(zip(new, self._slopes(np.array(new))[:, self._own]))
        rows = np.array([self._rows[i] for i in intervals])
        if not np.isfinite(rows).all():
            return None
        products = self._projection.pieces(self._scaled(rows, self._own), self._own)
        parts = Pieces(*products, np.ones(len(intervals), dtype=int))
        strength = self.term.parameters[0]
        found = best_interval(parts if is_first else parts.without_nulls(), 1, (strength.lower, strength.upper))
        self.edges = edges if found is not None else self.edges
        return found


def _finer(edges: Array, best: Best) -> Array:
    """Edges with those pieces cut into `FINER` that lie at either end of an interval."""
    last = len(edges) - 1
    cut = {e for end in (best.first, best.last) for e in (end - 1, end) if 0 <= e < last}
    parts = [np.linspace(edges[e], edges[e + 1], FINER + 1) for e in sorted(cut)]
    return np.unique(np.concatenate([edges, *parts]))
