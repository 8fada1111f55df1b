"""Do readings answer to an input at all? A linear response with memory, fitted to the other half of them, says so.

Whatever the rig is, its readings follow what drives it by some response. Here it is a sum of first- and second-order
ones whose time constants, resonances and dampings are laid out beforehand, of each input and of its square (heat,
drag). It knows nothing of the scenario.

Source: Heuberger, Van den Hof, Wahlberg, Modelling and Identification with Rational Orthogonal Basis Functions,
Springer 2005, chapter 2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Compared, Course

#: Instants of the longest recording at which inputs are averaged.
INSTANTS = 2048
#: Time constants and resonances, from two instants to the longest recording, and damping ratios of the latter.
TIME_CONSTANTS, RESONANCES, DAMPINGS = 8, 16, (0.03, 0.15, 0.5)
#: Shares of the features' mean square that are added to their squares; the one that predicts best counts.
RIDGES = (1e-6, 1e-4, 1e-2, 1.0)
#: Changes of an input in a recording below which what it does cannot be told from a slow drift.
FEWEST_CHANGES = 6
#: Time constants of what a start leaves, as shares of the recording.
STARTS = (0.02, 0.1, 0.4)


@dataclass(frozen=True)
class Followed:
    """Shares of a channel's variance that the inputs predict in one half of each recording from the other half.

    Args:
        measured: Of the readings.
        simulated: Of the simulation of the scenario, by a response of the same kind fitted to the simulation.
    """

    measured: float
    simulated: float


@dataclass(frozen=True)
class _Half:
    """Responses to the inputs, and what is to be predicted, without what a start and a drift explain.

    Args:
        features: Shape (samples, responses).
        targets: Readings and simulation, shape (samples, 2).
    """

    features: Array
    targets: Array


def followed(every: Sequence[Compared], channel: str) -> Followed | None:
    """How far inputs predict a channel, of both halves the one where they predict more.

    Args:
        every: Recordings that have the channel and were simulated.
        channel: Its name.

    Returns:
        None where no input changes often enough in all of them.
    """
    names = _changing(every)
    if not names:
        return None
    step = max(one.end - one.begin for one in every) / INSTANTS
    kernels = _kernels(INSTANTS + 1, step)
    halves = [_halves(one, channel, names, kernels, step) for one in every]
    first, second = [h[0] for h in halves], [h[1] for h in halves]
    measured, simulated = np.maximum(_shares(first, second), _shares(second, first)).tolist()
    return Followed(measured, simulated)


def _changing(every: Sequence[Compared]) -> list[str]:
    """Inputs that change often enough in each recording."""
    names = [{c.name for c in one.courses if _changes(one, c) >= FEWEST_CHANGES} for one in every]
    return sorted(set.intersection(*names))


def _changes(one: Compared, course: Course) -> int:
    switches = course.switches()
    return int(np.count_nonzero((switches > one.begin) & (switches < one.end)))


def _kernels(count: int, step: float) -> Array:
    """Responses to a pulse, shape (responses, instants)."""
    times = step * np.arange(count)
    spans = np.geomspace(2.0 * step, times[-1], TIME_CONSTANTS)
    rows = [np.exp(-times / span) for span in spans] + [np.ones(count)]
    for omega in 2.0 * np.pi * np.geomspace(1.0 / times[-1], 0.2 / step, RESONANCES):
        for damping in DAMPINGS:
            decay = np.exp(-damping * omega * times)
            turned = omega * np.sqrt(1.0 - damping**2) * times
            rows += [decay * np.cos(turned), decay * np.sin(turned)]
    return np.array(rows)


def _halves(one: Compared, channel: str, names: Sequence[str], kernels: Array, step: float) -> tuple[_Half, _Half]:
    """Both halves of the samples of a channel of one recording."""
    beside = one.channels[channel]
    features = _responses(one, names, kernels, step, beside.times)
    targets = np.column_stack([beside.measured, beside.simulated_there])
    middle = len(beside.times) // 2
    first, second = (
        _half(beside.times[part], features[part], targets[part], step) for part in (slice(middle), slice(middle, None))
    )
    return first, second


def _responses(one: Compared, names: Sequence[str], kernels: Array, step: float, times: Array) -> Array:
    """Responses to the inputs and their squares at given times, shape (times, responses)."""
    count = int(np.ceil((one.end - one.begin) / step)) + 1
    edges = one.begin + step * np.arange(count + 1, dtype=np.float64)
    size = 2 * count
    pulses = np.fft.rfft(kernels[:, :count], size)
    found = []
    for course in one.courses:
        if course.name in names:
            mean = _averages(course, edges)
            driven = np.array([mean - mean.mean(), mean**2 - np.mean(mean**2)])
            spectra = np.fft.rfft(driven, size)[:, None] * pulses
            answers = np.fft.irfft(spectra, size)[..., :count].reshape(-1, count)
            found += [np.interp(times, edges[1:], row) for row in answers]
    return np.array(found).T


def _half(times: Array, features: Array, targets: Array, step: float) -> _Half:
    nuisance = _nuisance((times - times[0]) / max(float(times[-1] - times[0]), step))
    return _Half(_without(features, nuisance), _without(targets, nuisance))


def _averages(course: Course, edges: Array) -> Array:
    """Mean of an input between instants, shape (instants - 1,)."""
    fine = np.linspace(0.0, 1.0, 8, endpoint=False)
    inside = edges[:-1, None] + np.diff(edges)[:, None] * fine
    if course.is_linear:
        return np.asarray(np.interp(inside, course.times, course.values).mean(axis=1))
    return np.asarray(course.at(inside).mean(axis=1))


def _nuisance(share: Array) -> Array:
    """What a start and a drift may do, orthonormal, shape (samples, columns); `share` is of the recording's time."""
    rows = [np.ones(len(share)), share, *(np.exp(-share / start) for start in STARTS)]
    return np.asarray(np.linalg.qr(np.array(rows).T)[0])


def _without(columns: Array, nuisance: Array) -> Array:
    return np.asarray(columns - nuisance @ (nuisance.T @ columns))


def _shares(own: Sequence[_Half], others: Sequence[_Half]) -> Array:
    """Greatest share of one half's variance that responses predict which are fitted to the other, by target."""
    target, fitted = (np.vstack([o.targets for o in half]) for half in (own, others))
    there, features = (np.vstack([o.features for o in half]) for half in (own, others))
    size = np.sqrt(np.mean(features**2, axis=0))
    keep = size > 1e-12 * size.max()
    features, there = features[:, keep] / size[keep], there[:, keep] / size[keep]
    squares, right = features.T @ features, features.T @ fitted
    total = least = np.mean(target**2, axis=0)
    for ridge in RIDGES:
        weights = np.linalg.solve(squares + ridge * len(fitted) * np.eye(len(squares)), right)
        least = np.minimum(least, np.mean((target - there @ weights) ** 2, axis=0))
    return np.asarray(np.where(total > 0.0, 1.0 - least / np.where(total > 0.0, total, 1.0), 0.0))
