"""Laws and places that the recorded channels cannot tell from a finding, whether or not the search fitted them.

Currents alone do not say which coil of a string broke: the string carries none in either case. The search fits some of
these explanations and drops others early, so its list of rivals is not the class. Here every other place of the same
law, and every law that differs in its strength alone, is simulated at the values that were fitted. What differs by less
than odds of 20 to 1 ask for, on all readings together, training and held out, is of one class.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Member
from diagnosis.judge.held_out import carried_over
from diagnosis.judge.plausibility import implausible
from diagnosis.judge.unfitted import raw_residuals
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.problem import Point, Term, strength_slopes

#: Sum of squared differences, in deviations of the noise, that odds of 20 to 1 ask for: 2 ln 20.
APART = 2.0 * float(np.log(20.0))
#: Sizes of a strength that are tried first, and how often the best one is searched between its neighbours.
SIZES, ROUNDS = 17, 4
#: Share of the law's own response beyond which a law of the best of these sizes is another response altogether: sizes
#: next to each other differ by a factor of 2, the best one by at most 1.41, which leaves (0.41)^2 of it.
OTHER = 0.25
#: Square of the cosine between a law's derivative and the response from which it is simulated at several sizes, and how
#: many are: large responses bend, so that far from parallel derivatives may belong to equal ones.
LIKE, MOST = 0.5, 12


def same_response(
    model: DiagnosisModel, point: Point, term: Term, judge: DiagnosisModel | None = None
) -> tuple[Member, ...]:
    """Members of the class of a term, without the term itself; empty where each simulation takes seconds.

    Args:
        model: Model of the training recordings.
        point: A fit with the term.
        term: One of its terms.
        judge: Model of the held-out recordings; None where there are none.
    """
    if not model.is_fast or term.recording is not None or term.unit == "measurement":
        return ()
    seen = _seen(model, point, term)
    own = _rows(model, [point, point.without(term)], seen)
    held = _HeldOut(judge, model, point)
    if float(np.sum((own[1] - own[0]) ** 2)) < APART:
        return ()  # its own response does not show: everything small would be like it
    others = [
        t
        for t in model.terms()
        if t != term
        and t.recording is None
        and t not in point.terms
        and t.unit == term.unit
        and not t.is_completing
        and not _is_same_law(model, term, t)
    ]
    found = []
    for other in _likely(model, point, term, others):
        values = _values(model, point, term, other, own, seen)
        if values is None or implausible(other, values):
            continue
        there = point.without(term).plus(other, values)
        training = float(np.sum((own[0] - _rows(model, [there], seen)[0]) ** 2))
        if training < APART and training + held.distance(there) < APART:
            found.append(Member(other.identifier, model.where(other)[1].label, other.is_named))
    return tuple(found)


def _is_same_law(model: DiagnosisModel, one: Term, other: Term) -> bool:
    """Whether two terms are one law on the same elements: `all coils` of a rig that has one, or a twin without a name.

    A generic law that does what a law of the catalogue does at the same place is that law.
    """
    first, second = (model.where(t)[1].mask for t in (one, other))
    is_one = one.identifier == other.identifier or (one.is_named and not other.is_named)
    return is_one and first is not None and second is not None and bool(np.array_equal(first, second))


def _likely(model: DiagnosisModel, point: Point, term: Term, others: Sequence[Term]) -> list[Term]:
    """The law itself at other places, and of other laws those whose small response is most like that of the term.

    A simulation of each law at each place would take minutes on a rig of 36 coils; their derivatives are made together.

    Args:
        model: Model of the training recordings.
        point: A fit with the term.
        term: The term.
        others: All that may be of its class.
    """
    found = [t for t in others if t.identifier == term.identifier]
    tasks = []
    for other in others:
        rest = _rest(term, other, point.terms[term])
        if other.identifier != term.identifier and rest is not None:
            tasks.append((other, (other.parameters[0].starts[0], *rest)))
    if not tasks:
        return found
    inner, without = model.plain, point.without(term)
    here = np.asarray(inner.residuals([without])[0])
    response = np.asarray(inner.residuals([point])[0]) - here
    slopes = np.asarray(strength_slopes(inner, without, here, tasks), dtype=np.float64)
    slopes = np.where(np.isfinite(slopes).all(axis=1, keepdims=True), slopes, 0.0)  # a law that runs away is like none
    slopes /= np.maximum(np.max(np.abs(slopes), axis=1, keepdims=True), 1e-300)  # squares overflow else
    sizes = np.maximum(np.sum(slopes**2, axis=1) * np.sum(response**2), 1e-300)
    like = (slopes @ response) ** 2 / sizes
    ranked = [n for n in np.argsort(-like).tolist() if like[n] > LIKE][:MOST]
    return [*found, *(tasks[n][0] for n in ranked)]


def _rest(term: Term, other: Term, values: Sequence[float]) -> tuple[float, ...] | None:
    """Values of another law but its strength; None where it differs in more than its strength."""
    shape = {p.name: v for p, v in zip(term.parameters[1:], values[1:])}
    if {p.name for p in other.parameters[1:]} != set(shape) or not all(p.is_instant for p in other.parameters[1:]):
        return None
    return tuple(shape[p.name] for p in other.parameters[1:])


def _values(
    model: DiagnosisModel, point: Point, term: Term, other: Term, own: Array, seen: Array
) -> tuple[float, ...] | None:
    """Values at which another law is most like a term; None where it differs in more than its strength."""
    values = point.terms[term]
    if other.identifier == term.identifier:
        return values
    rest = _rest(term, other, values)
    if rest is None:
        return None
    without, size = point.without(term), float(np.sum((own[1] - own[0]) ** 2))
    tried = np.array(list(_sizes(other)))
    for number in range(1 + ROUNDS):
        points = [without.plus(other, (float(s), *rest)) for s in tried]
        distances = np.sum((_rows(model, points, seen) - own[0]) ** 2, axis=1)
        best = int(np.argmin(distances))
        if number == 0 and distances[best] > OTHER * size:
            return None
        found = float(tried[best])
        if distances[best] < 0.01 * APART:
            break
        low, high = tried[max(best - 1, 0)], tried[min(best + 1, len(tried) - 1)]
        tried = np.linspace(low, high, 9)
    return (found, *rest)


def _sizes(term: Term) -> Iterator[float]:
    """Strengths within the bounds, rising, each twice as large as the one before; and the bounds themselves."""
    strength = term.parameters[0]
    most = max(abs(strength.lower), abs(strength.upper))
    steps = most * 0.5 ** np.arange(SIZES)
    # A share acts by what is left of it: 1 - 0.5^n are the sizes next to 1.
    near = [strength.upper * (1.0 - 0.5**n) for n in range(1, SIZES)] if strength.unit == "1" else []
    every = {strength.lower, strength.upper, *steps.tolist(), *(-steps).tolist(), *near}
    yield from sorted(s for s in every if strength.lower <= s <= strength.upper and s != 0.0)


def _seen(model: DiagnosisModel, point: Point, term: Term) -> Array:
    """1 for readings that can part two laws, 0 for those of the steps of the simulation around an instant.

    Within a step a resistance is its mean: what sets in there is spread over the step, by each law in its own way, and
    that is an error of the fast simulation and nothing that a rig does.
    """
    seen, timeline = _used(model), model.timeline
    joint = next((v for p, v in zip(term.parameters, point.terms[term]) if p.is_instant), None)
    if joint is None or timeline is None:
        return seen
    number, instant = timeline.place(joint)
    ends, begin = model.step_ends(number), 0
    if not len(ends):
        return seen
    k = int(np.searchsorted(ends, instant))
    first, last = float(ends[max(k - 2, 0)]), float(ends[min(k + 1, len(ends) - 1)])
    for run in range(number + 1):
        for series in model.runs[run].series:
            times = series.channel.times[-len(series.samples) :]
            if run == number:
                seen[begin : begin + len(times)][(times >= first) & (times <= last)] = 0.0
            begin += len(times)
    return seen


def _rows(model: DiagnosisModel, points: Sequence[Point], seen: Array) -> Array:
    """(measured - simulated) / noise, 0 where a reading does not count, shape (points, readings).

    Zeros of channels are not taken away: what differs at readings that do not count must not spread over the others.
    """
    inner = model.plain
    return np.array([raw_residuals(inner, p) * seen for p in points])


def _used(model: DiagnosisModel) -> Array:
    """1 for readings that count, else 0, shape (readings,)."""
    return np.concatenate([s.used for run in model.runs for s in run.series]).astype(np.float64)


class _HeldOut:
    """How far held-out readings lie from those of a fit.

    Args:
        judge: Model of the held-out recordings; None where there are none.
        model: Model of the training recordings.
        point: The fit.
    """

    def __init__(self, judge: DiagnosisModel | None, model: DiagnosisModel, point: Point) -> None:
        self._judge, self._model, self._point = judge, model, point

    @cached_property
    def _own(self) -> Array:
        return self._rows_at(self._point)

    def _rows_at(self, point: Point) -> Array:
        assert self._judge is not None
        return np.asarray(_rows(self._judge, [carried_over(point, self._model, self._judge)], _used(self._judge))[0])

    def distance(self, other: Point) -> float:
        """Sum of squared differences at another point, in deviations of the noise; 0 without held-out recordings."""
        return 0.0 if self._judge is None else float(np.sum((self._own - self._rows_at(other)) ** 2))
