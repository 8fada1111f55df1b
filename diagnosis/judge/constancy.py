"""Whether a law has one strength: the same in readings that it was not fitted to as in those that it was.

A name says that a parameter of the rig was found, and such a parameter is the same in every recording. A law that only
bends to what is missing has another strength wherever the rig does something else. The strength is estimated again from
the readings that judge, all other numbers within the error of their fit (`diagnosis.judge.parameter_error`).

That is asked where the readings reject the model. Where they do not, noise and the error of the fit explain all that is
left, another strength included.

Source: tests of parameter constancy, G. C. Chow, Econometrica 28 (1960) 591-605. Error of the estimate from sums over
blocks, since errors of a model are alike for a while: K.-Y. Liang and S. L. Zeger, Biometrika 73 (1986) 13-22.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.judge.parameter_error import Freedom, moved, without_whitening, zeroed
from diagnosis.search.problem import Point, Term

#: Share by which a strength may differ between readings: models of real rigs err by as much in what they describe.
CONSTANT = 0.2
#: Standard errors by which it has to differ; noise alone does in one of a thousand.
ERRORS = 3.3
#: Squared change of all readings by the whole strength, in deviations of the noise, below which they do not show a law:
#: one of another day alone.
SHOWN = 1.0


@dataclass(frozen=True)
class Constancy:
    """Strength of a law in the readings that judge.

    Args:
        fitted: Strength of the fit, in the unit of the law's first parameter.
        there: Strength in the readings that judge, all other numbers within the error of their fit.
        error: Standard error of the difference.
    """

    fitted: float
    there: float
    error: float

    @property
    def is_constant(self) -> bool:
        """Whether it is one strength, as far as the readings can tell."""
        apart = abs(self.there - self.fitted)
        return apart <= max(CONSTANT * abs(self.fitted), ERRORS * self.error)


def columns_by_terms(may: Freedom) -> Array:
    """Derivatives of all readings by the scaled parameters of the terms, shape (residuals, term parameters)."""
    objective = may.objective
    found = objective.term_columns(may.at, objective.residuals(may.at))
    return without_whitening(objective.model, found)  # type: ignore[arg-type]


def constancy(
    may: Freedom,
    columns: Array,
    by_terms: Array,
    term: Term,
    fitted: float,
    left: Callable[[Point], Array],
    channel: AnyArray,
    block: AnyArray,
    has_zero: AnyArray,
    chosen: AnyArray,
) -> Constancy:
    """Estimate the strength of a law again from readings that it was not fitted to.

    Args:
        may: How the numbers may move within the error of their fit.
        columns: Derivatives of all residuals of the model that judges by its u, shape (residuals, k).
        by_terms: The same by the parameters of its terms (`columns_by_terms`), shape (residuals, term parameters).
        term: The law; its first parameter is its strength.
        fitted: Value of that.
        left: (measured - simulated) / noise of the readings that judge at a point, shape (readings,).
        channel: Number of the channel of each of these readings, shape (readings,).
        block: Number of the stretch of time of each, shape (readings,).
        has_zero: Which channels have a zero that is unknown, shape (channels,).
        chosen: Numbers of these readings among all residuals, shape (readings,).
    """
    strength = _coordinate(may, term)
    scale = float(may.objective.scale[strength - may.objective.count])
    own = by_terms[:, [strength - may.objective.count]]
    if not float(np.sum((own[chosen] * fitted / scale) ** 2)) > SHOWN:
        return Constancy(fitted, fitted, float("inf"))
    others = columns - own * may.directions[strength]  # the strength alone moves it, not what is shared with others
    every = zeroed(np.hstack([others, own])[chosen], channel, has_zero)
    free = _released(may, strength)
    u, rest, _ = moved(free, every, left, channel, has_zero)
    at = np.clip(free.at + free.directions @ u, may.objective.lower, may.objective.upper)
    inverse = np.linalg.inv(every.T @ every + free.precision)
    pull = np.zeros((int(block.max(initial=-1)) + 1, every.shape[1]))
    np.add.at(pull, block, every * rest[:, None])
    noise = inverse @ (pull.T @ pull + free.precision) @ inverse
    by_fit = float(np.sum(may.directions[strength] ** 2))
    # sums over few blocks may cancel: noise alone gives the least
    by_readings = max(float(noise[-1, -1]), float(inverse[-1, -1]))
    return Constancy(fitted, float(at[strength]) * scale, scale * float(np.sqrt(by_fit + by_readings)))


def _coordinate(may: Freedom, term: Term) -> int:
    """Number of the strength of a law among the scaled coordinates."""
    terms = may.objective.terms
    return may.objective.count + sum(len(t.parameters) for t in terms[: terms.index(term)])


def _released(may: Freedom, strength: int) -> Freedom:
    """The same freedom with the strength free of what the fit says of it."""
    single = np.zeros((len(may.at), 1))
    single[strength] = 1.0
    held = may.directions.copy()
    held[strength] = 0.0
    count = held.shape[1]
    precision = np.zeros((count + 1, count + 1))
    precision[:count, :count] = may.precision
    own = np.append(may.own, False)
    return Freedom(may.objective, may.at, np.hstack([held, single]), precision, own)
