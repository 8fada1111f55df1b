"""Whether what a law leaves has the form of other laws at its place: then the form of the law is not the right one.

Odds compare a law with those that were tried. Where what acts is in no library, the nearest of them wins by any odds
and leaves a misfit that quantities of the same place explain: another power, a saturation, a memory. Where a law is
right and something else is missing, what is left depends on quantities elsewhere. So a few directions of other laws at
the place are fitted to what is left, all fitted numbers free to move with them.

Source: lack-of-fit test by added variables, N. R. Draper and H. Smith, Applied Regression Analysis, 3rd ed., Wiley
1998, section 12.2; forward choice of directions: J. A. Tropp, IEEE Trans. Inf. Theory 50 (2004) 2231-2242.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from cosim.unit.protocol import Array
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Term, strength_slopes
from diagnosis.search.score import LEAST_VISIBLE, STEEPEST, Projection, shapes

#: Directions that are fitted to what is left: as many as a curve of one quantity needs to be seen as one.
DIRECTIONS = 3
#: Share of what is left from which other laws at the place explain it: more than all other places together can.
EXPLAINED = 0.5
#: Simulations in one call, so that memory stays small.
BATCH = 64


def companions(model: DiagnosisModel, term: Term) -> list[Term]:
    """Other laws of the same component and unit, in whatever equation: they see the quantities that the law sees.

    Laws of one day and of sensors are none: these bend to anything.
    """
    own = _components(model, term)
    return [
        t
        for t in model.terms()
        if t.identifier != term.identifier
        and t.unit == term.unit
        and t.recording is None
        and not any(p.is_instant or p.is_switch for p in t.parameters)
        and _components(model, t) & own
    ]


def _components(model: DiagnosisModel, term: Term) -> frozenset[str]:
    """Components or elements at which a law acts: `motor` of `motor.w`, `coil[1,2]` of itself."""
    return frozenset({model.where(term)[1].label.split(".")[0]})


def share_at_place(model: DiagnosisModel, fit: Fit, terms: Sequence[Term]) -> float:
    """Share of what a fit leaves beyond the noise that a few directions of laws explain, from 0 to 1.

    Args:
        model: Model of the training recordings.
        fit: With the law whose form is asked about.
        terms: Other laws at its place.
    """
    noise = 1.0 / model.inflation[np.asarray(model.layout.channel, dtype=int)]
    used = fit.residuals != 0.0
    projection = Projection(fit)
    left = float(np.sum(projection.residuals[used] ** 2) - np.sum(noise[used]))
    tasks = [(t, values) for t in terms if t not in fit.point.terms for values in shapes(t)]
    if left <= 0.0 or not tasks:
        return 0.0
    kept: list[Array] = []
    for begin in range(0, len(tasks), BATCH):
        slopes = strength_slopes(model, fit.point, fit.residuals, tasks[begin : begin + BATCH])
        whole = np.sqrt(np.sum((slopes * projection.weights) ** 2, axis=1))
        is_usable = (np.abs(slopes) < STEEPEST).all(axis=1) & (whole > 0.0)
        kept += list(slopes[is_usable] / whole[is_usable, None])
    if not kept:
        return 0.0
    products, along = projection.gram(np.array(kept))
    return min(_forward(products, along) / left, 1.0)


def _forward(products: Array, along: Array) -> float:
    """Fall of the sum of squares by a few directions, each the one that lowers it most with those before.

    Args:
        products: Of the directions with each other, each of length 1 before fitted numbers were projected out.
        along: Of the directions with the residuals.
    """
    chosen: list[int] = []
    fall = 0.0
    for _ in range(min(DIRECTIONS, len(along))):
        found = [(_fall(products, along, [*chosen, i]), i) for i in range(len(along)) if i not in chosen]
        most, best = max(found)
        if most <= fall:
            break
        fall, chosen = most, [*chosen, best]
    return fall


def _fall(products: Array, along: Array, chosen: Sequence[int]) -> float:
    """Fall of the sum of squares by some directions together; 0 where fitted numbers do what one of them does."""
    normal = products[np.ix_(chosen, chosen)]
    if np.diag(normal).min() <= LEAST_VISIBLE**2:
        return 0.0
    try:
        factor = cho_factor(normal + np.diag(1e-9 * np.diag(normal)))
    except LinAlgError:
        return 0.0
    return float(along[list(chosen)] @ cho_solve(factor, along[list(chosen)]))
