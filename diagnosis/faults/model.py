"""A model whose sensors and inputs may have been at fault for a while, in one recording alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.faults.law import (
    AGAIN,
    DRIFT,
    FEWEST,
    HELD,
    LATE,
    LEVEL,
    LONGEST_LAG,
    OCCASIONS,
    OF_INPUTS,
    OF_THE_RIG,
    OFFSET,
    RISE,
    SCALED,
    SLOWER,
    STUCK,
    WHOLLY,
    FaultLaw,
    clock_offset,
    fault_term,
    is_one_of,
    lag_time,
    sensor_gain,
)
from diagnosis.faults.readings import ACTS, Readings, readings_of
from diagnosis.faults.scan import held_scores, input_scores, level_scores, sensor_scores
from diagnosis.models.protocol import DiagnosisModel, Effect, Labelled, Scaled, Spot, unscaled
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.recording.equal_readings import FEWEST_EQUAL, ends_of_runs
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Point, Term, TermParameter, strength_slopes
from diagnosis.search.score import Projection, Scoring
from diagnosis.search.structure import structure

#: What derivatives of the plain residuals become under each fault that changes them.
_SEEN: Mapping[str, Callable[[Readings, Array, float, float, float], Array]] = {
    SCALED.identifier: Readings.scaled,
    RISE.identifier: Readings.scaled,
    STUCK.identifier: lambda readings, rows, share, begin, end: readings.scaled(rows, -share, begin, end),
    SLOWER.identifier: Readings.slower,
    LATE.identifier: Readings.shifted,
}
_LAWS = {law.identifier: law for law in (OFFSET, DRIFT, SCALED, RISE, STUCK, SLOWER, LATE, *OF_INPUTS, *OF_THE_RIG)}
#: Samples by which begin and end are moved to look for a better interval near the one found. Where an input is nearly
#: zero, a change of its gain tells nothing of its end, which is only seen from beyond.
_FAR = (1, 2, 3, 5, 8, 13, 21, 34, 55, 89)
_MOVES = (*(-m for m in reversed(_FAR)), *_FAR)
#: Pieces of a recording in which a change of an input is simulated: by the coil network, and where a run takes seconds.
PIECES, FEW_PIECES = 16, 12
#: How often pieces at both ends of the best interval of an input are cut finer, where a simulation takes no seconds.
ROUNDS = 2


class FaultyModel(WrappedModel):
    """A model with faults of one recording that have begin and end, as terms beside the laws.

    They are not among `terms`, which are tried at every start value: `interval_scores` finds the intervals that are
    worth a fit, and another model of other recordings does not know them.

    Args:
        inner: The model that simulates.
    """

    def __init__(self, inner: DiagnosisModel) -> None:
        super().__init__(inner)
        self.readings = readings_of(inner)
        #: What inputs that stayed change, see `diagnosis.faults.scan.held_scores`.
        self._held: dict[Term, Array] = {}
        #: What inputs at two values change in each piece, see `diagnosis.faults.scan.level_scores`.
        self._levels: dict[Term, Array] = {}
        #: Faults of sensors with the channel of each.
        self.sensor_terms: dict[Term, Readings] = {}
        for readings in self.readings:
            for again in range(OCCASIONS):
                label = readings.label + (AGAIN if again else "")
                drift = readings.offset("change of the reading at the end of the interval")
                kinds = [(OFFSET, readings.offset()), (DRIFT, drift), (STUCK, WHOLLY), *_gains_of(readings)]
                kinds += [] if again else _of_time(readings)
                for law, strength in kinds:
                    term = fault_term(law, label, strength, readings.span, readings.recording)
                    self.sensor_terms[term] = readings

    def faults(self) -> tuple[Term, ...]:
        """Every fault that the search tries beside the laws; those of inputs are simulated by the inner model."""
        return (*self.sensor_terms, *self.input_terms())

    def inside(self, point: Point) -> Point:
        """The point without faults of sensors."""
        if not any(t in self.sensor_terms for t in point.terms):
            return point
        return Point(point.base, {t: v for t, v in point.terms.items() if t not in self.sensor_terms})

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`; points that differ in faults of sensors alone are simulated once."""
        inner = [self.inside(p) for p in points]
        keys = [(p.base.tobytes(), tuple(p.terms.items())) for p in inner]
        different = dict(zip(keys, inner))
        place = {key: n for n, key in enumerate(different)}
        values = self.inner.residuals(list(different.values()))
        found = values if len(different) == len(points) else values[[place[key] for key in keys]]
        for row, point in zip(found, points):
            for readings, faults in self._faults(point):
                own = row[readings.own]
                if np.isfinite(own).all():
                    row[readings.own] = readings.residuals(_acted(readings, readings.plain(own), faults))
        return found

    def _faults(self, point: Point) -> Iterator[tuple[Readings, list[tuple[Term, tuple[float, ...]]]]]:
        """Channels that are at fault, with their faults."""
        found: dict[Readings, list[tuple[Term, tuple[float, ...]]]] = {}
        for term, values in point.terms.items():
            if term in self.sensor_terms:
                found.setdefault(self.sensor_terms[term], []).append((term, values))
        yield from found.items()

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`; a sensor that is stuck sees no parameter, another gain sees more."""
        found = super().base_jacobian(point)
        for readings, faults in self._faults(point):
            moving = [(t, v) for t, v in faults if t.identifier in _SEEN]
            if found.shape[1] and moving:
                rows = np.array([readings.plain(c) for c in found[readings.own].T.astype(np.float64)])
                for term, (strength, begin, end) in moving:
                    rows = _SEEN[term.identifier](readings, rows, strength, begin, end)
                found[readings.own] = readings.residuals(rows).T
        return found

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """Derivative of the residuals by the strength of terms, shape (tasks, residuals)."""
        own = [i for i, (term, _) in enumerate(tasks) if term in self.sensor_terms]
        others = [i for i, (term, _) in enumerate(tasks) if term not in self.sensor_terms]
        if not own:  # a copy of many derivatives takes as long as some of the simulations
            return super().slopes(point, tasks)
        found = np.zeros((len(tasks), len(self.layout.time)))
        if others:
            found[others] = super().slopes(point, [tasks[i] for i in others])
        if own:
            moved = self.residuals([point, *(point.plus(*tasks[i]) for i in own)])
            found[own] = (moved[1:] - moved[0]) / np.array([tasks[i][1][0] for i in own])[:, None]
        return found

    def where(self, term: Term) -> tuple[Effect, Spot]:
        """What a term says about itself, and where it acts."""
        if term.recording is None:
            return super().where(term)
        readings = self.sensor_terms.get(term)
        return _LAWS[term.identifier], Labelled(term.place, None if readings is None else (readings.number,))

    def shows_in(self, term: Term) -> tuple[Sequence[int], bool] | None:
        """See `diagnosis.search.focus.Local`."""
        if term.recording is None:
            return super().shows_in(term)
        readings = self.sensor_terms.get(term)
        return None if readings is None else ((readings.number,), False)

    def scale_uncertainty(self, term: Term) -> Sequence[float]:
        """See `DiagnosisModel`."""
        return super().scale_uncertainty(term) if term.recording is None else (0.0,) * len(term.parameters)

    def predict(self, point: Point, run: int) -> Sequence[Array]:
        """Simulated values of every channel of a recording at its samples, SI, as its sensors read them."""
        values = list(super().predict(point, run))
        first = next(n for n, r in enumerate(self.readings) if r.recording == run)
        for readings, faults in self._faults(point):
            if readings.recording == run:
                simulated = values[readings.number - first]
                plain = (readings.measured - simulated) / readings.deviation
                values[readings.number - first] = np.asarray(
                    readings.measured - readings.deviation * _acted(readings, plain, faults)
                )
        return values

    def interval_scores(self, base: Fit, projection: Projection, scaled: Scaled = unscaled) -> Scoring:
        """The best interval of every fault, scored as laws are, their price taken off.

        Args:
            base: Converged fit, of this model or of one that wraps it.
            projection: Of that fit, with nulls.
            scaled: What wrapping models make of changes of residuals.
        """
        tracks: dict[int, list[Term]] = {}
        for term, readings in self.sensor_terms.items():
            if term not in base.point.terms:
                tracks.setdefault(readings.number, []).append(term)
        found = sensor_scores(base, projection, scaled, [(self.readings[n], t) for n, t in tracks.items()])
        return found.joined(self._input_scores(base, projection, scaled))

    def _input_scores(self, base: Fit, projection: Projection, scaled: Scaled) -> Scoring:
        terms = [t for t in self.input_terms() if t not in base.point.terms]
        draws = projection.draws
        if not terms or structure(base.residuals, self.layout).is_noise:
            return Scoring([], 0, np.zeros(draws), (None,) * draws)

        def slopes(term: Term, intervals: Array) -> Array:
            step = term.parameters[0].starts[0]
            tasks = [(term, (step, float(a), float(b))) for a, b in intervals]
            return strength_slopes(self, base.point, None, tasks)

        def at(term: Term, values: Array) -> Array:
            rows = self.residuals([base.point, *(base.point.plus(term, tuple(map(float, v))) for v in values)])
            return np.asarray(rows[1:] - rows[0])

        own = {r: self._residuals_of(r) for r in {t.recording for t in terms}}
        pieces = PIECES if self.is_fast else FEW_PIECES
        held = [(t, own[t.recording]) for t in terms if t.identifier == HELD.identifier]
        levels = [(t, own[t.recording]) for t in terms if t.identifier == LEVEL.identifier]
        others = [(t, own[t.recording]) for t in terms if not is_one_of(t.identifier, (HELD, LEVEL))]
        has_time = self.is_fast or self.can_be_searched_again
        found = input_scores(projection, scaled, others, slopes, pieces, ROUNDS if has_time else 0)
        if held:
            found = found.joined(held_scores(base, projection, scaled, held, at, self._held))
        if levels:
            found = found.joined(level_scores(base, projection, scaled, levels, at, (pieces, self._levels)))
        return found

    def _residuals_of(self, recording: int | None) -> slice:
        every = [r.own for r in self.readings if r.recording == recording]
        return slice(every[0].start, every[-1].stop)

    def near_intervals(self, point: Point) -> Iterator[Point]:
        """The same with the begin or end of one of its faults some samples elsewhere, or both together, or at the ends.

        Between two pulses of an input nothing tells when its fault ended: samples nearby say as little, and the end of
        the recording takes the pulses after that in.
        """
        for term, values in point.terms.items():
            if term.recording is None:
                continue
            strength, begin, end, *more = values
            edges = self._edges(term)
            places = [int(np.argmin(np.abs(edges - v))) for v in (begin, end)]
            known = {tuple(places)}
            whole = (0, len(edges) - 1)
            if term in self.sensor_terms:
                known.add(whole)  # that is a bias of the sensor
            for a, b in (*_intervals_near(places[0], places[1], len(edges) - 1), whole):
                if a < b and (a, b) not in known:
                    known.add((a, b))
                    yield point.plus(term, (strength, float(edges[a]), float(edges[b]), *more))
            yield from self._standing_still(point, term, (places[0], places[1]))

    def _standing_still(self, point: Point, term: Term, interval: tuple[int, int]) -> Iterator[Point]:
        """The same with a sensor that repeats one value in the place of another fault of it that acts there.

        An offset or a gain over two such stretches at once explains more than one of them that stands still, and is
        found first.
        """
        readings = self.sensor_terms.get(term)
        if readings is None or term.identifier == STUCK.identifier:
            return
        still = fault_term(STUCK, term.place, WHOLLY, readings.span, readings.recording)
        if still not in self.sensor_terms or still in point.terms:
            return
        ends = ends_of_runs(readings.measured, FEWEST_EQUAL)
        for first, last in zip(ends[0].tolist(), ends[1].tolist()):
            both = min(last, interval[1]) - max(first, interval[0])
            if both > 0.5 * (last - first):
                values = (1.0, float(readings.edges[first]), float(readings.edges[last]))
                yield point.without(term).plus(still, values)

    def _edges(self, term: Term) -> Array:
        readings = self.sensor_terms.get(term)
        if readings is not None:
            return readings.edges
        return max((r.edges for r in self.readings if r.recording == term.recording), key=len)


def _intervals_near(begin: int, end: int, last: int) -> Iterator[tuple[int, int]]:
    """Numbers of the edges of other intervals: some samples elsewhere, and up to either end of the recording."""
    for move in _MOVES:
        for first, second in ((move, 0), (0, move), (move, move)):
            yield min(max(begin + first, 0), last), min(max(end + second, 0), last)
    yield from ((0, end), (begin, last))


def _gains_of(readings: Readings) -> Iterator[tuple[FaultLaw, TermParameter]]:
    """A gain of the reading, or of its rise where its zero is far away; none of a sensor that shows one value."""
    if readings.has_gain:
        yield SCALED, sensor_gain()
    elif len(readings.measured) and np.ptp(readings.measured) > 0.0:
        yield RISE, sensor_gain("the departure from its first reading")


def _of_time(readings: Readings) -> list[tuple[FaultLaw, TermParameter]]:
    """A lag and a clock that is off, of what moves."""
    if len(readings.measured) < FEWEST or not np.ptp(readings.measured) > 0.0:
        return []
    longest = LONGEST_LAG * (readings.span.end - readings.span.begin)
    return [(SLOWER, lag_time(readings.step, longest)), (LATE, clock_offset(readings.step, longest))]


def _acted(readings: Readings, plain: Array, faults: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
    """Plain residuals of a channel with its faults."""
    for term, (strength, begin, end) in faults:
        plain = ACTS[term.identifier](readings, plain, strength, begin, end)
    return plain


def with_faults(model: DiagnosisModel) -> FaultyModel:
    """The model, with faults of each of its recordings."""
    return FaultyModel(model)
