"""Laws that act against each other: what is left of both may be one law of another form.

A rectifier, say, is met by a voltage against the current and a constant one with it, which cancel for one sign of the
current. Either alone would change the readings far more than both together do.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.problem import Point, Term

#: Share of what each law does alone below which the sum of two counts as a difference of large numbers.
CANCELLED = 0.6


def opposed(model: DiagnosisModel, point: Point, terms: Sequence[Term]) -> dict[Term, Term]:
    """Law to another one that it mostly cancels; laws that none cancels are left out.

    Args:
        model: Model of the training recordings.
        point: With all of them.
        terms: Laws to compare.
    """
    pairs = list(itertools.combinations(terms, 2))
    points = [point, *(point.without(t) for t in terms), *(point.without(a).without(b) for a, b in pairs)]
    here, *others = model.plain.residuals(points) if pairs else [np.zeros(0)]
    sizes = [float(np.sqrt(np.sum((r - here) ** 2))) for r in others]
    alone = dict(zip(terms, sizes))
    found: dict[Term, Term] = {}
    for (a, b), both in zip(pairs, sizes[len(terms) :]):
        if np.isfinite(both) and both < CANCELLED * min(alone[a], alone[b]):
            found |= {a: b, b: a}
    return found
