"""What is left in which channel and window, beyond what noise explains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.location import Remainder
from diagnosis.models.coil_network.runs import deviation
from diagnosis.recording.recording import Channel
from diagnosis.search.problem import Layout
from diagnosis.search.structure import Structure, structure

#: Channels and groups that are reported.
_TOLD = 8


def remainders(
    residuals: Array, layout: Layout, groups: Mapping[str, Array], channels: Sequence[Channel] = ()
) -> tuple[Remainder, ...]:
    """Channels and groups of channels with structure left, the strongest first.

    Args:
        residuals: Shape (residuals,), each with deviation 1 if it is noise.
        layout: What each belongs to.
        groups: Name to numbers of channels that are looked at together.
        channels: The channels of `layout`, in its order, for what is left in their units; else that is not said.
    """
    limit = structure(residuals, layout, groups).limit
    looked_at = [(name, np.array([n])) for n, name in enumerate(layout.names)] + list(groups.items())
    found = [(_alone(residuals, layout, members, name), members) for name, members in looked_at]
    strong = sorted((f for f in found if abs(f[0].z) > limit), key=lambda f: -abs(f[0].z))
    is_known = len(channels) == len(layout.names)
    return tuple(
        Remainder(
            s.channels,
            s.begin,
            s.end,
            s.z,
            limit,
            *((*_mean(residuals, layout, members, s, channels), _noise(members, channels)) if is_known else ()),
        )
        for s, members in strong[:_TOLD]
    )


def _mean(
    residuals: Array, layout: Layout, members: Array, window: Structure, channels: Sequence[Channel]
) -> tuple[str, float]:
    """Unit of some channels, and the mean of what is left of them in a window; no unit where they have several."""
    units = {channels[int(n)].unit for n in members}
    is_inside = (layout.time >= window.begin) & (layout.time <= window.end)
    chosen = np.flatnonzero(np.isin(layout.channel, members) & is_inside & (residuals != 0.0))
    if len(units) > 1 or not chosen.size:
        return "", float("nan")
    sizes = np.array([deviation(c) for c in channels])[np.asarray(layout.channel, dtype=int)[chosen]]
    return units.pop(), float(np.mean(residuals[chosen] * sizes))


def _noise(members: Array, channels: Sequence[Channel]) -> str:
    """Where the noise of some channels comes from."""
    found = {channels[int(n)].is_deviation_given for n in members}
    return "both" if len(found) > 1 else "stated" if True in found else "estimated"


def _alone(residuals: Array, layout: Layout, members: Array, name: str) -> Structure:
    """Structure of one channel, or of the sum of several, by itself."""
    chosen = np.isin(layout.channel, members)
    times, place = np.unique(layout.time[chosen], return_inverse=True)
    total = np.bincount(place, residuals[chosen])
    count = np.bincount(place, residuals[chosen] != 0.0)
    one = Layout(np.zeros(len(times)), times, (name,), ("",))
    return structure(total / np.sqrt(np.maximum(count, 1)), one)
