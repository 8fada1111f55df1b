"""The first question of a diagnosis: are these recordings and this scenario of the same experiment?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr

from cosim.scenario import Scenario
from diagnosis.check.beside import Compared, compare
from diagnosis.check.inputs import input_doubts
from diagnosis.check.readings import reading_doubts
from diagnosis.check.scale import scale_doubts
from diagnosis.check.start import start_doubts
from diagnosis.check.swapped import swap_doubts
from diagnosis.check.time_unit import time_unit_doubts
from diagnosis.check.timing import timing_doubts
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Recording


def check_recordings(
    scenario: Scenario, recordings: Sequence[Recording], simulated: Mapping[str, xr.Dataset] | None = None
) -> tuple[Doubt, ...]:
    """Doubts about recordings, before anything is fitted.

    It takes one simulation of the scenario, as it is, under the conditions of each recording, and regressions.

    Args:
        scenario: What the recordings are compared with.
        recordings: Training and held-out ones together.
        simulated: Folder of a recording (`str(recording.path)`) to the results of `cosim.run.run` under its conditions,
            where they are known already.

    Returns:
        Serious doubts first, then by their size. Of recordings that fit their scenario one in 1000 raises a serious
        one.

    Raises:
        InputError: A recording does not fit the scenario.
    """
    given = simulated or {}
    every = [compare(scenario, r, given.get(str(r.path))) for r in recordings]
    return doubts_of(every)


def doubts_of(every: Sequence[Compared]) -> tuple[Doubt, ...]:
    """Doubts about recordings that are simulated already; the order is that of `check_recordings`."""
    found: list[Doubt] = []
    for one in every:
        timing = time_unit_doubts(one) or timing_doubts(one, [o for o in every if o is not one])
        swaps = swap_doubts(one)
        found += timing or swaps
        found += scale_doubts(one, not timing and not swaps)
        found += [*reading_doubts(one, not timing), *start_doubts(one), *input_doubts(one)]
    return tuple(sorted(found, key=lambda d: (not d.is_serious, -d.z)))
