"""What a model that costs seconds a run answered during its search, in channels that nobody recorded too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.fabric.scatter import Bins
from diagnosis.search.problem import Term


@dataclass(frozen=True)
class Answers:
    """Runs of a search, bins of recorded channels and of others.

    Args:
        bins: What each bin is.
        extra: Group of unrecorded channels that a bin belongs to, empty where it is recorded; shape (bins,).
        members: Of the model as it is, from several starts, shape (starts, bins).
        difference: What another engine differs by, shape (bins,); None where none was asked.
        slopes: By the deviation of each parameter, shape (parameters, bins).
        effects: Term to strength to runs, shape (starts, bins).
        names: Of the parameters.
    """

    bins: Bins
    extra: AnyArray
    members: Array
    difference: Array | None
    slopes: Array
    effects: Mapping[Term, Mapping[float, Array]]
    names: Sequence[str] = ()

    @property
    def extras(self) -> list[str]:
        """Groups of channels that are not recorded."""
        return [str(e) for e in dict.fromkeys(self.extra.tolist()) if e]

    def chosen(self, extra: str) -> AnyArray:
        """Which bins are recorded, or of a group that would be recorded too."""
        return np.asarray((self.extra == "") | (self.extra == extra))
