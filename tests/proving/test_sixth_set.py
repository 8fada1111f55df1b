"""Courses of the sixth set of foreign rigs; what all sets have in common: `test_foreign_sets`."""

from __future__ import annotations

import numpy as np

from evaluation.strangers import sixth_set


def test_walk_begins_at_0_and_jumps_by_the_stated_sizes() -> None:
    course = sixth_set.walk(np.random.default_rng(3), 6.0, 0.14, 0.3, 1.1, 2e-3)
    jumps = np.abs(np.diff(course.levels))
    assert course.times[0] == course.levels[0] == 0.0
    assert np.all(np.diff(course.times) >= 2e-3 - 1e-12)
    assert np.all((jumps > 0.3 - 2e-3) & (jumps < 1.1 + 2e-3))
