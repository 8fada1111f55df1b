"""Effects that leave the same in these channels: angles between what they change, recalibration taken away.

The structure of equations knows no sizes. Here every effect of the catalogue is simulated at the recalibrated point;
what the model's own parameters would do as well is projected out (angles: A. Björck and G. H. Golub, Math. Comput. 27
(1973) 579-594).
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import huber_weights
from diagnosis.search.problem import Model, Term, strength_slopes

#: Strength at which an effect is simulated, as a share of its middle start value.
SHARE = 0.02
#: Most shapes of an effect that are tried.
SHAPES = 4
#: Fall of -2 log posterior below which an effect does not show, and below which two cannot be told apart.
SHOWS, APART = 12.0, 6.0


@dataclass(frozen=True)
class Effect:
    """What one effect does in these channels.

    Args:
        term: At its widest place.
        strength: Middle one of its start values.
        gain: Fall of -2 log posterior that it would give at this strength.
        visibility: Share of its change that the recalibration does not absorb.
        absorbed_by: The model's parameter that absorbs most.
    """

    term: Term
    strength: float
    gain: float
    visibility: float
    absorbed_by: str


@dataclass(frozen=True)
class Alike:
    """Two effects that these channels hardly tell apart.

    Args:
        one: Identifier.
        other: Identifier.
        cosine: Of the angle between their changes, the recalibration taken away.
        gain: Fall of -2 log posterior that remains for the right one against the other, refitted.
    """

    one: str
    other: str
    cosine: float
    gain: float


def widest(terms: Sequence[Term]) -> list[Term]:
    """Every named effect once, at its widest place; for each quantity that it measures if it is one of a sensor."""
    found: dict[tuple[str, str], Term] = {}
    for term in terms:
        if not term.is_named or " and " in term.place:  # two channels exchanged: one pair of very many
            continue
        quantity = term.place.rpartition(".")[2].removeprefix("every ") if term.unit == "measurement" else ""
        key = (term.identifier, quantity)
        if key not in found or _width(term.place) > _width(found[key].place):
            found[key] = term
    return list(found.values())


def _width(place: str) -> int:
    is_pattern = place.startswith(("gradient", "ends ", "outer ", "edge ", "place "))
    return 2 if place.startswith(("all ", "every ", "supply")) else 1 if is_pattern else 0


def effects(model: Model, fit: Fit, terms: Sequence[Term]) -> tuple[list[Effect], list[Alike]]:
    """What each effect does, and which look alike, the closest first.

    Args:
        model: Model with its recordings.
        fit: Recalibrated, without terms.
        terms: Effects at their places; see `widest`.
    """
    tasks = [(term, shape) for term in terms for shape in _shapes(term)]
    if not tasks:
        return [], []
    slopes = np.asarray(strength_slopes(model, fit.point, fit.residuals, tasks), dtype=np.float64)
    slopes[~np.isfinite(slopes).all(axis=1)] = 0.0
    weights = huber_weights(fit.residuals)
    whole = slopes * weights
    across = whole @ (fit.columns.values * weights[:, None])
    absorbing = np.asarray(np.linalg.solve(fit.information, across.T).T, dtype=np.float64)
    gram = whole @ whole.T - absorbing @ across.T
    sizes = np.sum(whole**2, axis=1)
    numbers: dict[Term, list[int]] = {}
    for n, (term, _) in enumerate(tasks):
        numbers.setdefault(term, []).append(n)
    names = [p.name for p in model.parameters]
    found = {term: _effect(term, own, gram, sizes, (absorbing, across, names)) for term, own in numbers.items()}
    shown = [t for t, e in found.items() if e.gain > SHOWS]
    pairs = [_alike(found, numbers, gram, a, b) for a, b in itertools.combinations(shown, 2)]
    close = sorted((p for p in pairs if p.gain < APART), key=lambda p: -p.cosine)
    return list(found.values()), close


def _shapes(term: Term) -> list[tuple[float, ...]]:
    size = SHARE * _middle(term)
    every = itertools.product(*(p.starts for p in term.parameters[1:]))
    return [(size, *rest) for rest in itertools.islice(every, SHAPES)]


def _middle(term: Term) -> float:
    strength = term.parameters[0]
    sizes = sorted(abs(s) for s in strength.starts if s)
    middle = sizes[len(sizes) // 2] if sizes else 1.0
    return middle if strength.upper > 0.0 else -middle


def _effect(
    term: Term, own: Sequence[int], gram: Array, sizes: Array, absorption: tuple[Array, Array, Sequence[str]]
) -> Effect:
    absorbing, across, names = absorption
    best = max(own, key=lambda n: gram[n, n])
    left = max(float(gram[best, best]), 0.0)
    visibility = float(np.sqrt(left / sizes[best])) if sizes[best] > 0.0 else 0.0
    shares = absorbing[best] * across[best]
    strongest = int(np.argmax(shares)) if sizes[best] > 0.0 and len(shares) else -1  # no number may be free
    strength = _middle(term)
    return Effect(term, strength, strength**2 * left, visibility, names[strongest] if strongest >= 0 else "")


def _alike(
    found: Mapping[Term, Effect], numbers: Mapping[Term, Sequence[int]], gram: Array, one: Term, other: Term
) -> Alike:
    """The angle between the directions of two effects over all their shapes; the gain is the smaller of both."""
    cosine = 0.0
    for a in numbers[one]:
        for b in numbers[other]:
            size = gram[a, a] * gram[b, b]
            if size > 0.0:
                cosine = max(cosine, float(abs(gram[a, b]) / np.sqrt(size)))
    cosine = min(cosine, 1.0)
    least = min(found[one].gain, found[other].gain)
    return Alike(one.identifier, other.identifier, cosine, least * (1.0 - cosine**2))
