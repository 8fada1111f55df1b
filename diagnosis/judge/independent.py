"""How many independent readings there are where noise is alike from reading to reading.

Source: degrees of freedom of a sum of squares that are not independent: F. E. Satterthwaite, Biometrics 2 (1946)
110-114; of an autoregressive process of first order: M. S. Bartlett, J. Royal Statistical Society 98 (1935) 536-543.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnosis.models.fabric.scatter import MEMORY


def independent(recordings: Sequence[Sequence[tuple[int, float, float]]]) -> float:
    """How many independent squares have the mean of all, and its variance.

    White noise is independent; of noise with a correlation c from one reading to the next, n squares count as
    n (1 - c^2)/(1 + c^2). What contacts scatter by is remembered for `MEMORY` of a recording, and moves all of its
    channels: that they do so together is the worst case.

    Args:
        recordings: Of each, samples, the share of their variance that is such scatter, and the correlation of
            neighbouring readings of the rest, by channel.
    """
    rate = 2.0 / MEMORY
    # mean of exp(-2 |s - t| / memory) over all pairs of instants of a recording
    remembered = 2.0 / rate - 2.0 / rate**2 * (1.0 - math.exp(-rate))
    samples = sum(count for own in recordings for count, _, _ in own)
    alike = [(count, share, (1.0 + c**2) / (1.0 - c**2)) for own in recordings for count, share, c in own]
    white = sum(min(count * factor, count**2) * (1.0 - share**2) for count, share, factor in alike)
    shared = sum(sum(count * share for count, share, _ in own) ** 2 for own in recordings)
    squared = sum(count * share**2 for own in recordings for count, share, _ in own)  # each with itself
    return samples**2 / (white + max(remembered * shared, squared))
