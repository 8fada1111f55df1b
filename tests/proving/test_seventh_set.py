"""Courses of the seventh set of foreign rigs; what all sets have in common: `test_foreign_sets`."""

from __future__ import annotations

import numpy as np
import pytest

from evaluation.strangers import seventh_set


def test_charge_of_a_cycle_stays_within_its_room() -> None:
    course = seventh_set.cycling(np.random.default_rng(3), 1500.0, 12.0, 1.5, 8.0, 60.0, 0.5)
    charge = np.cumsum(np.diff(course.times) * course.levels[:-1])
    assert course.times[0] == course.levels[0] == 0.0
    assert np.all(np.diff(course.times) >= 6.0)
    assert np.max(np.abs(course.levels)) <= 8.0
    assert np.max(np.abs(charge)) <= 60.0 * 1.01  # levels are rounded to three digits


def test_reading_of_a_fast_clock_is_one_of_an_earlier_instant() -> None:
    times = np.linspace(0.0, 10.0, 11)
    read = seventh_set.clocked(0, 2.0, times, times[:, None], 0.01)
    assert read(np.array([0.0, 5.0, 10.0]), times, times) == pytest.approx([0.0, 9.9, 19.8], rel=1e-12)
