"""What a model that costs seconds a run answered during its search, in channels that nobody recorded too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.search.problem import Term


@dataclass(frozen=True)
class AnswerBins:
    """What each bin of an answer is.

    Args:
        channel: Number of the channel, shape (bins,).
        time: Middle of the bin [s], shape (bins,).
        recording: Number of the recording, shape (bins,).
        group: Number of the kind of quantity, shape (bins,).
        noise: Standard deviation of the sensor's noise, shape (bins,).
        scale: Size of the quantity's changes, shape (bins,).
        extra: Group of unrecorded channels that a bin belongs to, empty where it is recorded; shape (bins,).
    """

    channel: AnyArray
    time: Array
    recording: AnyArray
    group: AnyArray
    noise: Array
    scale: Array
    extra: AnyArray


@dataclass(frozen=True)
class Answers:
    """Runs of a search, bins of recorded channels and of others.

    Args:
        bins: What each bin is.
        members: Of the model as it is, from several starts, shape (starts, bins).
        difference: What another engine differs by, shape (bins,); None where none was asked.
        slopes: By the deviation of each parameter, shape (parameters, bins).
        effects: Term to strength to runs, shape (starts, bins).
        names: Of the parameters.
    """

    bins: AnswerBins
    members: Array
    difference: Array | None
    slopes: Array
    effects: Mapping[Term, Mapping[float, Array]]
    names: Sequence[str] = ()

    @property
    def extras(self) -> list[str]:
        """Groups of channels that are not recorded."""
        return [str(e) for e in dict.fromkeys(self.bins.extra.tolist()) if e]

    def chosen(self, extra: str) -> AnyArray:
        """Which bins are recorded, or of a group that would be recorded too."""
        return np.asarray((self.bins.extra == "") | (self.bins.extra == (extra or "")))
