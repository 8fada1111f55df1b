"""Maximum a posteriori fit of all parameters and the terms that are present."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError

from cosim.compute.steps import share
from cosim.unit.protocol import AnyArray, Array
from diagnosis.search.bounded import bounded_step
from diagnosis.search.objective import Objective
from diagnosis.search.posterior import huber_weights
from diagnosis.search.problem import Model, Point, refined

#: A fit ends when a step is expected to lower -2 log posterior by less than this share of itself plus 1.
TOLERANCE = 1e-6
#: Derivatives by the model's own parameters are taken anew after a step that gains less than this share of its promise.
TRUSTED = 0.6
#: ... or where a parameter moved by more than this since [prior deviations]; less where they disappoint.
MOVED, NEAR = 1.5, 0.2
#: Mean change of the weights from which the normal matrix is made anew.
REWEIGHED = 0.005
#: Most times that a fit near another takes them anew: it is a trial, and what is good is fitted to the end.
REFRESHES = 3


@dataclass(frozen=True)
class Columns:
    """Derivatives of the residuals by z.

    Args:
        values: Shape (residuals, parameters).
        at: z at which they were taken, shape (parameters,).
        normal: values' W^2 values with the Huber weights W there, shape (parameters, parameters).
        weights: W, shape (residuals,).
    """

    values: Array
    at: Array
    normal: Array
    weights: Array

    def for_now(self, residuals: Array) -> Columns:
        """The same with the weights of other residuals, where these differ by more than `REWEIGHED`.

        Where a term takes large residuals away, what counted linearly counts in full again.
        """
        change = float(np.mean(np.abs(huber_weights(residuals) ** 2 - self.weights**2)))
        return Columns.of(self.values, self.at, residuals) if change > REWEIGHED else self

    @staticmethod
    def of(values: Array, at: Array, residuals: Array) -> Columns:
        weights = huber_weights(residuals)
        weighted = values * weights.astype(values.dtype)[:, None]
        return Columns(values, at.copy(), np.asarray(weighted.T @ weighted, dtype=np.float64), weights)


@dataclass(frozen=True)
class Fit:
    """A fitted model.

    Args:
        point: Values found.
        cost: -2 log posterior, up to a constant.
        residuals: Shape (residuals,), before the Huber weight.
        columns: Derivatives of the residuals by z; they may have been taken near the point and not at it.
        term_columns: Derivatives of the residuals by the parameters of the terms, shape (residuals, term parameters).
        is_converged: Whether the search for the minimum ended there.
        widths: Deviation of the prior of each parameter, in its own deviations: 1 unless the recordings show that coils
            scatter more than was stated, shape (parameters,).
        held: Which parameters lie at a bound, shape (parameters,); None: none.
    """

    point: Point
    cost: float
    residuals: Array
    columns: Columns
    term_columns: Array
    is_converged: bool
    widths: Array
    held: AnyArray | None = None

    @cached_property
    def jacobian(self) -> Array:
        """Of the residuals by z and term parameters, shape (residuals, parameters + term parameters)."""
        return np.hstack([self.columns.values, self.term_columns.astype(self.columns.values.dtype)])

    @cached_property
    def information(self) -> Array:
        """Normal matrix of residuals and prior with Huber weights, shape (free, free)."""
        weighted = self.jacobian * huber_weights(self.residuals).astype(self.jacobian.dtype)[:, None]
        normal = np.asarray(weighted.T @ weighted, dtype=np.float64)
        base = np.arange(len(self.point.base))
        normal[base, base] += self.widths**-2.0
        return normal

    @cached_property
    def covariance(self) -> Array:
        """Of z and the term parameters, shape (free, free); infinite where the data say nothing."""
        normal = self.information
        scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
        inverse = np.linalg.pinv(normal / np.outer(scale, scale), hermitian=True)
        return np.asarray(inverse / np.outer(scale, scale))


def fit(
    model: Model,
    start: Point,
    iterations: int = 60,
    near: Fit | None = None,
    widths: Array | None = None,
    refreshes: int = REFRESHES,
) -> Fit:
    """Fit all parameters of the model and of the terms in `start`, from there.

    Levenberg-Marquardt on the normal equations, which the prior keeps well conditioned; bounds are kept by leaving out
    what would pass them. Derivatives by the terms' parameters are fresh in every iteration; those by the model's own
    parameters, of which there are hundreds, are kept as long as steps gain what they promise (a chord method).

    Args:
        model: Model and recordings.
        start: Where the search begins; its terms are those that are fitted.
        iterations: Most steps.
        near: A fit whose derivatives by the model's own parameters are good enough to begin with; its widths hold.
        widths: See `Fit`; None: those of `near`, or 1.
        refreshes: How often a fit near another takes those derivatives anew.

    Returns:
        The fit, converged or not: it says so. Where the model has to simulate more exactly there, it goes on from
        there until that changes nothing.

    Source: Nocedal, Wright, Numerical Optimization, 2nd ed., Springer 2006, sections 10.3 and 16.7; chord: Kelley,
    Iterative Methods for Linear and Nonlinear Equations, SIAM 1995, section 5.4.
    """
    if widths is None:
        widths = np.ones(len(model.parameters)) if near is None else near.widths
    objective = Objective(model, list(start.terms), widths)
    x = objective.vector(start)
    here = objective.residuals(x)
    count = objective.count
    columns = Columns.of(objective.base_columns(x), x[:count], here) if near is None else near.columns.for_now(here)
    is_fresh, poor, taken = near is None, 0, 0
    most = iterations if near is None else refreshes
    value, damping, is_converged = objective.cost(x, here), 1e-3, False
    terms = objective.term_columns(x, here)
    farthest = 0.0
    for _ in range(iterations):
        other, there, gained, promised, damping = _descend(objective, (x, here, value), (columns, terms), damping)
        x, here, value = other, there, value - gained
        farness = max(float(np.log(max(promised, 1e-300) / (TOLERANCE * (1.0 + value)))), 0.0)  # 0: converged
        farthest = max(farthest, farness)
        share(1.0 - farness / farthest if farthest else 1.0)
        moved = float(np.max(np.abs(x[:count] - columns.at), initial=0.0))
        if promised <= TOLERANCE * (1.0 + value) and (moved <= MOVED or taken >= most):
            is_converged = True
            break
        if gained == 0.0 and (is_fresh or taken >= most):
            break
        poor = poor + 1 if gained < TRUSTED * promised else 0
        columns = columns.for_now(here)
        is_fresh = moved > MOVED or gained == 0.0 or (poor > 0 and moved > NEAR) or poor > 1
        if is_fresh and taken < most:
            taken += 1
            columns, poor, damping = Columns.of(objective.base_columns(x), x[:count], here), 0, 1e-3
        terms = objective.term_columns(x, here)
    point = objective.point(x)
    if refined(model, point):
        return fit(model, point, iterations, near, widths, refreshes)
    return Fit(point, value, here, columns, terms / objective.scale, is_converged, widths, objective.held(x))


def _descend(
    objective: Objective, now: tuple[Array, Array, float], slopes: tuple[Columns, Array], damping: float
) -> tuple[Array, Array, float, float, float]:
    """One accepted step, or none where no damping brings the cost down.

    Returns:
        Where it ended, residuals there, gain, the gain that was promised at the least damping, damping for the next.
    """
    x, here, value = now
    normal, slope = _quadratic(objective.widths, x, here, slopes)
    size = np.maximum(np.diag(normal), 1e-12)
    expected = 0.0
    for _ in range(12):
        try:
            other = x + bounded_step(normal + np.diag(damping * size), slope, objective.lower - x, objective.upper - x)
        except LinAlgError:  # single precision made it indefinite
            damping *= 6.0
            continue
        moved = other - x
        promised = float(-2.0 * slope @ moved - moved @ normal @ moved)
        expected = max(promised, expected)
        there = objective.residuals(other)
        cost_there = objective.cost(other, there)
        if cost_there < value:
            return other, there, value - cost_there, expected, max(damping / 8.0, 1e-9)
        if promised <= TOLERANCE * (1.0 + value):
            break
        damping *= 6.0
    return x, here, 0.0, expected, damping


def _quadratic(widths: Array, x: Array, here: Array, slopes: tuple[Columns, Array]) -> tuple[Array, Array]:
    """Normal matrix and half the slope of -2 log posterior."""
    columns, terms = slopes
    count = len(widths)
    pull = huber_weights(here) ** 2 * here
    weighted = terms * (columns.weights**2)[:, None]
    sides = np.column_stack([pull, weighted]).astype(columns.values.dtype)
    across = np.asarray(columns.values.T @ sides, dtype=np.float64)
    normal = np.zeros((len(x), len(x)))
    normal[:count, :count] = columns.normal + np.diag(widths**-2.0)
    normal[:count, count:] = across[:, 1:]
    normal[count:, :count] = across[:, 1:].T
    normal[count:, count:] = terms.T @ weighted
    slope = np.concatenate([across[:, 0] + x[:count] / widths**2, terms.T @ pull])
    return normal, slope


def fit_best(
    model: Model, starts: Sequence[Point], iterations: int = 60, near: Fit | None = None, refreshes: int = REFRESHES
) -> Fit:
    """The best of fits from several starts (second masses are found from one of them alone in a quarter of cases)."""
    return min((fit(model, start, iterations, near, refreshes=refreshes) for start in starts), key=lambda f: f.cost)
