"""Fit of every channel over recordings: mean and range of what each recording gives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from diagnosis.judge.diagnosis import ChannelFit, ChannelSpread, Spread


def spread_over_recordings(fits: Iterable[ChannelFit]) -> tuple[ChannelSpread, ...]:
    """One entry for each channel and part (training, held out), in the order in which they come.

    Args:
        fits: Of every channel of every recording.
    """
    groups: dict[tuple[bool, str, str], list[ChannelFit]] = {}
    for fit in fits:
        groups.setdefault((fit.is_held_out, fit.channel, fit.unit), []).append(fit)
    return tuple(
        ChannelSpread(
            channel,
            unit,
            is_held_out,
            len(own),
            sum(f.samples for f in own),
            _over([f.rmse for f in own]),
            _over([f.chi_square for f in own]),
            _over([f.whiteness for f in own]),
        )
        for (is_held_out, channel, unit), own in groups.items()
    )


def _over(figures: Sequence[Mapping[str, float]]) -> dict[str, Spread]:
    """Mean and range of a figure, by stage."""
    found = {}
    for stage in figures[0]:
        values = [f[stage] for f in figures]
        found[stage] = Spread(float(np.mean(values)), min(values), max(values))
    return found
