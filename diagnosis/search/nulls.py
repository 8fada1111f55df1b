"""The search on nulls: recordings without any effect, simulated from the recalibrated model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.compute.steps import counted
from cosim.unit.protocol import Array
from diagnosis.search.explanation import Settings
from diagnosis.search.fit import Fit, fit
from diagnosis.search.problem import Layout, Model, Parameter, Point, Term, strength_slopes
from diagnosis.search.score import Scoring, null_noise

#: Most steps of a fit to a null. It begins at the truth of the null, so that the derivatives there serve it; but
#: the prior pulls it from there.
STEPS = 40


class NullModel:
    """A model whose recordings are replaced by its own prediction and fresh noise.

    Args:
        inner: The model.
        base: Recalibrated: the truth of the null.
        noise: Of every residual, in deviations, shape (residuals,).
    """

    def __init__(self, inner: Model, base: Fit, noise: Array) -> None:
        self.inner = inner
        self.parameters: Sequence[Parameter] = inner.parameters
        self.layout: Layout = inner.layout
        # What is not used has the residual 0, and stays so.
        self._shift = np.where(base.residuals == 0.0, 0.0, noise - base.residuals)

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.asarray(self.inner.residuals(points) + self._shift)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return self.inner.base_jacobian(point)

    def slopes(self, point: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> Array:
        """See `diagnosis.search.problem.strength_slopes`."""
        return strength_slopes(self.inner, point, None, tasks)


def refitted(model: Model, base: Fit, scoring: Scoring, settings: Settings) -> Array:
    """Gains of the best term of some nulls once all is refitted, shape (nulls,).

    Each null is recalibrated as the recordings were; the term that its straight lines promise most is then fitted with
    everything else, as a finding would be.

    Args:
        model: Model and training recordings.
        base: Recalibrated.
        scoring: Of the terms, with nulls.
        settings: How many nulls, and the seed that the scoring had.
    """
    noise, _ = null_noise(len(base.residuals), len(scoring.chance), settings.seed)
    gains = []
    for draw, lead in counted(list(enumerate(scoring.leads))[: settings.nulls], "recordings without effects searched"):
        if lead is None:
            continue
        null = NullModel(model, base, noise[:, draw].astype(np.float64))
        without = fit(null, base.point, STEPS, base, refreshes=0)
        term, values = lead
        found = fit(null, without.point.plus(term, values), STEPS, base, refreshes=0)
        gains.append(max(without.cost - found.cost - term.price, 0.0))
    return np.array(gains)


def calibrated(model: Model, base: Fit, scoring: Scoring, settings: Settings) -> tuple[Scoring, int]:
    """The scoring with gains by chance as large as refits on nulls find them, and how many nulls were searched.

    Straight lines promise what refits gain within some per cent; where refits find more (free instants and time
    constants), the gains by chance grow in proportion. They never shrink.
    """
    gains = refitted(model, base, scoring, settings)
    if not gains.size:
        return scoring, 0
    promised = float(np.median(scoring.chance[: settings.nulls]))
    return scoring.scaled(max(1.0, float(np.median(gains)) / max(promised, 1e-300))), len(gains)
