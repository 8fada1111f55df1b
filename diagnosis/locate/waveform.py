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

from cosim.unit.protocol import AnyArray, Array
from diagnosis.locate.course import Course
from diagnosis.locate.equation import Equation, Products
from diagnosis.locate.terms import variables

#: Most cosines per recording, and the shortest period that they resolve [s].
COSINES, SHORTEST = 100, 1.5
#: Memories that are tried [s].
MEMORIES = (2.0, 10.0, 50.0)
#: By how much the input may be larger than its most probable size.
ROOM = 3.0
#: How many deviations of what the readings leave open a variable of the unit may be in it.
AMBIGUOUS = 2.0
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
    bases, frequencies = _bases([courses[r] for r in recordings], _coils(equation, courses[0]))
    of_recording = dict(zip(recordings, bases))
    responses = []
    for _, panel, members in seen:
        assert panel.respond is not None
        answers = [panel.respond(int(panel.elements[m])) @ of_recording[panel.recording] for m in members]
        responses.append(np.stack(answers, axis=1))
    products = equation.products(responses)
    mean, factor = _posterior(products, frequencies)
    found = []
    for r in recordings:
        deviation = np.sqrt(np.sum((of_recording[r] @ factor) ** 2, axis=1))
        found.append(Estimate(r, courses[r].middle, of_recording[r] @ mean, deviation))
    return Estimates(tuple(found), products.gain(mean))


def _coils(equation: Equation, course: Course) -> AnyArray:
    """Coils on which the inputs act."""
    _, panel, members = equation.members[0]
    elements = panel.elements[members]
    if panel.quantity == "supply_current":
        return np.arange(len(course.capacity))
    return np.flatnonzero(np.isin(course.string_of_coil, elements)) if panel.quantity == "current" else elements


def _bases(courses: Sequence[Course], coils: AnyArray) -> tuple[list[Array], Array]:
    """For each recording the courses of which the input is a sum, shape (steps, courses), and their frequencies.

    First the cosines of every recording, then what goes with the variables of the unit, common to all recordings: this
    is what a parameter could do as well. Its frequencies are not numbers.
    """
    own = [_basis(c) for c in courses]
    common = [_variables(c, coils) for c in courses]
    total = sum(b.shape[1] for b, _ in own)
    found, begin = [], 0
    for (basis, _), shared in zip(own, common):
        whole = np.zeros((len(basis), total + shared.shape[1]))
        whole[:, begin : begin + basis.shape[1]] = basis
        whole[:, total:] = shared
        begin += basis.shape[1]
        found.append(whole)
    frequencies = np.concatenate([*(f for _, f in own), np.full(common[0].shape[1], np.nan)])
    return found, frequencies


def _variables(course: Course, coils: AnyArray) -> Array:
    known = variables(course)
    return np.stack([np.ones(len(course.size)), *(v[:, coils].mean(axis=1) for v in known.values())], axis=1)


def _basis(course: Course) -> tuple[Array, Array]:
    """Cosines over a course, shape (steps, cosines), and their angular frequencies [rad/s]."""
    length = float(course.time[-1] - course.time[0])
    order = np.arange(int(min(COSINES, max(8.0, 2.0 * length / SHORTEST), len(course.middle))))
    frequency = np.pi * order / length
    return np.asarray(np.cos(frequency * (course.middle[:, None] - course.time[0]))), np.asarray(frequency)


def _posterior(products: Products, frequencies: Array) -> tuple[Array, Array]:
    """Mean of the coefficients and a root of their covariance, at the most probable size and memory."""
    best, chosen = -np.inf, np.zeros(len(frequencies))
    is_cosine = np.isfinite(frequencies)
    seen = np.maximum(np.diag(products.gram), 1e-300)
    typical = 1.0 / np.sqrt(float(np.max(seen)))  # what would just show
    # As much of a variable as the readings leave open beside the parameters.
    left_open = AMBIGUOUS / np.sqrt(seen)
    for memory in MEMORIES:
        shape = 1.0 / np.sqrt(1.0 + (np.where(is_cosine, frequencies, 0.0) * memory) ** 2)
        shape /= np.sqrt(np.mean(shape[is_cosine] ** 2))
        for size in typical * 2.0 ** np.arange(-1, 13):
            scale = np.where(is_cosine, size * shape, left_open)
            inner = np.eye(len(scale)) + scale[:, None] * products.gram * scale
            root = np.linalg.cholesky(0.5 * (inner + inner.T))
            along = np.linalg.solve(root, scale * products.along)
            evidence = 0.5 * float(along @ along) - float(np.sum(np.log(np.diag(root))))
            if evidence > best:
                best, chosen = evidence, scale
    # The evidence sees only what the parameters cannot do as well; the rest of the input may be larger than that.
    scale = np.where(is_cosine, ROOM, 1.0) * chosen
    inner = np.eye(len(scale)) + scale[:, None] * products.gram * scale
    root = np.linalg.cholesky(0.5 * (inner + inner.T))
    factor = scale[:, None] * np.linalg.inv(root).T
    return np.asarray(factor @ np.linalg.solve(root, scale * products.along)), np.asarray(factor, dtype=np.float64)
