"""Whether anything but noise is left: standardised sums over elements and windows, and the limit that noise keeps.

The noise of the sensors of the inputs is carried along: it is common to all coils of a string and correlated in time.
The limit comes from simulated noise that goes the same way as the residuals, with the parameters fitted again to each.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from cosim.unit.protocol import AnyArray, Array
from diagnosis.locate.panel import Noise, Panel
from diagnosis.search.extreme import Gumbel
from diagnosis.search.posterior import HUBER
from diagnosis.search.structure import LEVEL, WINDOWS

#: Simulated nulls from which the limit is taken.
DRAWS = 60
#: A single reading counts for no more than this many deviations from its neighbours' median.
ALONE = 3.0
#: Common parts of an input's noise that are fitted, at most, and the least they must weigh beside the sensors' own.
MODES, WORTH = 12, 0.5


@dataclass(frozen=True)
class Peak:
    """The largest standardised sum.

    Args:
        z: Its size, with the sign of the residuals.
        panel: Number of the panel.
        members: Numbers of the channels in it.
        begin: First sample.
        end: Last sample.
    """

    z: float
    panel: int
    members: AnyArray
    begin: int
    end: int


@dataclass(frozen=True)
class Tested:
    """Residuals of a unit after its own parameters were fitted again.

    Args:
        panels: With the residuals that are left.
        peak: Largest sum.
        limit: Size that noise alone passes in one of a hundred recordings.
        by_element: Largest sum of every single channel: (panel, channel) to z.
        change: Of the parameters by the fit, in prior deviations.
        pull: Of the prior at that point: how far each parameter is from where the prior has it, in its deviations.
    """

    panels: tuple[Panel, ...]
    peak: Peak
    limit: float
    by_element: dict[tuple[int, int], float]
    change: Array
    pull: Array


class Refit:
    """Fits a unit's own parameters to residuals: linear, with the prior.

    Args:
        panels: Residuals with their columns.
        prior: Prior mean of the change: what brings each parameter back to its nominal value.
    """

    def __init__(self, panels: Sequence[Panel], prior: Array) -> None:
        self._panels, self._prior = panels, prior
        self._columns = [p.columns[p.used] for p in panels]
        weights = [weight(p)[p.used] for p in panels]
        self._weighted = [w[:, None] * c for w, c in zip(weights, self._columns)]
        normal = sum((c.T @ w for c, w in zip(self._columns, self._weighted)), start=np.eye(len(prior)))
        self._inverse = np.linalg.inv(normal)

    def change(self, values: Sequence[Array], prior: Array) -> Array:
        """Change of the parameters for residuals (readings in use[, draws]) of every panel."""
        right = sum((w.T @ v for w, v in zip(self._weighted, values)), start=np.zeros(prior.shape))
        return np.asarray(-self._inverse @ (right - prior))

    def left(self, values: Sequence[Array], prior: Array) -> tuple[list[Array], Array]:
        """Residuals after the fit, and the change."""
        change = self.change(values, prior)
        return [v + c @ change for v, c in zip(values, self._columns)], change


def absorbed(panels: Sequence[Panel], prior: Array) -> tuple[list[Panel], Array]:
    """Panels in which the largest common parts of the inputs' noise are fitted like parameters of deviation 1.

    Without this a fit that takes all readings as independent would explain by its parameters what one current's noise
    does to all coils of a string (generalised least squares by latent variables).

    Returns:
        Panels with more columns and only the rest as noise, and the prior with as many zeros more.
    """
    added: list[tuple[int, Noise, Array]] = []
    rest: list[list[Noise]] = [[] for _ in panels]
    for number, panel in enumerate(panels):
        for noise in panel.noise:
            mean = noise.factor.mean(axis=1)
            sizes, vectors = np.linalg.eigh(mean @ mean.T)
            kept = np.flatnonzero(len(noise.members) * sizes > WORTH)[-MODES:]
            if len(noise.members) == 1 or not kept.size:
                rest[number].append(noise)
                continue
            modes = mean.T @ vectors[:, kept] / np.sqrt(sizes[kept])
            common = noise.factor @ modes
            added.append((number, noise, common))
            rest[number].append(Noise(noise.source, noise.members, noise.factor - common @ modes.T))
    count = sum(common.shape[2] for _, _, common in added)
    found = []
    for number, panel in enumerate(panels):
        extra, begin = np.zeros((*panel.residual.shape, count)), 0
        for own, noise, common in added:
            end = begin + common.shape[2]
            if own == number:
                extra[:, noise.members, begin:end] = common
            begin = end
        extra[~panel.used] = 0.0
        columns = np.concatenate([panel.columns, extra], axis=2)
        found.append(replace(panel, columns=columns, noise=tuple(rest[number])))
    return found, np.concatenate([prior, np.zeros(count)])


def propagated(panel: Panel) -> Array:
    """Variance that the inputs' sensors add, in that of the channel's own, shape (samples, elements)."""
    found = np.zeros(panel.residual.shape)
    for noise in panel.noise:
        found[:, noise.members] += np.sum(noise.factor**2, axis=2)
    return found


def weight(panel: Panel) -> Array:
    """What each reading counts: by its noise, less where it stands out (Huber), shape (samples, elements)."""
    deviation = np.sqrt(1.0 + propagated(panel))
    size = np.abs(panel.residual) / deviation
    return np.asarray(np.where(size > HUBER, HUBER / np.maximum(size, HUBER), 1.0) / deviation**2)


def calm(values: Array, used: AnyArray) -> Array:
    """Readings that stand alone are drawn towards the median of five: one wild reading is no structure."""
    middle = median_filter(np.where(used, values, 0.0), size=(5, *(1,) * (values.ndim - 1)), mode="nearest")
    return np.asarray(np.where(used, np.clip(values, middle - ALONE, middle + ALONE), 0.0))


@dataclass(frozen=True)
class Refitted:
    """A unit with its own parameters fitted again, not looked at yet.

    Args:
        whole: Residuals of the unit.
        panels: The same with the common parts of the inputs' noise as columns (`absorbed`).
        prior: Prior mean of the change of every column.
        refit: Fits them.
        left: Residuals in use of every panel after the fit.
        change: Of the parameters by the fit, in prior deviations.
    """

    whole: Sequence[Panel]
    panels: Sequence[Panel]
    prior: Array
    refit: Refit
    left: Sequence[Array]
    change: Array


def refitted(panels: Sequence[Panel], prior: Array) -> Refitted:
    """Fit a unit's own parameters again.

    Args:
        panels: Residuals of the unit.
        prior: As for `Refit`.
    """
    whole = panels
    panels, prior = absorbed(panels, prior)
    refit = Refit(panels, prior)
    left, change = refit.left([p.residual[p.used] for p in panels], prior)
    return Refitted(whole, panels, prior, refit, left, change)


def tested(own: Refitted, groups: Sequence[Sequence[Array]], seed: int) -> Tested:
    """Look for structure in what a unit's fit left. This takes far longer than the fit.

    Args:
        own: The unit.
        groups: For every panel, numbers of channels that are summed.
        seed: Of the simulated noise.
    """
    panels, prior, change = own.panels, own.prior, own.change
    after = []
    for panel, values in zip(panels, own.left):
        residual = np.zeros_like(panel.residual)
        residual[panel.used] = values
        after.append(replace(panel, residual=residual))
    sums = [_Sums(p, g) for p, g in zip(panels, groups)]
    best = Peak(0.0, 0, np.zeros(0, dtype=int), 0, 0)
    by_element: dict[tuple[int, int], float] = {}
    for number, (panel, sum_) in enumerate(zip(after, sums)):
        for members, window, z in sum_.standardised(calm(panel.residual, panel.used)[..., None]):
            at = int(np.argmax(np.abs(z[:, 0])))
            value = float(z[at, 0])
            if len(members) == 1:
                key = (number, int(members[0]))
                by_element[key] = max(by_element.get(key, 0.0), value, key=abs)
            if abs(value) > abs(best.z):
                best = Peak(value, number, members, at, at + window - 1)
    return Tested(
        tuple(after), best, _limit(own.whole, sums, own.refit, len(prior), seed), by_element, change, change - prior
    )


def _limit(panels: Sequence[Panel], sums: Sequence[_Sums], refit: Refit, count: int, seed: int) -> float:
    rng = np.random.default_rng(seed)
    draws: dict[tuple[object, ...], Array] = {}
    truth = rng.standard_normal((panels[0].columns.shape[2], DRAWS))
    values = []
    for panel in panels:
        drawn = rng.standard_normal((*panel.residual.shape, DRAWS))
        for noise in panel.noise:
            if noise.source not in draws:
                draws[noise.source] = rng.standard_normal((noise.factor.shape[2], DRAWS))
            drawn[:, noise.members] += noise.factor @ draws[noise.source]
        values.append(drawn[panel.used] - panel.columns[panel.used] @ truth)
    left, _ = refit.left(values, np.zeros((count, DRAWS)))
    largest = np.zeros(DRAWS)
    for panel, sum_, own in zip(panels, sums, left):
        residual = np.zeros((*panel.residual.shape, DRAWS))
        residual[panel.used] = own
        for _, _, z in sum_.standardised(residual):
            largest = np.maximum(largest, np.abs(z).max(axis=0))
    return Gumbel.of(largest).quantile(LEVEL)


class _Sums:
    """Sums of one panel's residuals over groups of channels and windows, in deviations of their own."""

    def __init__(self, panel: Panel, groups: Sequence[Array]) -> None:
        self._panel, self._groups = panel, groups
        self._deviations = [self._deviation(members) for members in groups]

    def _deviation(self, members: Array) -> dict[int, Array]:
        panel = self._panel
        own = np.cumsum(_padded(panel.used[:, members].sum(axis=1).astype(np.float64)), axis=0)
        reached = [(n, np.isin(n.members, members)) for n in panel.noise]
        factors = [n.factor[:, own].sum(axis=1) for n, own in reached if own.any()]
        running = [np.cumsum(_padded(f), axis=0) for f in factors]
        found = {}
        for window in _windows(panel):
            variance = own[window:] - own[:-window]
            for total in running:
                variance = variance + np.sum((total[window:] - total[:-window]) ** 2, axis=1)
            found[window] = np.sqrt(np.maximum(variance, 1e-300))
        return found

    def standardised(self, residual: Array) -> Iterator[tuple[Array, int, Array]]:
        """Members, window and sums, shape (windows, draws), for residuals (samples, elements, draws)."""
        for members, deviations in zip(self._groups, self._deviations):
            running = np.cumsum(_padded(residual[:, members].sum(axis=1)), axis=0)
            for window, deviation in deviations.items():
                yield members, window, (running[window:] - running[:-window]) / deviation[:, None]


def _windows(panel: Panel) -> list[int]:
    return [w for w in WINDOWS if w <= len(panel.times)]


def _padded(values: Array) -> Array:
    return np.concatenate([np.zeros((1, *values.shape[1:])), values])
