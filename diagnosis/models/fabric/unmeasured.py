"""Places and lengths of a fabric that nobody recorded, read from the same simulations: what would they show?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.fabric.bins import Binning
from diagnosis.models.fabric.scatter import Bins
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel, Recording

#: Instants at which such channels are read, over the recording.
INSTANTS = 8
#: Markers and links that are read at most, spread over the fabric.
MOST = 24
#: Noise of a place where no place or length is recorded [m]: a camera of 0.25 mm a pixel (docs/camera.md).
NOISE = 3e-4
#: Kind and quantity of a channel to the group that is recorded together, and to how.
GROUPS = {
    ("marker", "x"): "places of the markers across the fabric (x: a camera from above or along the fabric)",
    ("marker", "y"): "places of the markers along the fabric (y: a camera from the side or above)",
    ("marker", "z"): "heights of the markers (z: a camera from the side or along the fabric)",
    ("link", "length"): "lengths of the links",
}


def unmeasured_channels(recording: Recording, markers: int, links: int) -> dict[str, Channel]:
    """Channels that a recording of a fabric lacks, without readings.

    Args:
        recording: With the channels of the fabric alone.
        markers: Number of markers.
        links: Number of links.
    """
    recorded = {str(c.target) for c in recording.channels.values()}
    places = [c for c in recording.channels.values() if c.unit == "m"]
    begin = min(float(c.times[0]) for c in recording.channels.values())
    edges = np.linspace(begin, recording.end, INSTANTS + 1)
    times = 0.5 * (edges[1:] + edges[:-1])
    # as many readings as the recorded places have, averaged over as many pieces
    count = float(np.median([len(c.times) for c in recording.channels.values()]))
    noise = float(np.median([deviation(c) for c in places])) if places else NOISE
    own = noise / np.sqrt(max(count / INSTANTS, 1.0))
    found = {}
    for kind, quantity in GROUPS:
        for number in _spread(markers if kind == "marker" else links):
            target = Target(kind, (number,), quantity)
            if str(target) not in recorded:
                found[str(target)] = Channel(str(target), target, times, np.zeros(len(times)), own, True)
    return found


def with_unmeasured(recordings: Sequence[Recording], markers: int, links: int) -> list[Recording]:
    """Recordings with the channels that they lack behind those that they have."""
    return [replace(r, channels={**r.channels, **unmeasured_channels(r, markers, links)}) for r in recordings]


def _spread(count: int) -> list[int]:
    """Numbers from 1, all of few and evenly spread ones of many."""
    if count <= MOST:
        return list(range(1, count + 1))
    return sorted({round(v) for v in np.linspace(1, count, MOST)})


class UnmeasuredBins:
    """Bins of recorded channels followed by those of the others.

    Args:
        binning: Of the recorded channels.
        recordings: With the channels that they lack behind those that they have.
        recorded: Recorded channels of each recording.
    """

    def __init__(self, binning: Binning, recordings: Sequence[Recording], recorded: Sequence[int]) -> None:
        extra = [list(r.channels.values())[n:] for r, n in zip(recordings, recorded)]
        self._recorded = list(recorded)
        first, own = len(binning.plain_names), binning.bins
        groups = list(GROUPS)
        kinds = int(own.group.max()) + 1 if own.group.size else 0
        rows = [
            (
                first + i,
                float(t),
                number,
                kinds + groups.index((c.target.kind, c.target.quantity)),
                c.deviation,
                GROUPS[c.target.kind, c.target.quantity],
            )
            for i, (number, c) in enumerate((n, c) for n, cs in enumerate(extra) for c in cs)
            for t in c.times
        ]
        channel, time, recording, group, noise, name = (list(column) for column in zip(*rows)) if rows else [[]] * 6
        self.bins = Bins(
            np.concatenate([own.channel, np.array(channel, dtype=own.channel.dtype)]),
            np.concatenate([own.time, np.array(time, dtype=float)]),
            np.concatenate([own.recording, np.array(recording, dtype=own.recording.dtype)]),
            np.concatenate([own.group, np.array(group, dtype=own.group.dtype)]),
            np.concatenate([own.noise, np.array(noise, dtype=float)]),
            np.concatenate([own.scale, np.zeros(len(rows))]),
        )
        #: Group of unrecorded channels of each bin, empty where it is recorded, shape (bins,).
        self.extra = np.array([*([""] * len(own.channel)), *name], dtype=object)

    def divided(self, values: Sequence[Sequence[Array]]) -> tuple[list[list[Array]], Array]:
        """Values of the recorded channels, recording by recording, and those of the others in one row."""
        kept = [list(v[:n]) for v, n in zip(values, self._recorded)]
        others: list[Array] = [a for v, n in zip(values, self._recorded) for a in v[n:]]
        return kept, np.concatenate([np.zeros(0), *others])

    def with_scale(self, members: Array) -> Bins:
        """The bins with the size of the changes of channels that have no readings, from runs, shape (runs, bins)."""
        mean, scale = members.mean(axis=0), self.bins.scale.copy()
        for number in np.unique(self.bins.channel[self.extra != ""]):
            own = self.bins.channel == number
            scale[own] = np.ptp(mean[own])
        return replace(self.bins, scale=scale)
