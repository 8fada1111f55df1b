"""Explanations beside the accepted one, with their probabilities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.acceptance import UNSEPARATED, Accepted
from diagnosis.judge.diagnosis import Alternative
from diagnosis.search.problem import Term
from diagnosis.search.search import Explanation, Outcome

#: Like `UNSEPARATED`, of laws that are interpolated between few simulations, whose means scatter: what the search of a
#: fabric goes on with (`diagnosis.models.fabric.search`).
INTERPOLATED = 40.0
#: Probability beyond which another explanation is open.
OPEN = 0.05


def probabilities(costs: Sequence[float]) -> Array:
    """Posterior probabilities of explanations, from their -2 log posteriors."""
    values = np.asarray(costs, dtype=np.float64)
    weights = np.exp(-0.5 * (values - values.min()))
    return np.asarray(weights / weights.sum())


def bends_into(rival: Explanation, best: Explanation) -> bool:
    """Whether a rival is a law without a name and with a free shape where the best has names: it can bend into those.

    That it then explains as much is no ambiguity, and no experiment would part the two.
    """
    return all(t.is_named for t in best.terms) and not all(t.is_named for t in rival.terms)


def open_rivals(alternatives: Sequence[Alternative], term: Term, accepted: Accepted) -> tuple[str, ...]:
    """Effects with odds of more than 1 to 20 against this one, the most probable first."""
    own = max((a.gain for a in alternatives if a.effect == term.identifier), default=0.0)
    best = accepted.headline
    bends = {t.identifier for e, _ in accepted.rivals if bends_into(e, best) for t in e.terms if not t.is_named}
    near = [a for a in alternatives if a.probability > OPEN or (a.gain > own - UNSEPARATED and a.effect not in bends)]
    simulated = [other.identifier for other in _undecided(accepted, term)]
    return tuple(dict.fromkeys([*(a.effect for a in near if a.effect != term.identifier), *simulated]))


def _undecided(accepted: Accepted, term: Term) -> list[Term]:
    """Laws between which and this one few simulations do not decide, see `Accepted.confused`."""
    return [other for other, behind in accepted.confused.get(term, ()) if behind < INTERPOLATED]


def alternatives_to(outcome: Outcome, accepted: Accepted, term: Term) -> tuple[list[Alternative], float]:
    """Explanations that have another term in the place of this one, and the probability of this one."""
    others = set(accepted.headline.terms) - {term}
    size = len(others) + 1
    rivals = [(e, total) for e, total in accepted.rivals if others <= set(e.terms) and len(e.terms) == size]
    if not rivals:
        return _shared([], 1.0, _undecided(accepted, term))
    chances = probabilities([total for _, total in rivals])
    worst = max(e.fit.cost for e, _ in rivals)
    found, own = [], 0.0
    for (explanation, _), chance in sorted(zip(rivals, chances), key=lambda pair: -pair[1]):
        other = next(t for t in explanation.terms if t not in others)
        gain = outcome.base.cost - explanation.fit.cost if not others else worst - explanation.fit.cost
        found.append(Alternative(other.identifier, other.place, float(gain), float(chance)))
        if other.identifier == term.identifier:
            own += float(chance)
    return _shared(found, own, _undecided(accepted, term))


def _shared(found: list[Alternative], own: float, undecided: Sequence[Term]) -> tuple[list[Alternative], float]:
    """The same with laws between which few simulations do not decide: each of them is as probable as the one found."""
    if not undecided:
        return found, own
    parts = 1.0 + len(undecided)
    less = [replace(a, probability=a.probability / parts) for a in found]
    more = [Alternative(t.identifier, t.place, found[0].gain if found else 0.0, own / parts) for t in undecided]
    return [*less, *more], own / parts
