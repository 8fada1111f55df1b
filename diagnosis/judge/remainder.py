"""What is left in which channel and window, beyond what noise explains."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cosim.unit import Array
from diagnosis.judge.location import Remainder
from diagnosis.search.problem import Layout
from diagnosis.search.structure import Structure, structure

#: Channels and groups that are told.
_TOLD = 8


def remainders(residuals: Array, layout: Layout, groups: Mapping[str, Array]) -> tuple[Remainder, ...]:
    """Channels and groups of channels with structure left, the strongest first.

    Args:
        residuals: Shape (residuals,), each with deviation 1 if it is noise.
        layout: What each belongs to.
        groups: Name to numbers of channels that are looked at together.
    """
    limit = structure(residuals, layout, groups).limit
    found = [_alone(residuals, layout, np.array([n]), name) for n, name in enumerate(layout.names)]
    found += [_alone(residuals, layout, members, name) for name, members in groups.items()]
    strong = sorted((s for s in found if abs(s.z) > limit), key=lambda s: -abs(s.z))
    return tuple(Remainder(s.channels, s.begin, s.end, s.z, limit) for s in strong[:_TOLD])


def _alone(residuals: Array, layout: Layout, members: Array, name: str) -> Structure:
    """Structure of one channel, or of the sum of several, by itself."""
    chosen = np.isin(layout.channel, members)
    times, place = np.unique(layout.time[chosen], return_inverse=True)
    total = np.bincount(place, residuals[chosen])
    count = np.bincount(place, residuals[chosen] != 0.0)
    one = Layout(np.zeros(len(times)), times, (name,), ("",))
    return structure(total / np.sqrt(np.maximum(count, 1)), one)
