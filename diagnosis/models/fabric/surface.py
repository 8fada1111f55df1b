"""Answers of a fabric to its parameters, interpolated between few simulations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.problem import Point, Term


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

    def add(self, term: Term, strength: float, bins: Array, z: Array) -> None:
        """A simulation with a term.

        Args:
            term: The term.
            strength: Its strength, not 0.
            bins: What it gave, shape (bins,).
            z: z of the parameters there.
        """
        self._knots.setdefault(term, {})[strength] = bins - self.mean - (z - self.anchor) @ self.slopes

    def knots(self, term: Term) -> list[float]:
        """Strengths at which a term was simulated."""
        return sorted(self._knots.get(term, {}))

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
        other.slopes, other._knots = self.slopes, self._knots
        return other
