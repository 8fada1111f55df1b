"""Laws that are there or not (a clipped sensor) where a recalibration was pulled away by what is missing.

Such a law has no straight line: a little of it says nothing about all of it. From a base that was pulled away the
simulated currents may all lie below the ceiling that cut the readings off; from the nominal point they do not.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.search.fit import Fit
from diagnosis.search.posterior import cost
from diagnosis.search.problem import Model, Point, Term
from diagnosis.search.score import BATCH, Score, shapes

#: Prior deviations beyond which a recalibration has been pulled away by what is missing.
STRAINED = 4.0


def is_strained(base: Fit) -> bool:
    """Whether a parameter of the model was pulled far from what was believed of it."""
    return bool(np.max(np.abs(base.point.base / base.widths), initial=0.0) > STRAINED)


def costs_at(model: Model, base: Fit, points: Sequence[Point]) -> list[float]:
    """-2 log posterior at points, with the prior's widths of a fit; infinite where a simulation failed."""
    found: list[float] = []
    for begin in range(0, len(points), BATCH):  # many recordings have many instants, and residuals take memory
        part = points[begin : begin + BATCH]
        values = model.residuals(part)
        found += [cost(v, p.base, base.widths) if np.isfinite(v).all() else np.inf for v, p in zip(values, part)]
    return found


def nominal_of(base: Fit) -> Point:
    """The point where all parameters are as believed, terms as they are."""
    return Point(np.zeros_like(base.point.base), base.point.terms)


def switch_scores(model: Model, base: Fit, terms: Sequence[Term]) -> list[Score]:
    """Scores of laws that are there or not, by what they gain at the nominal point; none where the base holds.

    Args:
        model: Model and recordings.
        base: Converged fit without the terms.
        terms: Of all kinds; each switch is tried with every combination of its other starts.

    Returns:
        One score for each that explains more from the nominal point than the base does, best first.
    """
    if not is_strained(base):
        return []
    tasks = [
        (term, (term.parameters[0].upper, *rest))
        for term in terms
        if term.parameters[0].is_switch and term not in base.point.terms
        for _, *rest in shapes(term)
    ]
    nominal = nominal_of(base)
    best: dict[Term, Score] = {}
    for begin in range(0, len(tasks), BATCH):
        part = tasks[begin : begin + BATCH]
        for (term, values), there in zip(part, costs_at(model, base, [nominal.plus(*task) for task in part])):
            gain = base.cost - there
            if gain > 0.0 and (term not in best or gain > best[term].gain):
                best[term] = Score(term, values, float(gain), 1.0)
    return sorted(best.values(), key=lambda s: -s.gain)
