"""Channels that begin where numbers of the rig put them: outputs that are no state, and have no start of their own.

The temperature of an exhaust, or the thrust of a nozzle, is worked out from what flows and from numbers of the rig.
Where such a number is off, or a law is missing, its first reading is off as all others are, however the recording
began.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing

import numpy as np
import xarray as xr

from cosim.unit.errors import InputError
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.input_runs import is_quick
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.run import SystemRuns, in_base
from diagnosis.recording.series import series_of

#: Share by which each number is moved.
MOVED = 0.1
#: Share of it by which two changes may differ that are the same one.
SAME = 1e-6


def moved_by_numbers(one: Compared, channels: Sequence[Beside]) -> frozenset[str]:
    """Names of channels whose first simulated value a tenth of some number moves by more than their noise.

    A number that moves the start of a state by as much as it is moved itself does not count: it is that start. None
    does of a Co-Simulation FMU, which hides its states, nor where compiled code does not simulate the scenario.

    Args:
        one: A recording beside its simulation.
        channels: Those of its channels that are asked about.
    """
    if not channels or not is_quick(one.scenario):
        return frozenset()
    try:
        with closing(SystemRuns(one.scenario)) as system:
            return _moved(system, one, channels)
    except (InputError, NotFast, CompilerError):
        return frozenset()


def _moved(system: SystemRuns, one: Compared, channels: Sequence[Beside]) -> frozenset[str]:
    found: set[str] = set()
    for component, name, unit, value in list(system.numbers()):
        values = value, (1.0 + MOVED) * value
        runs = [system.begin_with(component, name, v) for v in values]
        if value == 0.0 or runs[0] is None or runs[1] is None:
            continue
        (before, states), (after, others) = runs[0], runs[1]
        own = in_base(values[1], unit) - in_base(values[0], unit)
        if np.any(np.isclose(others - states, own, rtol=SAME, atol=0.0)):
            continue
        firsts = [[_first(r, one, b) for b in channels] for r in (before, after)]
        found |= {b.channel.name for b, x, y in zip(channels, *firsts) if abs(y - x) > b.floor}
    return frozenset(found)


def _first(results: xr.Dataset, one: Compared, beside: Beside) -> float:
    """First simulated value of a channel [SI]."""
    return float(series_of(results, beside.channel.target, one.recording.path / "recording.yaml").values[0])
