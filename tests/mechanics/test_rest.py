"""A drape at rest stays where it is: contacts that creep would pass for physics."""

from __future__ import annotations

import numpy as np
import pytest

from mechanics.solver import SolverSettings
from tests.mechanics.designs import STEP, prototype, woven_unit

#: Time in which the drape comes to rest, and for which it is watched [s].
SETTLED, WATCHED = 3.0, 30.0


def sags(unit, seconds, begin):
    """How far the last row hangs below the first [m], once in a tenth of a second."""
    found = []
    for index in range(round(seconds * 1e9) // STEP):
        unit.do_step(begin + index * STEP, STEP)
        if index % 10 == 9:
            centre = unit.get("row_centre")
            found.append(float(centre[0, 2] - centre[-1, 2]))
    return np.array(found)


@pytest.mark.slow
def test_a_drape_at_rest_in_mujoco_moves_by_less_than_one_per_cent_in_thirty_seconds():
    unit = woven_unit(prototype(), solver=SolverSettings(2.5e-4, 200, 1e-3, engine="mujoco"))
    sags(unit, SETTLED, 0)
    found = sags(unit, WATCHED, round(SETTLED * 1e9))
    unit.terminate()
    assert found[0] > 0.02
    assert np.ptp(found) < 0.01 * found[0]
