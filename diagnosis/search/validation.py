"""Which explanation predicts what it was not fitted to, within the training recordings alone.

Where a model is wrong by more than noise, a fit says little about it: many terms bend a curve through the readings.
Each explanation is therefore fitted with one stretch of time left out, and runs freely through it; this goes round.

Source: blocks for correlated data, D. R. Roberts et al., Ecography 40 (2017) 913-929; the simplest model within one
standard error of the best, T. Hastie, R. Tibshirani and J. Friedman, The Elements of Statistical Learning, 2nd ed.,
Springer 2009, section 7.10.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.compute.steps import counted
from cosim.unit.protocol import AnyArray, Array
from diagnosis.search.fit import Columns, Fit, fit
from diagnosis.search.objective import bounded
from diagnosis.search.problem import Layout, Model, Term
from diagnosis.search.search import Explanation

#: Stretches of time that a recording is cut into.
BLOCKS = 5
#: Explanations that are validated, the best fits first.
VALIDATED = 6
#: Mean square of residuals, in that of the noise, below which stretches are all alike.
SMALLEST = 1e-6
#: Share of the largest gain that an explanation must have to be validated.
WORTH = 0.3
#: A search goes on through so many terms that do not predict better by themselves: some effects show in pairs alone.
PATIENCE = 2
#: Most steps of a fit to a part, which starts from the fit to the whole, and how often it takes derivatives anew.
ITERATIONS, REFRESHES = 8, 0


def blocks(layout: Layout, count: int = BLOCKS) -> list[AnyArray]:
    """Residuals of each stretch of time, shape (residuals,) each; channels are cut at equal times of their own."""
    place = np.zeros(len(layout.time), dtype=int)
    for number in range(len(layout.names)):
        own = layout.channel == number
        begin, end = layout.time[own].min(), layout.time[own].max()
        share = (layout.time[own] - begin) / max(end - begin, 1e-300)
        place[own] = np.minimum((count * share).astype(int), count - 1)
    return [place == k for k in range(count)]


@dataclass(frozen=True)
class Validated:
    """How well an explanation predicts.

    Args:
        explanation: It.
        residuals: Of every stretch by the fit to the others, shape (residuals,).
        losses: Mean of their squares (bounded) in each stretch, shape (stretches,).
    """

    explanation: Explanation
    residuals: Array
    losses: Array

    @property
    def loss(self) -> float:
        """Geometric mean over the stretches.

        What a model lacks comes into play in some stretches and not in others, so that its errors differ by orders:
        their variance is each stretch's own, and the likelihood of the readings goes with the sum of its logarithms.
        Of plain means the worst stretch alone would decide, which often asks for what only it holds.
        """
        return float(np.exp(np.mean(np.log(self.losses + SMALLEST))))


class Validation:
    """Validates explanations of one model.

    Args:
        model: Model and training recordings.
        hiding: Makes a model that sees a part of the residuals.
        on_progress: Told what is being done.
    """

    def __init__(
        self, model: Model, hiding: Callable[[AnyArray], Model], on_progress: Callable[[str], None] = lambda text: None
    ) -> None:
        self._model, self._on_progress = model, on_progress
        self._stretches = blocks(model.layout)
        self._parts = [hiding(~stretch) for stretch in self._stretches]
        #: Everything that was validated.
        self.all: list[Validated] = []
        self._losses: list[float] = []

    def validated(self, explanation: Explanation) -> Validated:
        """How well an explanation predicts each stretch from the others."""
        residuals = np.zeros(len(self._model.layout.time))
        losses = []
        for part, stretch in counted(list(zip(self._parts, self._stretches)), "stretches left out in turn"):
            near = _seen(explanation.fit, ~stretch)
            point = fit(part, explanation.fit.point, ITERATIONS, near, refreshes=REFRESHES).point
            own = bounded(self._model.residuals([point])[0][stretch])
            residuals[stretch] = own
            losses.append(float(np.mean(own**2)))
        return Validated(explanation, residuals, np.array(losses))

    def select(self, before: Explanation, grown: Sequence[Explanation]) -> list[Explanation]:
        """Explanations, the most probable first; none once two more terms have not helped any of them to predict.

        What predicts badly may be half of what predicts best: it is judged at the end (`chosen`).
        """
        if not self._losses:
            self.all.append(self.validated(before))
            self._losses.append(self.all[0].loss)
        found = []
        most = before.fit.cost - grown[0].fit.cost if grown else 0.0
        hopeful = [e for e in grown[:VALIDATED] if before.fit.cost - e.fit.cost >= WORTH * most]
        if hopeful:
            self._on_progress("validating explanations by stretches of time that they were not fitted to")
        for explanation in counted(hopeful, "explanations validated"):
            found.append(self.validated(explanation))
        self.all += found
        self._losses.append(min((f.loss for f in found), default=np.inf))
        if not found or min(self._losses[-PATIENCE:]) >= min(self._losses[:-PATIENCE], default=np.inf):
            return []
        return [f.explanation for f in sorted(found, key=lambda f: f.explanation.cost)]


def _seen(whole: Fit, seen: AnyArray) -> Fit:
    """A fit as one sees it who knows a part of the residuals, shape (residuals,)."""
    residuals = np.where(seen, whole.residuals, 0.0)
    values = whole.columns.values * seen.astype(whole.columns.values.dtype)[:, None]
    return replace(whole, residuals=residuals, columns=Columns.of(values, whole.columns.at, residuals))


def chosen(found: Sequence[Validated], plain: Collection[Term], margin: float) -> Validated:
    """Of those that predict as well as the best: the most probable of those with the fewest terms that are not plain.

    Few stretches tell little: one that asks for more than the others hold (two heaters on at once, which happens there
    alone) outweighs the rest. They may reject an explanation; among those that they leave the readings decide, each
    term against the margin.

    Args:
        found: At least one.
        plain: Terms that need no special reason.
        margin: Gain that a term must be worth, in -2 log posterior.
    """
    best = min(found, key=lambda f: f.loss)

    def simplicity(one: Validated) -> tuple[int, float]:
        terms = one.explanation.terms
        return sum(t not in plain for t in terms), one.explanation.cost + margin * len(terms)

    return min((f for f in found if _within(f, best)), key=simplicity)


def _within(one: Validated, best: Validated) -> bool:
    """Whether an explanation predicts as well as the best, within the standard error of the difference."""
    difference = np.log(one.losses + SMALLEST) - np.log(best.losses + SMALLEST)
    return bool(np.mean(difference) <= np.std(difference, ddof=1) / np.sqrt(len(difference)))
