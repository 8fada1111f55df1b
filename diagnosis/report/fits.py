"""Fit per channel, condensed to one row for each recording and quantity."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.judge.diagnosis import ChannelFit
from diagnosis.judge.held_out import root_mean_square

#: The models that are compared: as the scenario has it, recalibrated, amended.
STAGES = ("before", "recalibrated", "after")


@dataclass(frozen=True)
class Row:
    """Channels of one quantity in one recording.

    Args:
        recording: Its title.
        is_held_out: Whether nothing was fitted to it.
        quantity: `coil temperature`.
        first: Name of the first of the channels.
        unit: SI unit of the RMSE.
        channels: How many.
        rmse: Root mean square over the channels, by stage.
        chi_square: Mean over the channels, by stage.
        whiteness: Largest of the channels, by stage.
        spread: Smallest and largest RMSE of a channel by the last stage.
    """

    recording: str
    is_held_out: bool
    quantity: str
    first: str
    unit: str
    channels: int
    rmse: dict[str, float]
    chi_square: dict[str, float]
    whiteness: dict[str, float]
    spread: tuple[float, float]


def rows(fits: Sequence[ChannelFit]) -> list[Row]:
    """One row for each recording and quantity, held-out recordings first."""
    groups: dict[tuple[bool, str, str, str], list[ChannelFit]] = {}
    for fit in fits:
        groups.setdefault((fit.is_held_out, fit.recording, quantity(fit.channel), fit.unit), []).append(fit)
    found = [_row(members) for members in groups.values()]
    return sorted(found, key=lambda row: not row.is_held_out)


def quantity(channel: str) -> str:
    """`coil[2,5].temperature` is a `coil temperature`."""
    return re.sub(r"\[[^\]]*\]", "", channel).replace(".", " ").replace("_", " ")


def plain_channel(name: str) -> str:
    """`coil[2,5].temperature (steps)`, as it is called among several recordings, without the recording's title."""
    return name.partition(" (")[0]


def is_channel(name: str, channel: str, recording: str) -> bool:
    """Whether a finding's name of a channel is that of a channel of a recording."""
    return name in (channel, f"{channel} ({recording})")


def worst_first(fits: Iterable[ChannelFit]) -> list[ChannelFit]:
    """Held-out recordings first, then by the chi-square of the recalibrated model: where something was missing most."""
    return sorted(fits, key=lambda f: (not f.is_held_out, -_known(f.chi_square.get("recalibrated", math.nan))))


def mean_chi_square(fits: Iterable[ChannelFit], is_held_out: bool) -> dict[str, float] | None:
    """Chi-square per sample by stage, averaged over channels; None where there are no such recordings."""
    chosen = [f for f in fits if f.is_held_out == is_held_out]
    return _by_stage([f.chi_square for f in chosen], np.mean) if chosen else None


def _row(members: Sequence[ChannelFit]) -> Row:
    first = members[0]
    last = [v for v in (m.rmse.get(STAGES[-1], math.nan) for m in members) if math.isfinite(v)]
    return Row(
        recording=first.recording,
        is_held_out=first.is_held_out,
        quantity=quantity(first.channel),
        first=first.channel,
        unit=first.unit,
        channels=len(members),
        rmse=_by_stage([m.rmse for m in members], lambda sizes: root_mean_square(np.array(sizes))),
        chi_square=_by_stage([m.chi_square for m in members], np.mean),
        whiteness=_by_stage([m.whiteness for m in members], np.max),
        spread=(min(last, default=math.nan), max(last, default=math.nan)),
    )


def _by_stage(values: Sequence[dict[str, float]], summary: Callable[[list[float]], float]) -> dict[str, float]:
    return {stage: float(summary([v.get(stage, math.nan) for v in values])) for stage in STAGES}


def _known(value: float) -> float:
    return value if math.isfinite(value) else -math.inf
