"""Whether readings reject a model within the error of its fitted numbers.

A fit knows its numbers to a posterior covariance S. Readings that it was not fitted to scatter about its prediction by
I + J S J^T, in deviations of the noise, J being their derivatives: r^T (I + J S J^T)^-1 r has a chi-square distribution
with as many degrees of freedom as readings. That is the least of |r(x)|^2 + (x - m)^T S^-1 (x - m): what is left once
the numbers moved from the fitted ones, m, with the price of the move. It is looked for here with the model itself and
not with its derivatives, so that a model that is called right can do what is said of it.

S comes from the noise as it is stated: without weights of wild readings, priors as wide as stated, and nothing for a
number at its bound. Else a wrong model, whose residuals are large, would excuse itself.

Source: prediction with estimated parameters, G. A. F. Seber and A. J. Lee, Linear Regression Analysis, 2nd ed., Wiley
2003, section 5.3; the marginal likelihood of a linear Gaussian model, A. Gelman et al., Bayesian Data Analysis, 3rd ed.
2013, section 14.8.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.coil_network.runs import ZERO
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.objective import AT_BOUND, Objective
from diagnosis.search.problem import Point

#: Steps of the numbers, and halvings of one that does not lower the sum.
STEPS, HALVINGS = 6, 6
#: Fall of the sum from which another step is worth it [-2 log likelihood].
SETTLED = 0.1
#: Share of the largest variance below which a direction is rounding.
ROUNDING = 1e-12


@dataclass(frozen=True)
class Tested:
    """What readings leave of a model whose numbers moved within their own error.

    Args:
        total: Squares of what is left, with the price of the move.
        channels: The same of each channel; shape (channels,). The larger of two: what its own best move leaves with its
            price, and what the move leaves that all channels share.
    """

    total: float
    channels: Array

    def __add__(self, other: Tested) -> Tested:
        return Tested(self.total + other.total, self.channels + other.channels)


@dataclass(frozen=True)
class Freedom:
    """How numbers of a model may move: x = x_0 + directions u, at the price u^T precision u.

    Args:
        objective: Model and terms with their scaled coordinates x.
        at: x_0, shape (coordinates,).
        directions: Shape (coordinates, k).
        precision: Shape (k, k).
        own: Which u are numbers of these recordings alone, shape (k,).
    """

    objective: Objective
    at: Array
    directions: Array
    precision: Array
    own: AnyArray

    def columns(self) -> Array:
        """Derivatives of all readings, (measured - simulated) / noise, by u; shape (residuals, k)."""
        here = self.objective.residuals(self.at)
        every = _columns(self.objective, self.at, here) @ self.directions
        return without_whitening(self.objective.model, every)  # type: ignore[arg-type]

    def after(self, columns: Array) -> Freedom:
        """The same where the own numbers were fitted to some readings, all others held.

        Errors e of the others shift the own numbers by -H^-1 A^T B e with the derivatives A by the own numbers and B by
        the others, H = A^T A + prior; around that they scatter by H^-1.

        Args:
            columns: Derivatives of those readings by u, shape (readings, k).
        """
        own, others = columns[:, self.own], columns[:, ~self.own]
        across = own.T @ others
        inner = own.T @ own + self.precision[np.ix_(self.own, self.own)]
        found = self.precision.copy()
        found[np.ix_(self.own, self.own)] = inner
        found[np.ix_(self.own, ~self.own)] = across
        found[np.ix_(~self.own, self.own)] = across.T
        if self.own.any():
            found[np.ix_(~self.own, ~self.own)] += across.T @ np.linalg.solve(inner, across)
        return Freedom(self.objective, self.at, self.directions, found, self.own)


def covariance(model: DiagnosisModel, point: Point) -> tuple[Objective, Array]:
    """Posterior covariance of all scaled coordinates at a fitted point, by the noise as it is stated.

    Priors of terms are even between their bounds. A switch and what lies at a bound are taken to be known.

    Args:
        model: Model of the readings that were fitted; its residuals are in deviations of the stated noise.
        point: The fit.

    Returns:
        The coordinates, and their covariance, shape (coordinates, coordinates).
    """
    objective = Objective(model, list(point.terms), np.ones(len(model.parameters)))
    x = objective.vector(point)
    columns = _columns(objective, x, objective.residuals(x))
    width = objective.upper - objective.lower
    own = width[objective.count :]
    prior = np.concatenate([np.ones(objective.count), 12.0 / np.where(own > 0.0, own, 1.0) ** 2])
    is_switch = [p.is_switch for t in point.terms for p in t.parameters]
    at_bound = AT_BOUND * np.where(np.isfinite(width), width, 1.0)
    inside = np.minimum(x - objective.lower, objective.upper - x) > at_bound  # never where both bounds are one
    free = np.flatnonzero(inside & ~np.array([False] * objective.count + is_switch, dtype=bool))
    found = np.zeros((len(x), len(x)))
    normal = columns[:, free].T @ columns[:, free] + np.diag(prior[free])
    scale = np.sqrt(np.diag(normal))
    inverse = np.linalg.pinv(normal / np.outer(scale, scale), hermitian=True)
    found[np.ix_(free, free)] = inverse / np.outer(scale, scale)
    return objective, found


def freedom(trained: DiagnosisModel, fitted: Point, judge: DiagnosisModel, carried: Point) -> Freedom:
    """How the numbers of a judge may move: those that were fitted by their posterior, those of its days by their prior.

    Args:
        trained: Model of the readings that were fitted, in deviations of the stated noise.
        fitted: The fit.
        judge: Model of the readings that judge.
        carried: The same point for it (`diagnosis.judge.held_out.carried_over`), maybe with its own numbers estimated;
            `fitted` itself where the judge is the model that was fitted: then nothing is of other days.
    """
    there, sigma = covariance(trained, fitted)
    here = Objective(judge, list(carried.terms), np.ones(len(judge.parameters)))
    is_same = carried is fitted
    known = {name: (n, size) for n, (name, size) in enumerate(_numbers(there, is_same)) if name}
    numbers = _numbers(here, is_same)
    found = [(i, *known[name], size) for i, (name, size) in enumerate(numbers) if name in known]
    mine = [i for i, (name, _) in enumerate(numbers) if i < here.count and name not in known]
    shared, rows = [i for i, *_ in found], [n for _, n, *_ in found]
    factor = np.array([theirs / ours for *_, theirs, ours in found])
    root = _root(sigma[np.ix_(rows, rows)] * np.outer(factor, factor))
    count = root.shape[1] + len(mine)
    directions = np.zeros((len(here.upper), count))
    directions[shared, : root.shape[1]] = root
    directions[mine, root.shape[1] :] = np.eye(len(mine))
    return Freedom(here, here.vector(carried), directions, np.eye(count), np.arange(count) >= root.shape[1])


def _numbers(objective: Objective, is_same: bool) -> list[tuple[str, float]]:
    """Name and size of every scaled coordinate; without a name where no other model has it."""
    base = [(p.name if is_same or p.is_carried else "", p.deviation) for p in objective.model.parameters]
    terms = [f"{t}: {p.name}" for t in objective.terms for p in t.parameters]
    return [*base, *zip(terms, objective.scale.tolist())]


def _root(matrix: Array) -> Array:
    """R with R R^T the matrix, shape (n, k), without directions that are rounding."""
    values, vectors = np.linalg.eigh(matrix)
    kept = values > ROUNDING * max(float(values.max(initial=0.0)), 0.0)
    return np.asarray(vectors[:, kept] * np.sqrt(values[kept]))


def _columns(objective: Objective, x: Array, here: Array) -> Array:
    """Derivatives of a model's residuals by all scaled coordinates, shape (residuals, coordinates)."""
    base = np.asarray(objective.base_columns(x), dtype=np.float64).reshape(len(here), objective.count)
    return np.hstack([base, objective.term_columns(x, here)])


