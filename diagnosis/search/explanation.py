"""What the search may spend, and what it compares: explanations, fitted models with terms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from diagnosis.search.fit import Fit
from diagnosis.search.problem import Term

#: -2 log of the prior odds of a generic law against one of the catalogue: they are many, and any of them may bend well.
UNNAMED = 6.0


@dataclass(frozen=True)
class Settings:
    """What the search may spend and what it must be shown.

    Args:
        level: Rate of false alarms that is allowed.
        floor: Least gain, whatever chance would give: every real rig has many tiny effects.
        beam: Models that are carried forward.
        refits: Best-scored terms that are refitted per model.
        most_terms: Terms that a model may have.
        seed: Of all random numbers.
        nulls: Recordings without any effect that the search is run on.
        stops_at_noise: Whether it stops once what is left looks like noise; not where the noise was told from what was
            left.
        trials: Most laws with a name that are fitted from other starts where the first model misses by more than noise
            and none of the best-scored terms explains it: a straight line says little of what is far from straight.
    """

    level: float = 0.05
    floor: float = 20.0
    beam: int = 2
    refits: int = 6
    most_terms: int = 3
    seed: int = 0
    nulls: int = 7
    stops_at_noise: bool = True
    trials: int = 0


@dataclass(frozen=True)
class Explanation:
    """A model with terms that were fitted.

    Args:
        fit: Converged fit of everything together.
        gains: Fall of -2 log posterior by each term, all others kept.
        without: Fits without each term, all others kept, of the same model; empty where they were not made.
    """

    fit: Fit
    gains: Mapping[Term, float] = field(default_factory=dict)
    without: Mapping[Term, Fit] = field(default_factory=dict, compare=False, repr=False)

    @property
    def terms(self) -> tuple[Term, ...]:
        """Its terms."""
        return tuple(self.fit.point.terms)

    @property
    def is_negligible(self) -> bool:
        """Whether one of its terms is smaller than what every rig has of it."""
        return any(abs(values[0]) < t.parameters[0].negligible for t, values in self.fit.point.terms.items())

    @property
    def cost(self) -> float:
        """-2 log posterior of the fit, and what the odds are against its terms before any data.

        Laws without a name are many, and so are the intervals of time that a fault may have.
        """
        return self.fit.cost + UNNAMED * sum(not t.is_named for t in self.terms) + self.price

    @property
    def price(self) -> float:
        """What its faults with begin and end cost before any data; see `Term.price`."""
        return sum(t.price for t in self.terms)

    @property
    def demerit(self) -> float:
        """What explanations are compared by: a free shape must pay for itself too (Laplace's approximation).

        The price of a fault is that of its begin and end.
        """
        extra = sum(len(t.parameters) - 1 for t in self.terms if not t.price)
        return self.cost + extra * float(np.log(max(len(self.fit.residuals), 2)))
