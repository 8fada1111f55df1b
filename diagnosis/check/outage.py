"""A recorded input without rows for a while: what acted then is not known, nor what readings after it should be.

The last value is held over such a gap. What the rig did otherwise shows in readings within and after it, as long as the
rig remembers, and no number and no law would explain it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from cosim.run import RunStopped
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from diagnosis.judge.diagnosis import Doubt
from diagnosis.models.systems.run import run_quickly
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import FEWEST_VALUES, Channel, Input, Recording
from diagnosis.recording.series import sample, series_of
from diagnosis.report.display import instant

#: Rows of an input, and share of its steps that are usual ones, from which it is one that is logged all the time.
ROWS, REGULAR = 50, 0.9
#: Rows that are missing in a row, from which it is an outage: single ones are lost by chance.
LOST = 5
#: Deviations of the noise by which a reading may depend on what is not known.
DEPENDS = 0.5
#: Share of readings of a channel that may be left out: what depends on an unknown input judges nothing, but of a rig
#: that never forgets little else may be there.
MOST = 0.9
#: Why readings are left out: see `diagnosis.recording.usage`.
REASON = "unknown input"


@dataclass(frozen=True)
class Outage:
    """A stretch without rows.

    Args:
        name: `component.output` of the input.
        begin: Last row before it [s].
        end: First row after it [s].
        step: Usual distance of rows [s].
    """

    name: str
    begin: float
    end: float
    step: float


def outages(recorded: Input) -> list[Outage]:
    """Stretches without rows of an input that is logged at even times and changes."""
    steps = np.diff(recorded.times)
    if len(steps) < ROWS or np.ptp(recorded.values) == 0.0:
        return []
    usual = float(np.median(steps))
    if np.mean(steps < 1.5 * usual) < REGULAR:
        return []
    name = f"{recorded.component}.{recorded.output}"
    return [
        Outage(name, float(recorded.times[i]), float(recorded.times[i + 1]), usual)
        for i in np.flatnonzero(steps > (LOST + 0.5) * usual)
    ]


def without_unknown(
    scenario: Scenario,
    recording: Recording,
    results: xr.Dataset,
    run: Callable[[Scenario], xr.Dataset] = run_quickly,
) -> Recording:
    """The recording without readings that depend on what an input was in an outage.

    The least and the largest value of the input in place of what was held there: readings that move by more than
    `DEPENDS` deviations of their noise are left out, if these are not more than `MOST` of a channel and enough stay.

    Args:
        scenario: That recordings are compared with.
        recording: What was measured.
        results: Of the run under its conditions.
        run: Simulates a scenario.
    """
    moved = {name: np.zeros(len(channel.times)) for name, channel in recording.channels.items()}
    for number, recorded in enumerate(recording.inputs):
        found = outages(recorded)
        if not found:
            continue
        for level in (float(np.min(recorded.values)), float(np.max(recorded.values))):
            inputs = list(recording.inputs)
            inputs[number] = _with(recorded, found, level)
            try:
                other = run(scenario_of(scenario, replace(recording, inputs=tuple(inputs))))
            except (RunStopped, InputError):
                continue
            for name, channel in recording.channels.items():
                moved[name] = np.maximum(moved[name], _apart(channel, recording, results, other))
    return replace(
        recording,
        channels={n: _without(c, moved[n] > DEPENDS * c.deviation) for n, c in recording.channels.items()},
    )


def outage_doubts(recording: Recording) -> Iterator[Doubt]:
    """One about each input with outages: the longest, and what is not compared because of them."""
    count = sum(c.dropped.get(REASON, 0) for c in recording.channels.values())
    for found in (outages(recorded) for recorded in recording.inputs):
        if not found:
            continue
        longest = max(found, key=lambda o: o.end - o.begin)
        others = f", the longest of {len(found)} gaps" if len(found) > 1 else ""
        told = f"{count} readings that depend on such gaps are not compared" if count else "the last value is held"
        yield Doubt(
            recording.title,
            longest.name,
            "input",
            f"its column has no rows from {instant(longest.begin)} to {instant(longest.end)} s, where one every "
            f"{instant(longest.step, 3)} s is usual{others}: what acted then is not known, and {told}",
            "give its course there, or end the recording before it (`end`)",
            False,
            longest.begin,
            longest.end,
            (longest.end - longest.begin) / longest.step,
        )


def _with(recorded: Input, found: list[Outage], level: float) -> Input:
    """The input with a level in all outages, from a row after its last one to a row before the next one."""
    added = np.array([t for o in found for t in (o.begin + o.step, o.end - o.step)])
    places = np.searchsorted(recorded.times, added)
    return replace(
        recorded,
        times=np.insert(recorded.times, places, added),
        values=np.insert(recorded.values, places, level),
    )


def _apart(channel: Channel, recording: Recording, one: xr.Dataset, other: xr.Dataset) -> Array:
    """How far both simulations are apart at the readings, SI, shape (samples,)."""
    source = recording.path / "recording.yaml"
    first, second = (sample(series_of(results, channel.target, source), channel.times) for results in (one, other))
    return np.nan_to_num(np.abs(first - second), nan=np.inf)


def _without(channel: Channel, depends: AnyArray) -> Channel:
    count = int(np.count_nonzero(depends))
    if not count or count > MOST * len(depends) or len(depends) - count < FEWEST_VALUES:
        return channel
    return channel.only(~depends, {REASON: count})
