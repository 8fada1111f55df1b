"""A model whose residuals are known in closed form: a line through readings, with bends that may be missing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.problem import Layout, Parameter, Point, Term, TermParameter

#: Readings per channel.
COUNT = 400
TIME = np.linspace(0.0, 1.0, COUNT)
BEND = Term("bend", "all", "thermal", (TermParameter("a", "1", -10.0, 10.0, (0.1, -0.1)),))
WAVE = Term("wave", "all", "thermal", (TermParameter("a", "1", -10.0, 10.0, (0.1, -0.1)),), is_named=False)
_INSTANT = TermParameter("instant", "s", 0.0, 1.0, tuple(0.1 * n for n in range(1, 10)), is_instant=True)
STEP = Term("jump", "all", "electrical", (TermParameter("a", "1", -10.0, 10.0, (0.1,)), _INSTANT))
_THERE = TermParameter("there", "1", 0.0, 1.0, (1.0,), is_switch=True)
LID = Term("lid", "all", "measurement", (_THERE, TermParameter("limit", "1", -50.0, 50.0, (0.9, 0.7, 0.5))))
TERMS = (BEND, WAVE, STEP, LID)


class LineModel:
    """measured = offset + slope t + terms + noise, with priors of deviation 1 on offset and slope.

    Args:
        truth: Signal without noise, shape (COUNT,).
        seed: Of the noise.
        wild: Share of readings that are far off.
    """

    def __init__(self, truth: Array, seed: int = 0, wild: float = 0.0) -> None:
        rng = np.random.default_rng(seed)
        self.measured = truth + 0.1 * rng.standard_normal(COUNT)
        self.measured[rng.random(COUNT) < wild] += 5.0
        self.parameters = [Parameter("offset", "1", 0.0, 1.0, False), Parameter("slope", "1", 0.0, 1.0, False)]
        self.layout = Layout(np.zeros(COUNT), TIME, ("signal",), ("thermal",))
        self.jacobians = 0

    def signal(self, point: Point) -> Array:
        """Of the model at a point."""
        found = point.base[0] + point.base[1] * TIME
        for term, values in point.terms.items():
            if term == BEND:
                found = found + values[0] * TIME**2
            elif term == WAVE:
                found = found + values[0] * np.sin(25.0 * TIME)
            elif term == STEP:
                found = found + values[0] / (1.0 + np.exp(-(TIME - values[1]) / 0.01))
            elif term == LID:
                found = found + values[0] * (np.minimum(found, values[1]) - found)
        return np.asarray(found)

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return np.array([(self.measured - self.signal(p)) / 0.1 for p in points])

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        self.jacobians += 1
        return -np.stack([np.ones(COUNT), TIME], axis=1) / 0.1
