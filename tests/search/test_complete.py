"""What is left is described by a sum of generic terms: those that are there, no others, and not before all else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.search import complete
from diagnosis.search.complete import completed
from diagnosis.search.fit import fit
from diagnosis.search.problem import Layout, Parameter, Point, Term, TermParameter
from diagnosis.search.search import Explanation, Settings, search, shrink

TIMES = np.linspace(0.0, 10.0, 300)
MARGIN = 20.0


def generic(name: str) -> Term:
    strength = TermParameter("a", "1", -100.0, 100.0, (0.1,))
    return Term(name, "all coils", "thermal", (strength,), is_named=False, is_completing=True)


class Sums:
    """A straight line, with terms that add a wave of so many periods each; readings are given."""

    parameters = (Parameter("level", "1", 0.0, 10.0, False), Parameter("slope", "1", 0.0, 10.0, False))
    layout = Layout(np.zeros(300, dtype=int), TIMES, ("bath.temperature",), ("thermal",))

    def __init__(self, readings: np.ndarray) -> None:
        self.readings = readings

    def residuals(self, points: Sequence[Point]) -> np.ndarray:
        found = []
        for p in points:
            curve = 10.0 * p.base[0] + p.base[1] * TIMES
            for term, values in p.terms.items():
                curve = curve + values[0] * wave(int(term.identifier.split("_")[-1]))
            found.append(self.readings - curve)
        return np.array(found)

    def base_jacobian(self, point: Point) -> np.ndarray:
        return -np.stack([np.full(300, 10.0), TIMES], axis=1)


def wave(periods: int) -> np.ndarray:
    return np.sin(2.0 * np.pi * periods * TIMES / 10.0)


TERMS = [generic(f"wave_{n}") for n in range(2, 12)]
NOISE = np.random.default_rng(7).standard_normal(300)


def described(readings: np.ndarray) -> Explanation:
    model = Sums(readings)
    start = Explanation(fit(model, Point(np.zeros(2))))
    return shrink(model, completed(model, start, TERMS, Settings(), MARGIN), MARGIN)


def test_a_sum_of_five_is_found_and_nothing_else():
    there = {3: 4.0, 4: -3.0, 6: 2.0, 8: 1.5, 9: -1.0}
    found = described(sum(a * wave(n) for n, a in there.items()) + NOISE)
    values = {int(t.identifier.split("_")[-1]): v[0] for t, v in found.fit.point.terms.items()}
    assert set(values) == set(there)
    # Of a wave in 300 readings with noise of 1 the deviation is sqrt(2 / 300) = 0.08.
    assert all(abs(values[n] - a) < 0.3 for n, a in there.items())


def test_noise_is_described_by_nothing():
    assert described(NOISE).terms == ()


def test_no_more_terms_than_the_limit():
    found = described(sum(4.0 * wave(n) for n in range(2, 12)) + NOISE)
    assert len(found.terms) <= complete.MOST


def test_what_completes_is_no_law_that_a_search_tries():
    """One wave is all that is missing: a term that only completes is not taken for it, the same as a law is."""
    model = Sums(4.0 * wave(3) + NOISE)
    assert search(model, TERMS, Settings()).best.terms == ()
    laws = [replace(t, is_completing=False) for t in TERMS]
    assert [t.identifier for t in search(model, laws, Settings()).best.terms] == ["wave_3"]
