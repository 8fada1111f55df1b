"""SINDy on the residual: which terms sparse regression would add to the recalibrated model.

The residual of a temperature has dynamics, d(residual) = library(residual, variables); that of an algebraic channel
(currents, extensions) is library(variables) itself. The library holds all products of two variables.

Source: S. L. Brunton, J. L. Proctor, J. N. Kutz, PNAS 113 (2016) 3932-3937; library `pysindy`.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import pysindy

from cosim.unit.protocol import Array
from evaluation.proof.variables import NAMES, Course

#: Variables of the library beside the residual itself.
INPUTS = ("temperature", "rate", "drive", "since_switch", "time")
#: Coefficients below this, in deviations (per second) for variables of deviation 1, are taken for none.
THRESHOLD = 0.1
#: A forecast beyond this many deviations has run away.
RUNAWAY = 1e4
_COLUMNS = [NAMES.index(n) for n in INPUTS]


def predict(training: Sequence[Course], held_out: Sequence[Course]) -> tuple[list[Array], float]:
    """Residuals of the held-out courses, in deviations, and the mean number of terms of a channel's law.

    Args:
        training: What may be learnt from.
        held_out: What is to be predicted; their residuals are not looked at.

    Returns:
        Residuals, infinite where the law that was found runs away.
    """
    found, terms = [], []
    for course in held_out:
        own = [c for c in training if c.channel == course.channel and c.used.sum() > 20]
        if not own:
            found.append(np.zeros(len(course.times)))
            continue
        law = _Law(own, is_dynamic=course.quantity == "temperature")
        terms.append(law.terms)
        found.append(law.forecast(course))
    return found, float(np.mean(terms)) if terms else 0.0


class _Law:
    """Sparse law of one channel's residual."""

    def __init__(self, own: Sequence[Course], is_dynamic: bool) -> None:
        self.is_dynamic = is_dynamic
        inputs = np.concatenate([c.variables[c.used][:, _COLUMNS] for c in own])
        self.middle, self.spread = inputs.mean(axis=0), np.maximum(inputs.std(axis=0), 1e-12)
        library = pysindy.PolynomialLibrary(degree=2)
        model = pysindy.SINDy(optimizer=pysindy.STLSQ(threshold=THRESHOLD), feature_library=library)
        even = [self._even(c) for c in own]
        states = [s for _, s, _ in even]
        times = [t for t, _, _ in even]
        rates = None if is_dynamic else [r[:, None] for _, _, r in even]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # "sparsity too big": no term is left, which is an answer
            if is_dynamic:
                model.fit([s[:, :1] for s in states], t=times, u=[s[:, 1:] for s in states])
                self.weights = np.asarray(model.coefficients())[0]
            else:
                model.fit(states, t=times, x_dot=[np.repeat(r, states[0].shape[1], axis=1) for r in rates or []])
                self.weights = np.asarray(model.coefficients())[0]
        self.powers = np.asarray(library.powers_)
        self.terms = int(np.count_nonzero(self.weights))

    def _inputs(self, course: Course) -> Array:
        return np.asarray((course.variables[:, _COLUMNS] - self.middle) / self.spread)

    def _even(self, course: Course) -> tuple[Array, Array, Array]:
        """Even times, states (with the residual first where it has dynamics) and residuals: it differentiates."""
        at = course.times[course.used]
        times = np.linspace(at[0], at[-1], len(at))
        residuals = np.interp(times, at, course.residuals[course.used])
        inputs = np.stack([np.interp(times, course.times, v) for v in self._inputs(course).T], axis=1)
        return times, np.column_stack([residuals, inputs]) if self.is_dynamic else inputs, residuals

    def _value(self, states: Array) -> Array:
        """Value of the law, shape (samples,), at states (samples, variables)."""
        library = np.prod(states[:, None, :] ** self.powers[None, :, :], axis=2)
        return np.asarray(library @ self.weights)

    def forecast(self, course: Course) -> Array:
        """Residuals over a course, from none at its begin, by Runge and Kutta's midpoint rule."""
        inputs = self._inputs(course)
        if not self.is_dynamic:
            return self._value(inputs)
        found = np.zeros(len(course.times))
        for n, size in enumerate(np.diff(course.times)):
            between = 0.5 * (inputs[n] + inputs[n + 1])
            slope = self._value(np.concatenate([[found[n]], inputs[n]])[None])[0]
            slope = self._value(np.concatenate([[found[n] + 0.5 * size * slope], between])[None])[0]
            found[n + 1] = found[n] + size * slope
            if not abs(found[n + 1]) < RUNAWAY:
                return np.full(len(course.times), np.inf)
        return found