def without_whitening(model: DiagnosisModel, columns: Array) -> Array:
    """Derivatives of (measured - simulated) / noise, from those of a model's residuals.

    A coil network takes a share of the sum of each channel away
    (`diagnosis.models.coil_network.kernel.whiten`); s of n readings with that share leaves 1 - n s of the sum.

    Args:
        model: The model.
        columns: Shape (residuals, k).
    """
    found, begin = columns.copy(), 0
    for run in model.runs:
        for number, series in enumerate(run.series):
            rows = begin + np.flatnonzero(series.used)
            begin += len(series.samples)
            share = float(run.shares[number])
            if len(rows) and share > 0.0:
                found[rows] += columns[rows].sum(axis=0) * (share / (1.0 - len(rows) * share))
    return found


def tested(
    may: Freedom, columns: Array, left: Callable[[Point], Array], channel: AnyArray, has_zero: AnyArray
) -> Tested:
    """What readings leave once the numbers moved within their own error.

    Args:
        may: How they may move.
        columns: Derivatives of the readings by its u, shape (readings, k).
        left: (measured - simulated) / noise of the readings at a point, shape (readings,).
        channel: Number of the channel of each reading, shape (readings,).
        has_zero: Which channels have a zero that is unknown by `ZERO`, shape (channels,).
    """
    columns = zeroed(columns, channel, has_zero)
    u, rest, value = moved(may, columns, left, channel, has_zero)
    count = len(has_zero)
    together = np.bincount(channel, rest**2, count)
    return Tested(value, np.array([_least(may, columns, rest, u, channel == n, together[n]) for n in range(count)]))


