"""How much each term would gain, from its simulated sensitivity with the recalibration projected out."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from cosim.compute.steps import counted
from cosim.unit.protocol import AnyArray, Array
from diagnosis.search.extreme import Gumbel
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import huber_weights
from diagnosis.search.problem import Model, Term, limits_of, strength_slopes

#: Strength at which a term is simulated, as a share of its first start value: small enough for a straight line.
SHARE = 0.02
#: Simulations per call, so that memory stays small.
BATCH = 128
#: Slope beyond which a law runs away: a million squares of it still have a sum in single precision (3e38).
STEEPEST = 1e16
#: A direction of which the recalibration absorbs all but this share of the length cannot be seen.
LEAST_VISIBLE = 5e-3  # below it single precision would see its own rounding


@dataclass(frozen=True)
class Score:
    """What a term promises at one choice of its shape.

    Args:
        term: The term.
        values: Its parameters, strength by the straight line.
        gain: Predicted fall of -2 log posterior.
        visibility: Share of its effect that the recalibration does not absorb, in [0, 1].
        second: Its parameters at the second best choice of its shape, if there is one.
    """

    term: Term
    values: tuple[float, ...]
    gain: float
    visibility: float
    second: tuple[float, ...] | None = None


class Projection:
    """Removes from a direction what a change of the fitted parameters would do as well.

    What is left of a direction s is s - J N^-1 J' s with the fitted parameters' derivatives J (residuals and prior) and
    N = J' J; lengths and products of what is left need J' s alone. A parameter that was pulled to its bound does
    nothing as well: it stays there.

    Args:
        base: The fit.
    """

    def __init__(self, base: Fit) -> None:
        #: Nulls that were drawn.
        self.draws = 0
        self.weights = huber_weights(base.residuals)
        self.residuals = self.weights * base.residuals
        free = np.ones(len(base.point.base), dtype=bool) if base.held is None else ~base.held
        self._count = int(np.count_nonzero(free))
        kept = np.concatenate([free, np.ones(base.jacobian.shape[1] - len(free), dtype=bool)])
        self._prior = np.zeros(len(kept))
        self._prior[: len(free)] = base.point.base / base.widths**2
        self._prior = self._prior[kept]
        self._widths = base.widths[free]
        kind = base.jacobian.dtype
        jacobian = base.jacobian if kept.all() else base.jacobian[:, kept]
        self._jacobian = jacobian * self.weights.astype(kind)[:, None]
        self._factor = _factored(base.information[np.ix_(kept, kept)])
        slope = np.asarray(self._jacobian.T @ self.residuals.astype(kind), dtype=np.float64) + self._prior
        self._pull = cho_solve(self._factor, slope)

    def noise(self, draws: int, seed: int) -> None:
        """Draw nulls: noise of residuals and prior, from which `chance` is computed."""
        self.draws = draws
        kind = self._jacobian.dtype
        noise, rng = null_noise(len(self.residuals), draws, seed)
        noise = noise.astype(kind)
        prior = np.zeros((self._jacobian.shape[1], draws))
        prior[: self._count] = rng.standard_normal((self._count, draws)) / self._widths[:, None]
        slope = np.asarray(self._jacobian.T @ noise, dtype=np.float64) + prior
        self._noise_pull = cho_solve(self._factor, slope)
        self._sides = np.hstack([self._jacobian, self.residuals.astype(kind)[:, None], noise])

    def look(self, slopes: Array) -> Seen:
        """What is left of directions.

        Args:
            slopes: Derivatives of the residuals, shape (k, residuals).
        """
        weighted = slopes * self.weights
        kind = self._jacobian.dtype
        products = np.asarray(weighted.astype(kind) @ self._sides, dtype=np.float64)
        size = self._jacobian.shape[1]
        across, along, noise = products[:, :size], products[:, size], products[:, size + 1 :]
        whole = np.einsum("ij,ij->i", weighted, weighted)
        left = np.maximum(whole - np.einsum("ij,ij->i", across, cho_solve(self._factor, across.T).T), 0.0)
        return Seen(whole, left, along - across @ self._pull, noise - across @ self._noise_pull, across)

    def pieces(self, slopes: Array, own: slice) -> tuple[Array, Array, Array, Array]:
        """Products of what is left of directions that are 0 outside some residuals.

        Args:
            slopes: Derivatives of those residuals, shape (k, residuals of `own`).
            own: Which residuals.

        Returns:
            Products with each other and those before anything is taken away, both (k, k); with the residuals, shape
            (k,); with each drawn null, shape (k, draws).
        """
        weighted = (slopes * self.weights[own]).astype(self._jacobian.dtype)
        products = np.asarray(weighted @ self._sides[own], dtype=np.float64)
        size = self._jacobian.shape[1]
        across, along, noise = products[:, :size], products[:, size], products[:, size + 1 :]
        whole = np.asarray(weighted @ weighted.T, dtype=np.float64)
        left = whole - across @ cho_solve(self._factor, across.T)
        return left, whole, along - across @ self._pull, noise - across @ self._noise_pull

    def gram(self, slopes: Array) -> tuple[Array, Array]:
        """Products of what is left of directions with each other, shape (k, k), and with the residuals, shape (k,)."""
        weighted = (slopes * self.weights).astype(self._jacobian.dtype)
        across = np.asarray(weighted @ self._jacobian, dtype=np.float64)
        whole = np.asarray(weighted @ weighted.T, dtype=np.float64)
        along = np.asarray(weighted @ self.residuals.astype(weighted.dtype), dtype=np.float64)
        return whole - across @ cho_solve(self._factor, across.T), along - across @ self._pull


@dataclass(frozen=True)
class Seen:
    """Directions with the recalibration projected out.

    Args:
        whole: Squares of their lengths before, shape (k,).
        left: Squares of the lengths of what is left, shape (k,).
        along: Products of what is left with the residuals, shape (k,).
        noise: The same with each drawn null, shape (k, draws).
        across: Products with the derivatives of the fitted parameters, shape (k, free).
    """

    whole: Array
    left: Array
    along: Array
    noise: Array
    across: Array


def null_noise(count: int, draws: int, seed: int) -> tuple[AnyArray, np.random.Generator]:
    """Noise of deviation 1 for every residual of every null, shape (count, draws), and the source for what follows."""
    rng = np.random.default_rng(seed)
    return rng.standard_normal((count, draws), dtype=np.float32), rng


def _factored(normal: Array) -> tuple[Array, bool]:
    """Cholesky factor of a normal matrix with a hair more on its diagonal.

    Single precision, or a term that does nothing where it stands, must not make it indefinite.
    """
    size = np.diag(normal) + 1e-12 * np.max(np.diag(normal), initial=1e-300)
    for share in (1e-7, 1e-5, 1e-3):
        try:
            factor, is_lower = cho_factor(normal + np.diag(share * size))
        except LinAlgError:
            continue
        return factor, bool(is_lower)
    factor, is_lower = cho_factor(np.diag(size))
    return factor, bool(is_lower)


def shapes(term: Term) -> Iterator[tuple[float, ...]]:
    """Values of a term's parameters to try: a small strength, with every combination of the other starts.

    One sign of the strength is enough: along the straight line the other gives the same.
    """
    strength, *others = term.parameters
    size = SHARE * max(abs(s) for s in strength.starts)
    for rest in itertools.product(*(p.starts for p in others)):
        yield (size if strength.upper > 0.0 else -size, *rest)


@dataclass(frozen=True)
class Scoring:
    """All terms that were tried.

    Args:
        ranked: One score per term that would gain something, best first.
        tried: Choices of terms and shapes that were simulated and can be seen.
        chance: Largest gain of any of them in each simulated null, shape (draws,).
        leads: Term and values that have it, for each null.
    """

    ranked: list[Score]
    tried: int
    chance: Array
    leads: tuple[tuple[Term, tuple[float, ...]] | None, ...] = ()

    def joined(self, other: Scoring) -> Scoring:
        """Both together; they were scored against the same nulls."""
        ranked = sorted((*self.ranked, *other.ranked), key=lambda s: -s.gain)
        leads = tuple(
            mine if own >= theirs else other_one
            for own, theirs, mine, other_one in zip(self.chance, other.chance, self.leads, other.leads)
        )
        return Scoring(ranked, self.tried + other.tried, np.maximum(self.chance, other.chance), leads)

    def scaled(self, factor: float) -> Scoring:
        """The same with gains by chance that are larger by a factor: what refits find beyond straight lines."""
        return replace(self, chance=factor * self.chance)

    def margin(self, level: float) -> float:
        """Gain that the best of all terms exceeds with probability `level` where none is there."""
        return float(np.quantile(self.chance, 1.0 - level)) if self.tried and self.chance.size else 0.0

    def false_alarm_rate(self, gain: float) -> float:
        """Probability of a gain at least this large where nothing is missing, from the tail of the nulls.

        See `diagnosis.search.extreme.Gumbel`.
        """
        if not self.tried or not self.chance.size:
            return 1.0
        law = Gumbel.of(self.chance)
        if law.scale == 0.0:  # no null gained more than its price: one more null would be the first
            return 1.0 if gain <= self.chance[0] else 1.0 / (len(self.chance) + 1.0)
        return law.exceeded(gain)


def score(
    model: Model,
    base: Fit,
    terms: Iterable[Term],
    draws: int = 96,
    seed: int = 0,
    projection: Projection | None = None,
) -> Scoring:
    """Predicted gains of terms, and what chance alone would give them.

    Args:
        model: Model and recordings.
        base: Converged fit without the terms.
        terms: Terms to try, each with every combination of its starts.
        draws: Nulls: noise of the residuals and of the prior, seen along the terms' directions; `nulls` refits the best
            terms of some of them.
        seed: Of the random numbers.
        projection: Of that fit, with nulls drawn already; None: made here.
    """
    if projection is None:
        projection = Projection(base)
        projection.noise(draws, seed)
    draws = projection.draws
    tasks = [(term, values) for term in terms if term not in base.point.terms for values in shapes(term)]
    chance, tried = np.zeros(draws), 0
    leads: list[tuple[Term, tuple[float, ...]] | None] = [None] * draws
    best: dict[Term, list[Score]] = {}
    begins = range(0, len(tasks), BATCH)
    is_first = np.array([i == 0 or tasks[i - 1][0] is not term for i, (term, _) in enumerate(tasks)], dtype=int)
    sizes = [int(is_first[begin : begin + BATCH].sum()) for begin in begins]
    for begin in counted(begins, "laws at places scored", sizes):
        scores, largest, leading = _batch(model, base, tasks[begin : begin + BATCH], projection)
        tried += len(scores)
        leads = [new if b > a else old for a, b, old, new in zip(chance, largest, leads, leading)]
        chance = np.maximum(chance, largest)
        for found in scores:
            if found.gain > 0:
                best[found.term] = sorted([*best.get(found.term, ()), found], key=lambda s: -s.gain)[:2]
    ranked = [replace(one, second=more[0].values if more else None) for one, *more in best.values()]
    return Scoring(sorted(ranked, key=lambda s: -s.gain), tried, chance, tuple(leads))


def _batch(
    model: Model, base: Fit, tasks: Sequence[tuple[Term, tuple[float, ...]]], projection: Projection
) -> tuple[list[Score], Array, list[tuple[Term, tuple[float, ...]] | None]]:
    """Scores of what can be seen; the largest gain of any in each null, and what has it."""
    slopes = strength_slopes(model, base.point, base.residuals, tasks)
    usable = np.asarray((np.abs(slopes) < STEEPEST).all(axis=1))  # not a number is not below it either
    slopes[~usable] = 0.0
    seen = projection.look(slopes)
    is_visible = usable & (seen.left > LEAST_VISIBLE**2 * seen.whole) & (seen.left > 0.0)
    chosen = np.flatnonzero(is_visible).tolist()
    if not chosen:
        return [], np.zeros(seen.noise.shape[1]), [None] * seen.noise.shape[1]
    left, along = seen.left[chosen], seen.along[chosen]
    # The residuals' slope along a direction; the strength that would undo it has the other sign.
    toward = -seen.noise[chosen] / np.sqrt(left)[:, None]
    one_sided = np.array([_side(tasks[i][0]) for i in chosen])
    toward = np.where(one_sided[:, None] == 0, toward, np.maximum(one_sided[:, None] * toward, 0.0))
    scores = []
    for i, amount, length in zip(chosen, -along / left, left):
        term, values = tasks[i]
        strength = term.parameters[0]
        low, high = limits_of(model, strength)
        inside = min(max(float(amount), low), high)
        # A strength held at its bound (0 where it would act against its sign) gains less: the parabola there.
        gain = float(amount**2 * length - (amount - inside) ** 2 * length)
        visibility = float(np.sqrt(length / seen.whole[i]))
        scores.append(Score(term, (inside, *values[1:]), gain, visibility))
    leads: list[tuple[Term, tuple[float, ...]] | None] = []
    for draw, best in enumerate(np.argmax(toward**2, axis=0).tolist()):
        term, values = tasks[chosen[best]]
        strength = term.parameters[0]
        amount = -float(seen.noise[chosen[best], draw]) / float(left[best])
        leads.append((term, (min(max(amount, strength.lower), strength.upper), *values[1:])))
    return scores, np.asarray((toward**2).max(axis=0, initial=0.0)), leads


def _side(term: Term) -> int:
    """Sign that the strength must have; 0: either."""
    strength = term.parameters[0]
    return 1 if strength.lower >= 0.0 else -1 if strength.upper <= 0.0 else 0
