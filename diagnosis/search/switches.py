"""Laws that are there or not (a clipped sensor) where a recalibration was pulled away by what is missing.

Such a law has no straight line: a little of it says nothing about all of it. From a base that was pulled away the
simulated currents may all lie below the ceiling that cut the readings off; from the nominal point they do not.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import cost
from diagnosis.search.problem import Model, Point, Term, strength_slopes
from diagnosis.search.score import BATCH, Score, shapes

#: Prior deviations beyond which a recalibration has been pulled away by what is missing.
STRAINED = 4.0
#: Share of -2 log posterior by which derivatives may misjudge a law that is wholly there: they have single precision.
ROUGH = 1e-3


def is_strained(base: Fit) -> bool:
    """Whether a parameter of the model was pulled far from what was believed of it."""
    return bool(np.max(np.abs(base.point.base / base.widths), initial=0.0) > STRAINED)


def costs_at(model: Model, base: Fit, points: Sequence[Point]) -> list[float]:
    """-2 log posterior at points, with the prior's widths of a fit; infinite where a simulation failed."""
    found: list[float] = []
    for begin in range(0, len(points), BATCH):  # many recordings have many instants, and residuals take memory
        part = points[begin : begin + BATCH]
        found += costs_of(model.residuals(part), base, part)
    return found


def costs_of(residuals: Array, base: Fit, points: Sequence[Point]) -> list[float]:
    """The same of residuals at hand, shape (points, residuals)."""
    return [cost(v, p.base, base.widths) if np.isfinite(v).all() else np.inf for v, p in zip(residuals, points)]


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
        part = _hopeful(model, base, nominal, tasks[begin : begin + BATCH])
        for (term, values), there in zip(part, costs_at(model, base, [nominal.plus(*task) for task in part])):
            gain = base.cost - there
            if gain > 0.0 and (term not in best or gain > best[term].gain):
                best[term] = Score(term, values, float(gain), 1.0)
    return sorted(best.values(), key=lambda s: -s.gain)


def _hopeful(
    model: Model, base: Fit, nominal: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]
) -> list[tuple[Term, tuple[float, ...]]]:
    """Those that may gain something, and those whose derivative failed.

    The derivative of a switch is a difference over its whole size, so that it tells what the switch does, but for
    rounding. A network makes those of many coils, strings and sensors with one simulation.
    """
    here = model.residuals([nominal])[0]
    if not tasks or not np.isfinite(here).all() or any(t.recording is not None for t in nominal.terms):
        return list(tasks)  # derivatives do not see what the fault of a sensor does to them
    with np.errstate(over="ignore", invalid="ignore"):
        rows = strength_slopes(model, nominal, here, tasks) * np.array([v[0] for _, v in tasks])[:, None] + here
    costs = [cost(row, nominal.base, base.widths) if np.isfinite(row).all() else 0.0 for row in rows]
    return [task for task, there in zip(tasks, costs) if base.cost > (1.0 - ROUGH) * there]
