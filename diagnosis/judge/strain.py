"""Parameters that a law drags far from what is stated: another law that leaves them alone may be what acts.

A leak, say, is met exactly by an input that is too small and a volume that is too small. The stated deviation of the
volume is all that speaks against it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import ndtri

from diagnosis.search.fit import Fit
from diagnosis.search.problem import Parameter

#: Probability that any parameter of a right model lies so far from what is stated: odds of 20 to 1, as names need.
CHANCE = 0.05


def strained(parameters: Sequence[Parameter], recalibrated: Fit, amended: Fit) -> list[tuple[Parameter, float]]:
    """Parameters of the rig that an amended model moves farther than chance does, and recalibration alone did not.

    Args:
        parameters: Of the model.
        recalibrated: Fit without laws.
        amended: Fit with them.

    Returns:
        Each with its distance from the stated value in prior deviations.
    """
    own = np.array([p.is_carried and not p.is_within_row for p in parameters], dtype=bool)
    if not own.any():
        return []
    limit = float(-ndtri(CHANCE / (2.0 * np.count_nonzero(own))))
    before, after = (f.point.base / f.widths for f in (recalibrated, amended))
    was_there = before * np.sign(after) >= np.abs(after)
    chosen = np.flatnonzero(own & (np.abs(after) > limit) & ~was_there)
    return [(parameters[i], float(after[i])) for i in chosen.tolist()]
