"""Answers of a fabric to its parameters, interpolated between few simulations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.problem import Point, Term

#: A strength this close to one that was simulated, as a share of it, needs no other simulation.
NEAR = 0.15


def is_near(one: float, other: float) -> bool:
    """Whether two strengths are alike.

    >>> is_near(1.0, 1.1), is_near(1.0, -1.0)
    (True, False)
    """
    return abs(one - other) <= NEAR * max(abs(other), 1e-12)


class Surface:
    """Bins of all mechanical channels as a function of parameters and strengths of terms.

    Straight lines in the parameters, pieces of straight lines between the strengths at which a term was simulated,
    and sums over terms: few simulations give no more. A term that is accepted is simulated where it was fitted.

    Args:
        mean: Bins at the anchor, mean of an ensemble, shape (bins,).
        anchor: z of the parameters there, shape (parameters,).
    """

    def __init__(self, mean: Array, anchor: Array) -> None:
        self.mean, self.anchor = mean, anchor.copy()
        #: Derivative of the bins by each z, shape (parameters, bins).
        self.slopes = np.zeros((len(anchor), len(mean)))
        self._knots: dict[Term, dict[float, Array]] = {}
        #: Starts over which each knot is a mean.
        self._starts: dict[Term, dict[float, int]] = {}

    def add(self, term: Term, strength: float, bins: Array, z: Array, starts: int = 1) -> None:
        """A simulation with a term; it stands in place of those at nearly the same strength from no more starts.

        Two means that scatter, side by side, would make a slope of nothing.

        Args:
            term: The term.
            strength: Its strength, not 0.
            bins: What it gave, mean over its starts, shape (bins,).
            z: z of the parameters there.
            starts: From how many starts.
        """
        knots, known = self._knots.setdefault(term, {}), self._starts.setdefault(term, {})
        for other in [k for k in knots if known[k] <= starts and is_near(k, strength)]:
            del knots[other], known[other]
        knots[strength] = bins - self.mean - (z - self.anchor) @ self.slopes
        known[strength] = starts

    def has_near(self, term: Term, strength: float, starts: int) -> bool:
        """Whether a term was simulated at nearly this strength, from so many starts or more."""
        return any(is_near(k, strength) and n >= starts for k, n in self._starts.get(term, {}).items())

    def strengths(self, term: Term) -> list[float]:
        """Strengths at which a term is known."""
        return sorted(self._knots.get(term, {}))

    def forget(self, term: Term) -> None:
        """Forget what a term does."""
        self._knots.pop(term, None)
        self._starts.pop(term, None)

    def knows(self, term: Term) -> bool:
        """Whether a term was simulated at all."""
        return term in self._knots

    def effect(self, term: Term, strength: float) -> Array:
        """What a term changes, shape (bins,); beyond its simulations the last straight piece goes on."""
        own = self._knots[term]
        places = sorted([0.0, *own])
        rows = [np.zeros_like(self.mean) if p == 0.0 else own[p] for p in places]
        right = int(np.clip(np.searchsorted(places, strength), 1, len(places) - 1))
        low, high = places[right - 1], places[right]
        share = (strength - low) / (high - low)
        return np.asarray((1.0 - share) * rows[right - 1] + share * rows[right])

    def slope(self, term: Term, strength: float) -> Array:
        """Change of what a term does by its strength, over a tenth of it either way, shape (bins,)."""
        step = 0.1 * strength
        return (self.effect(term, strength + step) - self.effect(term, strength - step)) / (2.0 * step)

    def bins(self, points: Sequence[Point], z: Sequence[Array]) -> Array:
        """Bins at points, shape (points, bins).

        Args:
            points: Their terms count.
            z: Of the parameters of this surface, for each point.
        """
        found = []
        for point, own in zip(points, z):
            row = self.mean + (own - self.anchor) @ self.slopes
            for term, values in point.terms.items():
                if term in self._knots:
                    row = row + self.effect(term, values[0])
            found.append(row)
        return np.array(found)

    def with_mean(self, mean: Array, anchor: Array) -> Surface:
        """The same answers about another anchor."""
        other = Surface(mean, anchor)
        other.slopes, other._knots, other._starts = self.slopes, self._knots, self._starts
        return other
