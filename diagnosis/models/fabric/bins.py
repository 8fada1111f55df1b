"""Samples of the mechanical channels of all recordings as means over pieces of time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.fabric.scatter import Bins
from diagnosis.recording.labels import labels
from diagnosis.recording.recording import Channel, Recording

#: Most pieces per channel and recording: poses move slowly, and covariances of thousands of samples cost minutes.
PIECES = 24
#: Most bins in all.
MOST = 1500


class Binning:
    """How samples are averaged.

    Args:
        recordings: With mechanical channels alone.
    """

    def __init__(self, recordings: Sequence[Recording]) -> None:
        self._channels = [c for r in recordings for c in r.channels.values()]
        number_of = [n for n, r in enumerate(recordings) for _ in r.channels]
        pieces = max(4, min(PIECES, MOST // max(len(self._channels), 1)))
        self._pieces = [_pieces(c, pieces) for c in self._channels]
        self.plain_names = [c.name for c in self._channels]
        #: What each channel measures, and the number of its recording.
        self.targets, self.recordings = [c.target for c in self._channels], number_of
        named = labels(recordings)
        self.names = [
            c.name if len(recordings) == 1 else f"{c.name} ({named[n]})" for c, n in zip(self._channels, number_of)
        ]
        kinds = [(c.target.kind, c.target.quantity) for c in self._channels]
        known = {kind: i for i, kind in enumerate(dict.fromkeys(kinds))}
        rows = [
            (
                i,
                float(c.times[p].mean()),
                number_of[i],
                known[kinds[i]],
                deviation(c) / np.sqrt(len(p)),
                float(np.ptp(c.values)),
            )
            for i, c in enumerate(self._channels)
            for p in self._pieces[i]
        ]
        channel, time, recording, group, noise, scale = (np.array(column) for column in zip(*rows))
        #: Residuals become independent in the order of time.
        self._order = np.lexsort((channel, time, recording))
        o = self._order
        self.bins = Bins(channel[o], time[o], recording[o], group[o], noise[o], scale[o])

    def measured(self) -> Array:
        """Bins of the recordings, shape (bins,)."""
        return self._averaged([c.values for c in self._channels])

    def bins_of(self, values: Sequence[Sequence[Array]]) -> Array:
        """Bins of simulated values, given by recording and channel, shape (bins,)."""
        return self._averaged([v for own in values for v in own])

    def bin_of(self, channel: int) -> AnyArray:
        """Bin of every sample of a channel, shape (samples,); of samples that are in none, the first bin.

        Args:
            channel: Number of the channel, over all recordings.
        """
        first = sum(len(own) for own in self._pieces[:channel])
        place = np.empty_like(self._order)
        place[self._order] = np.arange(len(self._order))
        found = np.zeros(len(self._channels[channel].times), dtype=int)
        for number, piece in enumerate(self._pieces[channel]):
            found[piece] = place[first + number]
        return found

    def _averaged(self, values: Sequence[Array]) -> Array:
        means = [float(np.mean(v[piece])) for v, own in zip(values, self._pieces) for piece in own]
        return np.array(means)[self._order]


def _pieces(channel: Channel, count: int) -> list[AnyArray]:
    used = np.flatnonzero(~channel.is_clipped)
    return [p for p in np.array_split(used, min(count, len(used))) if len(p)] if used.size else []
