"""Unknown input at a located equation, as a course in time with its band.

A smooth random course is taken for it, a sum of cosines whose deviations fall with the frequency as those of a process
that forgets; its size and its memory are those under which the readings are most probable. What the unit's parameters
could do as well is unknown in it, and widens the band.

Source: regularised deconvolution with the evidence as the choice of the regularisation, D. J. C. MacKay, Neural
Computation 4 (1992) 415-447; band: posterior of a linear Gaussian model, Rasmussen and Williams, MIT Press 2006, 2.1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit import Array
from diagnosis.locate.course import Course
from diagnosis.locate.equation import Equation, Products

#: Most cosines per recording, and the shortest period that they resolve [s].
COSINES, SHORTEST = 100, 1.5
#: Memories that are tried [s].
MEMORIES = (2.0, 10.0, 50.0)
#: Half width of a 95 % interval in standard deviations.
NORMAL_95 = 1.959963984540054


@dataclass(frozen=True)
class Estimate:
    """An unknown input of one recording.

    Args:
        recording: Its number.
        times: [s], shape (steps,).
        values: SI, shape (steps,).
        deviation: Standard deviation of each, shape (steps,).
    """

    recording: int
    times: Array
    values: Array
    deviation: Array


@dataclass(frozen=True)
class Estimates:
    """Unknown input of all recordings at one equation.

    Args:
        courses: One for each recording.
        gain: Fall of -2 log posterior by them.
    """

    courses: tuple[Estimate, ...]
    gain: float


def estimate(equation: Equation, courses: Sequence[Course]) -> Estimates:
    """Unknown input, common to all elements of the equation.

    Args:
        equation: Where.
        courses: Of every recording.
    """
    seen = equation.members
    recordings = sorted({panel.recording for _, panel, _ in seen})
    bases = {r: _basis(courses[r]) for r in recordings}
    begins = dict(zip(recordings, np.cumsum([0, *(bases[r][0].shape[1] for r in recordings)])))
    count = sum(b.shape[1] for b, _ in bases.values())
    responses = []
    for _, panel, members in seen:
        basis = bases[panel.recording][0]
        response = np.zeros((len(panel.times), len(members), count))
        begin = int(begins[panel.recording])
        assert panel.respond is not None
        for k, member in enumerate(members):
            one = panel.respond(int(panel.elements[member])) @ basis
            response[:, k, begin : begin + basis.shape[1]] = one
        responses.append(response)
    products = equation.products(responses)
    frequencies = np.concatenate([bases[r][1] for r in recordings])
    mean, factor = _posterior(products, frequencies)
    found = []
    for r in recordings:
        basis, begin = bases[r][0], int(begins[r])
        own = slice(begin, begin + basis.shape[1])
        deviation = np.sqrt(np.sum((basis @ factor[own]) ** 2, axis=1))
        found.append(Estimate(r, courses[r].middle, basis @ mean[own], deviation))
    return Estimates(tuple(found), products.gain(mean))


def _basis(course: Course) -> tuple[Array, Array]:
    """Cosines over a course, shape (steps, cosines), and their angular frequencies [rad/s]."""
    length = float(course.time[-1] - course.time[0])
    order = np.arange(int(min(COSINES, max(8.0, 2.0 * length / SHORTEST), len(course.middle))))
    frequency = np.pi * order / length
    return np.asarray(np.cos(frequency * (course.middle[:, None] - course.time[0]))), np.asarray(frequency)


def _posterior(products: Products, frequencies: Array) -> tuple[Array, Array]:
    """Mean of the coefficients and a root of their covariance, at the most probable size and memory."""
    best = -np.inf
    found: tuple[Array, Array] = (np.zeros(len(frequencies)), np.zeros((len(frequencies), 1)))
    typical = 1.0 / np.sqrt(max(float(np.max(np.diag(products.gram))), 1e-300))  # what would just show
    for memory in MEMORIES:
        shape = 1.0 / np.sqrt(1.0 + (frequencies * memory) ** 2)
        shape /= np.sqrt(np.mean(shape**2))
        for size in typical * 2.0 ** np.arange(-1, 13):
            scale = size * shape
            inner = np.eye(len(scale)) + scale[:, None] * products.gram * scale
            root = np.linalg.cholesky(0.5 * (inner + inner.T))
            along = np.linalg.solve(root, scale * products.along)
            evidence = 0.5 * float(along @ along) - float(np.sum(np.log(np.diag(root))))
            if evidence > best:
                best = evidence
                factor = scale[:, None] * np.linalg.inv(root).T
                found = (np.asarray(factor @ along), np.asarray(factor, dtype=np.float64))
    return found
