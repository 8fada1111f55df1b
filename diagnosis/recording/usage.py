"""Which readings are compared with a simulation, and why the others are not."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.recording.recording import Channel, Recording

#: With switches at more than this share of the readings the input is a recorded course, which always jumps; leaving
#: out what is near a jump would leave nothing.
COURSE = 0.2


@dataclass(frozen=True)
class Usage:
    """Readings of one channel.

    Args:
        channel: Its name.
        rows: Rows of its column.
        used: Readings that are compared.
        unused: Why the others are not, in plain words, to their number; each is counted once, under the first reason
            that holds.
        is_after: Whether readings at a change of an input are compared with the output after it.
    """

    channel: str
    rows: int
    used: int
    unused: Mapping[str, int]
    is_after: bool = False

    def __str__(self) -> str:
        """`coil[1].temperature: 412 of 6000 readings are not used: 300 within 0.3 s of a switch, 112 clipped`."""
        after = ", each as taken just after the input changed" if self.is_after else ""
        if not self.unused:
            return f"{self.channel}: all {self.rows} readings are used{after}"
        why = ", ".join(f"{count} {reason}" for reason, count in self.unused.items())
        return f"{self.channel}: {self.rows - self.used} of {self.rows} readings are not used: {why}{after}"


def usage(
    recording: Recording, switches: Sequence[float] = (), start: float = -math.inf, stop: float = math.inf
) -> tuple[Usage, ...]:
    """How many readings of every channel are compared, and why the others are not.

    Args:
        recording: As it was loaded, or what `diagnosis.recording.fits.fitting` left of it.
        switches: Instants at which an input jumps [s], of models that leave out what is near them (the coil network);
            others compare these readings too, and none are given.
        start: Begin of the simulated time [s].
        stop: End of the simulated time [s].
    """
    return tuple(_usage(c, recording.switch_margin, switches, start, stop) for c in recording.channels.values())


def _usage(channel: Channel, margin: float, switches: Sequence[float], start: float, stop: float) -> Usage:
    words = {
        "empty": "empty",
        "invalid": "listed as invalid",
        "before begin": "before `begin`",
        "after end": "after `end`",
        "before start": "before the simulated time",
        "after stop": "after the simulated time",
        "uncertain": "far less certain than the others",
        "thinned": "left out of so many, at even distances",
        "unknown input": "dependent on what an input was while its column has no rows",
        "at a switch": "taken while an input changed that the quantity follows at once",
    }
    found = {words[reason]: count for reason, count in channel.dropped.items()}
    is_left: AnyArray = np.ones(len(channel.times), dtype=bool)
    for reason, holds in (
        ("before the simulated time", channel.times < start),
        ("after the simulated time", channel.times > stop),
        ("clipped", channel.is_clipped),
        (f"within {margin:g} s of a switch", near_switch(channel.times, switches, margin)),
    ):
        count = int(np.count_nonzero(is_left & holds))
        is_left &= ~holds
        if count:
            found[reason] = found.get(reason, 0) + count
    used = int(np.count_nonzero(is_left))
    return Usage(channel.name, used + sum(found.values()), used, found, channel.later > 0.0)


def near_switch(times: Array, switches: Sequence[float] | Array, margin: float) -> AnyArray:
    """Which samples are within `margin` [s] of a switch, shape (samples,).

    None where an input is a recorded course (`COURSE`).
    """
    instants = np.sort(np.asarray(switches, dtype=np.float64))
    if not instants.size or len(instants) >= COURSE * len(times):
        return np.zeros(len(times), dtype=bool)
    after = np.searchsorted(instants, times)
    to_next = np.append(instants, math.inf)[after] - times
    to_last = times - np.concatenate([[-math.inf], instants])[after]
    return np.asarray(np.minimum(to_next, to_last) <= margin)
