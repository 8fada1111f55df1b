"""Tracks of markers: their places over all pictures, with what is known of each reading."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array

#: How a reading came about.
GAP, SEEN, PART, REBUILT = 0, 1, 2, 3
STATES = ("gap", "seen", "in part", "rebuilt")


@dataclass(frozen=True)
class Tracks:
    """Places of markers.

    Args:
        times: Middle of the exposure, shape (frames,) [s].
        places: (y, z), shape (frames, markers, 2) [m]; not a number in a gap.
        covariance: Shape (frames, markers, 2, 2) [m^2].
        share: Of each marker that is seen, shape (frames, markers).
        state: `GAP`, `SEEN`, `PART` or `REBUILT`, shape (frames, markers).
        margin: By how much the next assignment costs more, shape (frames,); 0 where there was none.
    """

    times: Array
    places: Array
    covariance: Array
    share: Array
    state: AnyArray
    margin: Array

    @property
    def markers(self) -> int:
        """Number of markers."""
        return int(self.places.shape[1])

    @property
    def deviation(self) -> Array:
        """Standard deviation of y and z, shape (frames, markers, 2) [m]."""
        return np.sqrt(np.stack([self.covariance[..., 0, 0], self.covariance[..., 1, 1]], axis=-1))

    def without(self, is_gap: AnyArray) -> Tracks:
        """The same with more gaps, shape (frames, markers)."""
        return replace(
            self,
            places=np.where(is_gap[..., None], np.nan, self.places),
            covariance=np.where(is_gap[..., None, None], np.nan, self.covariance),
            state=np.where(is_gap, GAP, self.state),
        )
