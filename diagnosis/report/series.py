"""One channel of one recording beside what the models say; a handful of them are drawn in the report."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array


@dataclass(frozen=True)
class Series:
    """Measured and simulated values of a channel, in SI; NaN where there is none.

    Args:
        channel: Its name, `coil[2,5].temperature`.
        unit: SI unit.
        times: Rising [s], shape (samples,).
        measured: Shape (samples,).
        before: By the model as the scenario has it, shape (samples,).
        recalibrated: By the recalibrated model, shape (samples,).
        after: By the amended model, shape (samples,); equal to `recalibrated` where nothing was added.
        deviation: Standard deviation of the sensor's noise, one number or of shape (samples,).
        recording: Title of its recording.
        is_held_out: Whether nothing was fitted to it.

    Raises:
        ValueError: The shapes differ, or there are no samples.
    """

    channel: str
    unit: str
    times: Array
    measured: Array
    before: Array
    recalibrated: Array
    after: Array
    deviation: Array | float
    recording: str = ""
    is_held_out: bool = False

    def __post_init__(self) -> None:
        if self.times.ndim != 1 or not len(self.times):
            raise ValueError(f"{self.channel}: a series needs samples, not times of shape {self.times.shape}")
        for name in ("measured", "before", "recalibrated", "after"):
            if getattr(self, name).shape != self.times.shape:
                raise ValueError(
                    f"{self.channel}: {name} has shape {getattr(self, name).shape}, not {self.times.shape} as its times"
                )

    @property
    def curves(self) -> dict[str, Array]:
        """Stage to what the model says, without stages that say the same as the one before."""
        told: dict[str, Array] = {"before": self.before}
        for name, values in (("recalibrated", self.recalibrated), ("after", self.after)):
            last = list(told.values())[-1]
            if not np.array_equal(values, last, equal_nan=True):
                told[name] = values
        return told
