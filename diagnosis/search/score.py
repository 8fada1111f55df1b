"""How much each term would gain, from its simulated sensitivity with the recalibration projected out."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit import Array
from diagnosis.search.fit import Fit, huber_weights
from diagnosis.search.problem import Model, Term, strength_slopes

#: Strength at which a term is simulated, as a share of its first start value: small enough for a straight line.
SHARE = 0.02
#: Simulations per call, so that memory stays small.
BATCH = 256
#: A direction of which the recalibration absorbs all but this share of the length cannot be seen.
LEAST_VISIBLE = 1e-3


@dataclass(frozen=True)
class Score:
    """What a term promises at one choice of its shape.

    Args:
        term: The term.
        values: Its parameters, strength by the straight line.
        gain: Predicted fall of -2 log posterior.
        direction: What it changes in residuals and prior beyond all recalibration, of length 1, shape
            (residuals + parameters,).
        visibility: Share of its effect that the recalibration does not absorb, in [0, 1].
    """

    term: Term
    values: tuple[float, ...]
    gain: float
    direction: Array
    visibility: float


class Projection:
    """Removes from a direction what a change of the fitted parameters would do as well.

    Args:
        base: The fit.
    """

    def __init__(self, base: Fit) -> None:
        self.weights = huber_weights(base.residuals)
        self.residuals = self.weights * base.residuals
        self._rows = len(base.residuals)
        jacobian = base.jacobian.copy()
        scale = np.linalg.norm(jacobian, axis=0)
        self._basis = np.linalg.qr(jacobian / np.where(scale > 0, scale, 1.0))[0]
        self._augmented = np.concatenate([self.residuals, base.point.base])
        self._free = self._augmented - self._basis @ (self._basis.T @ self._augmented)

    def remove(self, directions: Array) -> Array:
        """Directions (k, residuals) to what remains of them in residuals and prior, (k, residuals + parameters)."""
        padded = np.zeros((len(directions), len(self._augmented)))
        padded[:, : self._rows] = directions * self.weights
        return np.asarray(padded - (padded @ self._basis) @ self._basis.T)

    def gain(self, remaining: Array) -> tuple[Array, Array]:
        """Strength and gain along remaining directions, (k,) each."""
        length = np.einsum("ij,ij->i", remaining, remaining)
        along = remaining @ self._free
        safe = np.where(length > 0, length, 1.0)
        return np.asarray(-along / safe), np.asarray(along**2 / safe)


def shapes(term: Term) -> Iterator[tuple[float, ...]]:
    """Values of a term's parameters to try: a small strength, with every combination of the other starts."""
    strength, *others = term.parameters
    for sign in sorted({1.0 if s >= 0 else -1.0 for s in strength.starts}, reverse=True):
        size = max(abs(s) for s in strength.starts)
        for rest in itertools.product(*(p.starts for p in others)):
            yield (sign * SHARE * size, *rest)


@dataclass(frozen=True)
class Scoring:
    """All terms that were tried.

    Args:
        ranked: One score per term that would gain something, best first.
        tried: Choices of terms and shapes that were simulated and can be seen.
        chance: Largest gain of any of them in each simulated null, shape (draws,).
    """

    ranked: list[Score]
    tried: int
    chance: Array

    def joined(self, other: Scoring) -> Scoring:
        """Both together; they were scored against the same nulls."""
        ranked = sorted((*self.ranked, *other.ranked), key=lambda s: -s.gain)
        return Scoring(ranked, self.tried + other.tried, np.maximum(self.chance, other.chance))

    def margin(self, level: float) -> float:
        """Gain that the best of all terms exceeds with probability `level` where none is there."""
        return float(np.quantile(self.chance, 1.0 - level)) if self.tried else 0.0

    def false_alarm_rate(self, gain: float) -> float:
        """Probability of a gain at least this large where nothing is missing, from the tail of the nulls.

        The largest of many gains follows a Gumbel law; its scale is taken from mean and deviation of the draws.
        """
        scale = float(np.std(self.chance)) * np.sqrt(6.0) / np.pi
        if not self.tried or scale == 0.0:
            return 1.0
        place = float(np.mean(self.chance)) - 0.5772156649015329 * scale
        return float(-np.expm1(-np.exp(-(gain - place) / scale)))


def score(model: Model, base: Fit, terms: Iterable[Term], draws: int = 200, seed: int = 0) -> Scoring:
    """Predicted gains of terms, and what chance alone would give them.

    Args:
        model: Model and recordings.
        base: Converged fit without the terms.
        terms: Terms to try, each with every combination of its starts.
        draws: Simulated nulls: noise of the residuals and of the prior, seen along the terms' directions. A refit gains
            what the straight line predicts within a few per cent, so nulls need no simulation of their own here.
        seed: Of the random numbers.
    """
    projection = Projection(base)
    tasks = [(term, values) for term in terms if term not in base.point.terms for values in shapes(term)]
    noise = np.random.default_rng(seed).standard_normal((len(base.residuals) + len(base.point.base), draws))
    noise = noise.astype(np.float32)
    chance, tried = np.zeros(draws), 0
    best: dict[Term, Score] = {}
    for begin in range(0, len(tasks), BATCH):
        batch = tasks[begin : begin + BATCH]
        seen = list(_batch(model, base, batch, projection))
        tried += len(seen)
        if seen:
            along = np.array([s.direction for s in seen], dtype=np.float32) @ noise
            one_sided = np.array([_is_one_sided(s.term) for s in seen])
            along = np.where(one_sided[:, None], np.maximum(along, 0.0), along)
            chance = np.maximum(chance, (along.astype(np.float64) ** 2).max(axis=0))
        for found in seen:
            if found.gain > 0 and (found.term not in best or found.gain > best[found.term].gain):
                best[found.term] = found
    return Scoring(sorted(best.values(), key=lambda s: -s.gain), tried, chance)


def _is_one_sided(term: Term) -> bool:
    return term.parameters[0].lower >= 0.0 or term.parameters[0].upper <= 0.0


def _batch(
    model: Model, base: Fit, tasks: Sequence[tuple[Term, tuple[float, ...]]], projection: Projection
) -> Iterator[Score]:
    slopes = strength_slopes(model, base.point, base.residuals, tasks)
    usable = np.asarray(np.isfinite(slopes).all(axis=1))
    slopes[~usable] = 0.0
    remaining = projection.remove(slopes)
    amounts, gains = projection.gain(remaining)
    whole = np.linalg.norm(slopes * projection.weights, axis=1)
    rest = np.linalg.norm(remaining, axis=1)
    for i, (term, values) in enumerate(tasks):
        visibility = rest[i] / whole[i] if whole[i] > 0 else 0.0
        if not usable[i] or visibility < LEAST_VISIBLE:
            continue
        strength = term.parameters[0]
        inside = min(max(float(amounts[i]), strength.lower), strength.upper)
        # A strength held at its bound (0 where it would act against its sign) gains less: the parabola there.
        gain = float(gains[i]) - (float(amounts[i]) - inside) ** 2 * float(rest[i]) ** 2
        yield Score(term, (inside, *values[1:]), gain, remaining[i] / rest[i], float(visibility))
