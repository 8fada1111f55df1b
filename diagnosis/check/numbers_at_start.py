"""Channels that begin where numbers of the rig put them: outputs that are no state, and have no start of their own.

The temperature of an exhaust, or the thrust of a nozzle, is worked out from what flows and from numbers of the rig.
Where such a number is off, or a law is missing, its first reading is off as all others are, however the recording
began.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass

import numpy as np
import xarray as xr

from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.input_runs import is_quick
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.systems.fast import in_base
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.run import SystemRuns
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
    as_stated: dict[str, _Begin | None] = {}
    for component, name, unit, value in list(system.numbers()):
        if value == 0.0:
            continue
        other = (1.0 + MOVED) * value
        if component not in as_stated:  # any of its numbers, as it is, gives the same run
            as_stated[component] = _begin(system.begin_with(component, name, value), one, channels)
        before, after = as_stated[component], _begin(system.begin_with(component, name, other), one, channels)
        if before is None or after is None:
            continue
        own = in_base(other, unit) - in_base(value, unit)
        if np.any(np.isclose(after.states - before.states, own, rtol=SAME, atol=0.0)):
            continue
        pairs = zip(channels, before.channels, after.channels)
        found |= {b.channel.name for b, x, y in pairs if abs(y - x) > b.floor}
    return frozenset(found)


@dataclass(frozen=True)
class _Begin:
    """First values [SI] of channels, and of the states of one FMU."""

    channels: tuple[float, ...]
    states: Array


def _begin(run: tuple[xr.Dataset, Array] | None, one: Compared, channels: Sequence[Beside]) -> _Begin | None:
    if run is None:
        return None
    results, states = run
    source = one.recording.path / "recording.yaml"
    return _Begin(tuple(float(series_of(results, b.channel.target, source).values[0]) for b in channels), states)
