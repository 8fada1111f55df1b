"""A law for an unknown input: few terms out of many, as many as recordings that were not fitted confirm.

Terms are added one by one, each time all are fitted again and those that are not needed are dropped; a term stays only
if what was found in some recordings explains the others too.

Source: sequentially thresholded sparse regression, S. L. Brunton, J. L. Proctor and J. N. Kutz, PNAS 113 (2016)
3932-3937; choice by cross-validation, T. Hastie, R. Tibshirani and J. Friedman, The Elements of Statistical Learning,
2nd ed., Springer 2009, section 7.10. The regression is made in the channels (what a term would do there), not on the
estimated course, so that noise and parameters count as they should.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.locate.course import Course
from diagnosis.locate.equation import Equation, Products
from diagnosis.locate.statistic import Tested
from diagnosis.locate.terms import Feature, features, multiplier

#: Most terms of a law.
MOST = 3
#: Fall of -2 log posterior that a further term must bring in recordings that it was not fitted to, and in those it was.
CONFIRMED, NEEDED = 4.0, 9.0
#: Pieces into which a single recording is cut for cross-validation.
PIECES = 4


def responses(equation: Equation, courses: Sequence[Course], target: str, by_string: bool) -> list[Array]:
    """What each term would do in the channels, for amplitudes of 1, shape (samples, channels, terms) for each panel.

    Args:
        equation: Where.
        courses: Of every recording.
        target: Equation of the catalogue.
        by_string: Whether inputs of coils add up in their string (voltages).
    """
    inputs = {}
    for recording in {panel.recording for _, panel, _ in equation.members}:
        course = courses[recording]
        factor = multiplier(course, target)[0]
        inputs[recording] = np.stack([factor * f.values for f in features(course, target)], axis=2)
    found = []
    for _, panel, members in equation.members:
        own = inputs[panel.recording]
        assert panel.respond is not None
        response = np.zeros((len(panel.times), len(members), own.shape[2]))
        for k, member in enumerate(members):
            element = int(panel.elements[member])
            acting = (
                _of_string(own, courses[panel.recording], element, panel.quantity) if by_string else own[:, element]
            )
            response[:, k] = panel.respond(element) @ acting
        found.append(response)
    return found


def _of_string(values: Array, course: Course, string: int, quantity: str) -> Array:
    """Sum of the coils' voltages; of the supply's current the mean over its strings."""
    total = np.stack([values[:, course.string_of_coil == s].sum(axis=1) for s in range(len(course.string_resistance))])
    return np.asarray(total.mean(axis=0) if quantity == "supply_current" else total[string])


def folds(tested: Tested) -> list[list[Array]]:
    """Masks of the samples of each panel: recordings, or pieces in time where there is one recording."""
    recordings = sorted({p.recording for p in tested.panels})
    if len(recordings) > 1:
        return [[np.full(len(p.times), p.recording == r) for p in tested.panels] for r in recordings]
    found = []
    for piece in range(2):
        masks = []
        for panel in tested.panels:
            span = max(float(panel.times[-1] - panel.times[0]), 1e-9)
            number = np.minimum(PIECES * (panel.times - panel.times[0]) / span, PIECES - 1).astype(int)
            masks.append(number % 2 == piece)
        found.append(masks)
    return found


def select(whole: Products, parts: Sequence[Products]) -> tuple[list[int], Array]:
    """Numbers of the terms of a law, the most important first, and their amplitudes.

    Args:
        whole: Products of all terms over all recordings.
        parts: The same for each part alone.
    """
    chosen: list[int] = []
    confirmed = 0.0
    while len(chosen) < MOST:
        grown = _grown(whole, chosen)
        if grown is None or _gain(whole, grown) - _gain(whole, chosen) < NEEDED:
            break
        now = _confirmed(parts, grown)
        if now - confirmed < CONFIRMED:
            break
        chosen, confirmed = grown, now
    return chosen, _solve(whole, chosen) if chosen else np.zeros(0)


def _grown(whole: Products, chosen: Sequence[int]) -> list[int] | None:
    """One term more, the best; then without those that are no longer needed."""
    usable = [n for n in range(len(whole.along)) if n not in chosen and whole.gram[n, n] > 1e-12]
    if not usable:
        return None
    best = [*chosen, max(usable, key=lambda n: _gain(whole, [*chosen, n]))]
    total = _gain(whole, best)
    kept = [n for n in best if total - _gain(whole, [m for m in best if m != n]) > NEEDED]
    return kept if kept and set(kept) != set(chosen) else None


def _solve(products: Products, chosen: Sequence[int]) -> Array:
    part = products.only(chosen)
    size = np.sqrt(np.maximum(np.diag(part.gram), 1e-300))
    scaled = part.gram / np.outer(size, size) + 1e-9 * np.eye(len(size))
    return np.asarray(np.linalg.solve(scaled, part.along / size) / size)


def _gain(products: Products, chosen: Sequence[int]) -> float:
    return products.only(chosen).gain(_solve(products, chosen)) if chosen else 0.0


def _confirmed(parts: Sequence[Products], chosen: Sequence[int]) -> float:
    """Gain in each part of what the others give, summed."""
    total = 0.0
    for number, part in enumerate(parts):
        others = [p for n, p in enumerate(parts) if n != number]
        together = Products(
            sum((p.gram for p in others), start=np.zeros_like(part.gram)),
            sum((p.along for p in others), start=np.zeros_like(part.along)),
        )
        total += part.only(chosen).gain(_solve(together, chosen))
    return total


def formula(law: str, chosen: Sequence[Feature], amounts: Array) -> str:
    """The law with its numbers."""
    terms = [f"{amount:.6g} * ({feature.formula})" for feature, amount in zip(chosen, amounts)]
    return law.format(" + ".join(terms))
