"""A model and the terms that are fitted as one function of scaled coordinates within bounds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.search.posterior import cost
from diagnosis.search.problem import Model, Point, Term, TermParameter, limits_of

#: Deviations beyond which residuals are all the same.
RUNAWAY = 1e6
#: Share of the way to its bound within which a parameter lies at it.
AT_BOUND = 1e-4
#: Relative step of the differences by which a term's parameters are varied.
STEP = 1e-3
#: Scale of an instant in distances of those that are scanned: half of a recording.
SCAN = 20.0


class Objective:
    """Residuals and their derivatives over z and the parameters of the terms, in scaled coordinates.

    Args:
        model: Model and recordings.
        terms: Those that are fitted.
        widths: Deviation of the prior of each parameter, in its own deviations, shape (parameters,).
    """

    def __init__(self, model: Model, terms: Sequence[Term], widths: Array) -> None:
        self.model, self.terms, self.widths = model, list(terms), widths
        self.count = len(model.parameters)
        free = [p for t in terms for p in t.parameters]
        self.scale = np.array([_scale(p) for p in free])
        self._is_instant = np.array([p.is_instant for p in free], dtype=bool)
        bound = np.array([p.bounds for p in model.parameters]) * widths
        limits = [limits_of(model, p) for p in free]
        least = [high if p.is_switch else low for p, (low, high) in zip(free, limits)]
        self.lower = np.concatenate([-bound, [low / s for low, s in zip(least, self.scale)]])
        self.upper = np.concatenate([bound, [high / s for (_, high), s in zip(limits, self.scale)]])

    def point(self, x: Array) -> Point:
        """The point that scaled coordinates mean."""
        values = x[self.count :] * self.scale
        terms, begin = {}, 0
        for term in self.terms:
            end = begin + len(term.parameters)
            terms[term] = tuple(float(v) for v in values[begin:end])
            begin = end
        return Point(x[: self.count], terms)

    def vector(self, point: Point) -> Array:
        """Scaled coordinates of a point, a hair within their bounds."""
        values = [v for t in self.terms for v in point.terms[t]]
        x = np.concatenate([point.base, np.array(values) / self.scale if values else np.zeros(0)])
        width = self.upper - self.lower
        inside = 1e-9 * np.where(np.isfinite(width), width, 1.0)
        return np.asarray(np.clip(x, self.lower + inside, self.upper - inside))

    def residuals(self, x: Array) -> Array:
        """Residuals, shape (residuals,), always finite."""
        return bounded(self.model.residuals([self.point(x)])[0])

    def held(self, x: Array) -> AnyArray:
        """Which parameters of the model lie at a bound: bounded steps end there, but for rounding."""
        base, width = x[: self.count], self.upper[: self.count]
        return np.asarray(np.abs(base) >= (1.0 - AT_BOUND) * width)

    def cost(self, x: Array, residuals: Array) -> float:
        """-2 log posterior, up to a constant."""
        return cost(residuals, x[: self.count], self.widths)

    def base_columns(self, x: Array) -> Array:
        """Derivatives by z, shape (residuals, parameters)."""
        found = self.model.base_jacobian(self.point(x))
        is_sane = np.abs(found) < RUNAWAY * RUNAWAY
        return found if is_sane.all() else np.where(is_sane, found, 0.0)

    def term_columns(self, x: Array, here: Array) -> Array:
        """Derivatives by the terms' scaled parameters, shape (residuals, term parameters)."""
        steps, moved = [], []
        for i in range(self.count, len(x)):
            # An instant has no size: a step of the axis is as good at its end as at its begin.
            step = STEP * (1.0 if self._is_instant[i - self.count] else max(abs(x[i]), 1.0))
            step = step if x[i] + step < self.upper[i] else -step
            other = x.copy()
            other[i] += step
            moved.append(self.point(other))
            steps.append(step)
        if not moved:
            return np.zeros((len(here), 0))
        with np.errstate(over="ignore", invalid="ignore"):  # what runs away is left out below
            found = ((self.model.residuals(moved) - here) / np.array(steps)[:, None]).T
        return np.where(np.abs(found) < RUNAWAY * RUNAWAY, found, 0.0)


def bounded(residuals: Array) -> Array:
    """Residuals of at most `RUNAWAY`: a model that cannot be simulated, or runs away, is a bad one, and has a cost."""
    return np.clip(np.where(np.isfinite(residuals), residuals, RUNAWAY), -RUNAWAY, RUNAWAY)


def _scale(parameter: TermParameter) -> float:
    width = parameter.upper - parameter.lower
    sizes = [abs(s) for s in parameter.starts if s]
    if parameter.is_instant and len(parameter.scan) > 1:  # of one recording, however many there are
        return float(SCAN * np.median(np.diff(parameter.scan)))
    if sizes:
        return float(np.median(sizes))
    return width if np.isfinite(width) else 1.0
