"""A Gaussian process as the discrepancy of the recalibrated model: what a statistician would add without naming it.

Source: M. C. Kennedy, A. O'Hagan, Bayesian calibration of computer models, J. R. Stat. Soc. B 63 (2001) 425-464; C. E.
Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning, MIT Press 2006, chapters 2 and 5.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, Kernel

from cosim.unit.protocol import Array
from evaluation.proof.variables import NAMES, Course

#: Inputs of the process.
INPUTS = ("temperature", "value", "drive", "since_switch")
#: Samples from which length scales are learnt (of all channels of a quantity), and those of one channel's process.
LEARNT, KEPT = 240, 300
_COLUMNS = [NAMES.index(n) for n in INPUTS]


def predict(training: Sequence[Course], held_out: Sequence[Course], seed: int = 0) -> list[Array]:
    """Residuals of the held-out courses, in deviations, by a process for each channel.

    Length scales are those of the largest marginal likelihood over all channels of a quantity; the noise is known (1).

    Args:
        training: What may be learnt from.
        held_out: What is to be predicted; their residuals are not looked at.
        seed: Of the choice of samples.
    """
    rng = np.random.default_rng(seed)
    kernels: dict[str, tuple[Kernel, Array, Array]] = {}
    found = []
    for course in held_out:
        if course.quantity not in kernels:
            kernels[course.quantity] = _learnt([c for c in training if c.quantity == course.quantity], rng)
        kernel, middle, spread = kernels[course.quantity]
        x, y = _samples([c for c in training if c.channel == course.channel], KEPT, rng)
        if not len(y):
            found.append(np.zeros(len(course.times)))
            continue
        process = GaussianProcessRegressor(kernel, alpha=1.0, optimizer=None)
        process.fit((x - middle) / spread, y)
        found.append(np.asarray(process.predict((course.variables[:, _COLUMNS] - middle) / spread)))
    return found


def _learnt(courses: Sequence[Course], rng: np.random.Generator) -> tuple[Kernel, Array, Array]:
    """Kernel of a quantity, with mean and deviation of its inputs."""
    x, y = _samples(courses, LEARNT, rng)
    middle, spread = x.mean(axis=0), np.maximum(x.std(axis=0), 1e-12)
    start = ConstantKernel(1.0, (1e-3, 1e4)) * RBF(np.ones(len(INPUTS)), (0.1, 100.0))
    process = GaussianProcessRegressor(start, alpha=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # a length scale at its bound: the input does not matter
        process.fit((x - middle) / spread, y)
    return process.kernel_, middle, spread


def _samples(courses: Sequence[Course], count: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """Inputs and residuals of at most `count` samples that count, drawn from all courses."""
    if not courses:
        return np.zeros((0, len(INPUTS))), np.zeros(0)
    x = np.concatenate([c.variables[c.used][:, _COLUMNS] for c in courses])
    y = np.concatenate([c.residuals[c.used] for c in courses])
    chosen = rng.permutation(len(y))[:count]
    return x[chosen], y[chosen]
