"""The noise of a sensor, from its own readings."""

from __future__ import annotations

import numpy as np

from cosim.unit import Array

#: No reading is trusted beyond this share of its range: a simulation that agrees so well is right.
LEAST = 1e-6
#: Median of |x| of a normal distribution with deviation 1.
_MEDIAN_TO_DEVIATION = 0.674489750196082


def estimate_noise(times: Array, values: Array, quantum: float = 0.0) -> float:
    """Standard deviation of the white noise on a smooth signal.

    The second difference of three neighbours (with unequal spacing: the distance of the middle one from the line
    through the others) removes value and slope; the median of its size is blind to the few samples around switches,
    where the signal itself bends, which differences alone would count as noise (up to a third too much).

    Args:
        times: Shape (samples,) [s], rising.
        values: Shape (samples,).
        quantum: Step of a quantised reading.

    Returns:
        The deviation, at least that of rounding to the quantum, quantum / sqrt(12), and never 0.

    Source: Gasser, Sroka, Jennen-Steinmetz, Biometrika 73 (1986) 625-633 (pseudo-residuals); median for robustness.
    """
    spread = float(np.ptp(values)) if len(values) else 0.0
    size = float(np.max(np.abs(values), initial=0.0))
    floor = max(quantum / np.sqrt(12.0), LEAST * spread, 1e-9 * size, np.finfo(float).tiny)
    if len(values) < 3:
        return float(floor)
    before, after = np.diff(times)[:-1], np.diff(times)[1:]
    share = after / (before + after)
    bend = values[1:-1] - share * values[:-2] - (1.0 - share) * values[2:]
    scale = np.sqrt(1.0 + share**2 + (1.0 - share) ** 2)
    found = float(np.median(np.abs(bend / scale))) / _MEDIAN_TO_DEVIATION
    return float(max(found, floor))
