"""Maximum a posteriori fit of all parameters and the terms that are present."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from cosim.unit import Array
from diagnosis.search.problem import Model, Point, Term

#: Residuals beyond this many deviations count linearly (Huber): one wild reading must not look like physics.
HUBER = 4.0
#: Relative step of the differences by which a term's parameters are varied.
STEP = 1e-3
#: A fit ends when -2 log posterior falls by less than this share of itself plus 1 in an iteration.
TOLERANCE = 1e-6


@dataclass(frozen=True)
class Fit:
    """A fitted model.

    Args:
        point: Values found.
        cost: -2 log posterior, up to a constant.
        residuals: Shape (residuals,), before the Huber weight.
        jacobian: Of residuals and prior by z and term parameters, with Huber weights, shape
            (residuals + parameters, parameters + term parameters).
        is_converged: Whether the search for the minimum ended there.
    """

    point: Point
    cost: float
    residuals: Array
    jacobian: Array
    is_converged: bool

    @property
    def covariance(self) -> Array:
        """Of z and the term parameters, shape (free, free); infinite where the data say nothing."""
        normal = self.jacobian.T @ self.jacobian
        scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
        inverse = np.linalg.pinv(normal / np.outer(scale, scale), hermitian=True)
        return np.asarray(inverse / np.outer(scale, scale))


def huber_weights(residuals: Array) -> Array:
    """Square roots of the weights with which residuals enter a linearised fit."""
    size = np.abs(residuals)
    return np.sqrt(np.where(size > HUBER, HUBER / np.maximum(size, HUBER), 1.0))


def cost(residuals: Array, base: Array) -> float:
    """-2 log posterior: Huber's function of the residuals and the squares of the prior's z."""
    size = np.abs(residuals)
    return float(np.sum(np.where(size > HUBER, 2 * HUBER * size - HUBER**2, size**2)) + base @ base)


class _Objective:
    """Residuals and Jacobian over z and the parameters of the terms, in scaled coordinates."""

    def __init__(self, model: Model, terms: Sequence[Term]) -> None:
        self.model, self.terms = model, list(terms)
        self.count = len(model.parameters)
        free = [p for t in terms for p in t.parameters]
        self.scale = np.array([_scale(p.starts, p.upper - p.lower) for p in free])
        bound = np.array([p.bounds for p in model.parameters])
        self.lower = np.concatenate([-bound, [p.lower / s for p, s in zip(free, self.scale)]])
        self.upper = np.concatenate([bound, [p.upper / s for p, s in zip(free, self.scale)]])

    def point(self, x: Array) -> Point:
        values = x[self.count :] * self.scale
        terms, begin = {}, 0
        for term in self.terms:
            end = begin + len(term.parameters)
            terms[term] = tuple(float(v) for v in values[begin:end])
            begin = end
        return Point(x[: self.count], terms)

    def vector(self, point: Point) -> Array:
        values = [v for t in self.terms for v in point.terms[t]]
        x = np.concatenate([point.base, np.array(values) / self.scale if values else np.zeros(0)])
        width = self.upper - self.lower
        inside = 1e-9 * np.where(np.isfinite(width), width, 1.0)
        return np.asarray(np.clip(x, self.lower + inside, self.upper - inside))

    def residuals(self, x: Array) -> Array:
        found = self.model.residuals([self.point(x)])[0]
        return np.where(np.isfinite(found), found, 1e6)  # a model that cannot be simulated is a bad one

    def cost(self, x: Array, residuals: Array) -> float:
        return cost(residuals, x[: self.count])

    def jacobian(self, x: Array, here: Array) -> Array:
        """Of the residuals by x, with Huber weights, and of the prior below, shape (residuals + parameters, free)."""
        point = self.point(x)
        columns = [self.model.base_jacobian(point)]
        steps, moved = [], []
        for i in range(self.count, len(x)):
            step = STEP * max(abs(x[i]), 1.0)
            step = step if x[i] + step < self.upper[i] else -step
            other = x.copy()
            other[i] += step
            moved.append(self.point(other))
            steps.append(step)
        if moved:
            columns.append(((self.model.residuals(moved) - here) / np.array(steps)[:, None]).T)
        found = np.hstack(columns)
        prior = np.zeros((self.count, len(x)))
        prior[:, : self.count] = np.eye(self.count)
        return np.vstack([np.where(np.isfinite(found), found, 0.0) * huber_weights(here)[:, None], prior])


def _scale(starts: Sequence[float], width: float) -> float:
    sizes = [abs(s) for s in starts if s]
    if sizes:
        return float(np.median(sizes))
    return width if np.isfinite(width) else 1.0


def fit(model: Model, start: Point, iterations: int = 60) -> Fit:
    """Fit all parameters of the model and of the terms in `start`, from there.

    Levenberg-Marquardt on the normal equations, which the prior keeps well conditioned; bounds are kept by leaving out
    what would pass them.

    Args:
        model: Model and recordings.
        start: Where the search begins; its terms are those that are fitted.
        iterations: Most Jacobians.

    Returns:
        The fit, converged or not: it says so.

    Source: Nocedal, Wright, Numerical Optimization, 2nd ed., Springer 2006, sections 10.3 and 16.7.
    """
    objective = _Objective(model, list(start.terms))
    x = objective.vector(start)
    here = objective.residuals(x)
    value, damping, is_converged = objective.cost(x, here), 1e-3, False
    for _ in range(iterations):
        jacobian = objective.jacobian(x, here)
        weighted = np.concatenate([huber_weights(here) * here, x[: objective.count]])
        normal, slope = jacobian.T @ jacobian, jacobian.T @ weighted
        before = value
        x, here, value, damping = _descend(objective, (x, here, value), (normal, slope), damping)
        if before - value <= TOLERANCE * (1.0 + before):
            is_converged = True
            break
    jacobian = objective.jacobian(x, here)
    jacobian[:, objective.count :] /= objective.scale
    return Fit(objective.point(x), value, model.residuals([objective.point(x)])[0], jacobian, is_converged)


def _descend(
    objective: _Objective, now: tuple[Array, Array, float], quadratic: tuple[Array, Array], damping: float
) -> tuple[Array, Array, float, float]:
    """One accepted step, or none where no damping brings the cost down."""
    x, here, value = now
    normal, slope = quadratic
    size = np.maximum(np.diag(normal), 1e-12)
    for _ in range(12):
        is_held = ((x <= objective.lower) & (slope > 0)) | ((x >= objective.upper) & (slope < 0))
        free = np.flatnonzero(~is_held)
        damped = normal[np.ix_(free, free)] + np.diag(damping * size[free])
        step = np.zeros_like(x)
        step[free] = -cho_solve(cho_factor(damped), slope[free])
        other = np.clip(x + step, objective.lower, objective.upper)
        there = objective.residuals(other)
        cost_there = objective.cost(other, there)
        if cost_there < value:
            return other, there, cost_there, max(damping / 8.0, 1e-9)
        damping *= 6.0
    return x, here, value, damping


def fit_best(model: Model, starts: Sequence[Point], iterations: int = 60) -> Fit:
    """The best of fits from several starts (second masses are found from one of them alone in a quarter of cases)."""
    return min((fit(model, start, iterations) for start in starts), key=lambda f: f.cost)
