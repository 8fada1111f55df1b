"""Whether anything but noise is left in residuals: sums over channels and windows of time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri  # scipy.stats takes a second to load

from cosim.unit.protocol import Array
from diagnosis.search.posterior import HUBER
from diagnosis.search.problem import Layout

#: Samples per window.
WINDOWS = (1, 4, 12)
#: Probability that noise alone is taken for structure.
LEVEL = 0.01


@dataclass(frozen=True)
class Structure:
    """Where residuals are largest, in deviations of their own noise.

    Args:
        z: Largest standardised sum of residuals.
        channels: Name of the channel or group of channels that it was found in.
        begin: Begin of its window [s].
        end: End of its window [s].
        looked_at: Windows that were looked at.
    """

    z: float
    channels: str
    begin: float
    end: float
    looked_at: int = 0

    @property
    def limit(self) -> float:
        """Largest |z| that noise alone passes in one of a hundred recordings (windows counted as independent)."""
        return -float(ndtri(LEVEL / (2.0 * max(self.looked_at, 1))))

    @property
    def is_noise(self) -> bool:
        """Whether nothing but noise is left."""
        return abs(self.z) <= self.limit


def deviation_of(differences: Array) -> float:
    """Standard deviation of normal numbers by the median of their differences, which few large ones hardly move."""
    return float(np.median(np.abs(differences)) / (0.6745 * np.sqrt(2.0)))  # the median of |z| is 0.6745


def structure(residuals: Array, layout: Layout, groups: Mapping[str, Array] | None = None) -> Structure:
    """Largest standardised sum of residuals over single channels, groups of channels, and windows.

    Args:
        residuals: Shape (residuals,), each with deviation 1 if it is noise; 0 where a sample is not used.
        layout: What each belongs to.
        groups: Name to numbers of channels whose residuals are averaged at equal times (a string, all coils).
    """
    found = Structure(0.0, "", 0.0, 0.0)
    for number, name in enumerate(layout.names):
        chosen = layout.channel == number
        found = _larger(found, residuals[chosen], layout.time[chosen], name)
    for name, members in (groups or {}).items():
        chosen = np.isin(layout.channel, members)
        times, place = np.unique(layout.time[chosen], return_inverse=True)
        total = np.bincount(place, residuals[chosen])
        count = np.bincount(place, residuals[chosen] != 0.0)
        found = _larger(found, total / np.sqrt(np.maximum(count, 1)), times, name)
    return found


def _larger(best: Structure, values: Array, times: Array, name: str) -> Structure:
    used = values != 0.0
    values, times = np.clip(values[used], -HUBER, HUBER), times[used]  # a wild reading alone is no structure
    for window in WINDOWS:
        if len(values) < window:
            continue
        sums = np.convolve(values, np.ones(window), mode="valid") / np.sqrt(window)
        peak = int(np.argmax(np.abs(sums)))
        count = best.looked_at + len(sums)
        if abs(sums[peak]) > abs(best.z):
            best = Structure(float(sums[peak]), name, float(times[peak]), float(times[peak + window - 1]))
        best = replace(best, looked_at=count)
    return best