def moved(
    may: Freedom, columns: Array, left: Callable[[Point], Array], channel: AnyArray, has_zero: AnyArray
) -> tuple[Array, Array, float]:
    """The move u that readings like best, what it leaves, its squares with the price: Gauss-Newton with halved steps.

    Args:
        may: How the numbers may move.
        columns: Derivatives of the readings by its u, `zeroed`, shape (readings, k).
        left: (measured - simulated) / noise of the readings at a point, shape (readings,).
        channel: Number of the channel of each reading, shape (readings,).
        has_zero: Which channels have a zero that is unknown by `ZERO`, shape (channels,).
    """
    lower, upper = may.objective.lower, may.objective.upper

    def at(u: Array) -> tuple[Array, float]:
        x = np.clip(may.at + may.directions @ u, lower, upper)
        rest = zeroed(left(may.objective.point(x))[:, None], channel, has_zero)[:, 0]
        return rest, float(rest @ rest + u @ may.precision @ u)

    u = np.zeros(columns.shape[1])
    rest, value = at(u)
    normal = columns.T @ columns + may.precision
    for _ in range(STEPS):
        step = -np.linalg.solve(normal, columns.T @ rest + may.precision @ u)
        for _ in range(HALVINGS):
            there, other = at(u + step)
            if other < value:
                break
            step = 0.5 * step
        else:
            break
        fell, u, rest, value = value - other, u + step, there, other
        if fell < SETTLED:
            break
    return u, rest, value


def _least(may: Freedom, columns: Array, rest: Array, u: Array, own: AnyArray, together: float) -> float:
    """Squares of one channel; see `Tested`. Its own best move is worked out with the derivatives.

    Args:
        may: How the numbers may move.
        columns: Shape (readings, k).
        rest: What is left at u, shape (readings,).
        u: The move that all channels share.
        own: Which readings are of the channel, shape (readings,).
        together: What is left of it at u.
    """
    slopes, unmoved = columns[own], rest[own] - columns[own] @ u
    pull = slopes.T @ unmoved
    alone = float(unmoved @ unmoved - pull @ np.linalg.solve(slopes.T @ slopes + may.precision, pull))
    return max(alone, together)


def zeroed(values: Array, channel: AnyArray, has_zero: AnyArray) -> Array:
    """Values of readings, shape (readings, k), whitened for the unknown zero of each channel.

    Residuals with a common zero of deviation s have the covariance I + s^2 1 1^T, whose inverse root takes the share
    1 - 1 / sqrt(1 + n s^2) of the mean of n readings away.
    """
    found = np.array(values, dtype=np.float64)
    for number in np.flatnonzero(has_zero):
        own = np.flatnonzero(channel == number)
        if len(own):
            found[own] -= (1.0 - 1.0 / np.sqrt(1.0 + len(own) * ZERO**2)) * found[own].mean(axis=0)
    return found
