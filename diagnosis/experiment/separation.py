"""How far an experiment parts two explanations, with what a recalibration would do as well taken away."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr

from cosim.unit.protocol import Array

#: Odds at which a question counts as decided.
DECISIVE = math.log(20.0)


@dataclass(frozen=True)
class Separation:
    """Predicted outcome of an experiment for two explanations.

    Args:
        log_bayes_factor: Expected ln of the Bayes factor for the true one, the less favourable truth taken.
        decides: Probability that the odds for the true one reach `DECISIVE`, averaged over which is true.
    """

    log_bayes_factor: float
    decides: float


@dataclass(frozen=True)
class Bordered:
    """Derivatives of predictions by all parameters of an explanation, G = (base, own).

    Args:
        base: By the parameters that all explanations share, shape (samples, parameters).
        inner: base' base.
        own: By the parameters of its terms, shape (samples, term parameters).
    """

    base: Array
    inner: Array
    own: Array

    def gram(self) -> Array:
        """G' G."""
        side = self.base.T @ self.own
        return np.block([[self.inner, side], [side.T, self.own.T @ self.own]]).astype(np.float64)

    def along(self, difference: Array) -> Array:
        """G' d."""
        return np.concatenate([self.base.T @ difference, self.own.T @ difference])


def distance(difference: Array, slopes: Bordered, spread: Array) -> float:
    """Squared distance of two predictions in the noise of the sensors and what the second is uncertain of.

    d' S^-1 d with S = 1 + G P G', where P is the covariance of the parameters after the recordings so far. By
    Woodbury's identity no matrix larger than the number of parameters is solved. Half of it is the part of the relative
    entropy that the means contribute: the expected ln of the Bayes factor (G. E. P. Box and W. J. Hill, Technometrics 9
    (1967) 57-71).

    Args:
        difference: d, predictions of the first minus those of the second, in deviations of the noise, shape (samples,).
        slopes: G, of the second's predictions by its parameters.
        spread: Root of P, shape (parameters, any).
    """
    along = spread.T @ slopes.along(difference)
    inner = np.eye(spread.shape[1]) + spread.T @ slopes.gram() @ spread
    return max(float(difference @ difference - along @ np.linalg.solve(inner, along)), 0.0)


def separation(first: float, second: float, log_odds: float) -> Separation:
    """What two distances mean for a decision.

    Where the first is true, ln of the Bayes factor is normal with mean d2/2 and variance d2 (equal covariances).

    Args:
        first: Squared distance in the uncertainty of the second: the first is true.
        second: In that of the first: the second is true.
        log_odds: ln of the odds of the first against the second before the experiment.
    """
    chance = 1.0 / (1.0 + math.exp(-log_odds))
    decided = chance * _reaches(first, log_odds) + (1.0 - chance) * _reaches(second, -log_odds)
    return Separation(0.5 * min(first, second), decided)


def _reaches(squared: float, log_odds: float) -> float:
    """Probability that log odds for the truth reach `DECISIVE`."""
    missing = DECISIVE - log_odds - 0.5 * squared
    return float(ndtr(-missing / math.sqrt(squared))) if squared > 0.0 else float(missing <= 0.0)


def root(covariance: Array) -> Array:
    """A root of a covariance matrix that may be singular by rounding, same shape."""
    size = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    values, vectors = np.linalg.eigh(covariance / np.outer(size, size))
    return np.asarray(size[:, None] * vectors * np.sqrt(np.maximum(values, 0.0)))
