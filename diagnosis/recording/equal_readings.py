"""Stretches in which a sensor repeats one value."""

from __future__ import annotations

import numpy as np

from cosim.unit.protocol import AnyArray, Array

#: Readings that a sensor repeats before it is asked whether it is stuck: of a few wild ones that says nothing.
FEWEST_EQUAL = 8
#: Stretches at most, the longest.
LONGEST_RUNS = 16


def ends_of_runs(readings: Array, fewest: int = FEWEST_EQUAL) -> AnyArray:
    """First sample and sample after the last of the longest stretches of so many equal readings, shape (2, runs)."""
    edges = np.concatenate([[0], np.flatnonzero(np.diff(readings)) + 1, [len(readings)]])
    lengths = np.diff(edges)
    longest = np.argsort(-lengths, kind="stable")[:LONGEST_RUNS]
    longest = longest[lengths[longest] >= fewest]
    return np.stack([edges[longest], edges[longest + 1]])
