"""Whether recordings fit a scenario: every channel, element, unit and time, before anything is simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.assemble import assemble
from cosim.observers.trace import Trace
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import FEWEST_VALUES, Channel, Recording
from diagnosis.recording.series import place_of
from diagnosis.recording.units import WrongUnit, conversion_of_reading

#: Rounding of a time that was written with 12 digits, as a share of its size.
_DIGITS = 1e-11


def fitting(scenario: Scenario, recordings: Sequence[Recording]) -> list[Recording]:
    """The recordings without the readings outside the simulated time, once every channel is known to be there.

    The scenario is put together under the conditions of each recording and asked for its variables; it is not run.

    Args:
        scenario: What they are compared with.
        recordings: As they were loaded.

    Raises:
        InputError: A scenario is wrong; it has no such quantity or element; a unit does not fit the variable; or a
            channel has too few readings within the simulated time.
    """
    return [_fitting(scenario_of(scenario, r), r) for r in recordings]


def no_results(scenario: Scenario) -> xr.Dataset:
    """Results of a run of no length: every variable that a run records, with its dimensions and unit.

    Raises:
        InputError: The scenario is wrong.
    """
    assembly = assemble(scenario)
    try:
        return Trace(assembly.system, []).dataset()
    finally:
        assembly.system.terminate()


def _fitting(scenario: Scenario, recording: Recording) -> Recording:
    file, there = recording.path / "recording.yaml", no_results(scenario)
    start, stop = scenario.time.start.to("s"), scenario.time.stop.to("s")
    found = {}
    for name, channel in recording.channels.items():
        _check_unit(there, channel, file)
        found[name] = _within(channel, start, stop, file)
    return replace(recording, channels=found)


def _check_unit(there: xr.Dataset, channel: Channel, file: Path) -> None:
    values, _ = place_of(there, channel.target, file)
    key = f"channels.{channel.name}"
    if values.dtype.kind not in "biuf":
        raise InputError(file, key, f"{values.name} of the scenario is text", "leave the channel out")
    own = str(values.attrs.get("units", "1"))
    try:
        conversion_of_reading(channel.unit, own)
    except WrongUnit as error:
        raise InputError(
            file, f"{key}.unit", f"{values.name} of the scenario is in {own}: {error}", error.remedy
        ) from error


def _within(channel: Channel, start: float, stop: float, file: Path) -> Channel:
    """The channel without readings that no clock as stated brings into the simulated time.

    Readings that only a clock that is off brings into it do not count towards those that are needed: the simulation has
    no value for them.
    """
    digits = _DIGITS * max(abs(start), abs(stop))
    slack = channel.offset_bound + digits
    inside = (channel.times >= start - slack) & (channel.times <= stop + slack)
    count = int(np.count_nonzero((channel.times >= start - digits) & (channel.times <= stop + digits)))
    if count < FEWEST_VALUES:
        span = f"{channel.times[0]:.6g} s to {channel.times[-1]:.6g} s"
        raise InputError(
            file,
            f"channels.{channel.name}",
            f"it has {count} values within the simulated time, fewer than {FEWEST_VALUES}: they are from {span}, and "
            f"{start:.6g} s to {stop:.6g} s is simulated",
            "correct `zero` and `unit` of its clock, or `time` under `overrides`",
        )
    if inside.all():
        return channel
    outside = {
        "before start": int(np.count_nonzero(channel.times < start - slack)),
        "after stop": int(np.count_nonzero(channel.times > stop + slack)),
    }
    return channel.only(inside, {reason: count for reason, count in outside.items() if count})
