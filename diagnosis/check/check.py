"""The first question of a diagnosis: are these recordings and this scenario of the same experiment?"""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from cosim.scenario import Scenario
from diagnosis.check.beside import Compared, compare
from diagnosis.check.changed_rig import changed_rig
from diagnosis.check.clock_doubts import shift_doubts
from diagnosis.check.clock_of_one import clocks_of_one
from diagnosis.check.copied import copied_doubts
from diagnosis.check.edges import edge_doubts
from diagnosis.check.exchanged_inputs import exchanged_inputs
from diagnosis.check.gain_of_one import gain_of_one
from diagnosis.check.input_doubts import input_doubts
from diagnosis.check.late_input import late_input
from diagnosis.check.odd_one_out import odd_ones
from diagnosis.check.other_course import other_course
from diagnosis.check.other_number import other_number
from diagnosis.check.outage import outage_doubts
from diagnosis.check.places import place_doubts, size_doubts
from diagnosis.check.readings import reading_doubts
from diagnosis.check.scale import sign_doubts, unit_doubts
from diagnosis.check.sensor_of_one import sensor_of_one
from diagnosis.check.size_of_input import size_of_input
from diagnosis.check.start import start_doubts, with_odd_starts
from diagnosis.check.still import still_doubts
from diagnosis.check.swapped import swap_doubts
from diagnosis.check.swapped_in_one import swapped_in_one
from diagnosis.check.time_unit import time_unit_doubts
from diagnosis.check.timing import switch_doubts, timing_doubts
from diagnosis.check.unfollowed import unfollowed
from diagnosis.check.unit_of_all import units_of_all
from diagnosis.check.unit_of_input import unit_of_input
from diagnosis.check.unit_of_one import units_of_one
from diagnosis.judge.diagnosis import Doubt
from diagnosis.judge.doubts import without_consequences
from diagnosis.recording.recording import FEWEST_VALUES, Recording


def check_recordings(
    scenario: Scenario, recordings: Sequence[Recording], simulated: Mapping[str, xr.Dataset] | None = None
) -> tuple[Doubt, ...]:
    """Doubts about recordings, before anything is fitted.

    It takes one simulation of the scenario, as it is, under the conditions of each recording (of a fabric three, from
    starts of their own), and regressions.

    Args:
        scenario: What the recordings are compared with.
        recordings: Training and held-out ones together.
        simulated: Folder of a recording (`str(recording.path)`) to the results of `cosim.run.run` under its conditions,
            where they are known already.

    Returns:
        Serious doubts first, then by their size. docs/recording-check.md has measured rates of false ones.

    Raises:
        InputError: A recording does not fit the scenario.
    """
    given = simulated or {}
    every = [compare(scenario, r, given.get(str(r.path))) for r in recordings]
    return doubts_of(every)


def doubts_of(every: Sequence[Compared]) -> tuple[Doubt, ...]:
    """Doubts about recordings that are simulated already; the order is that of `check_recordings`."""
    found: list[Doubt] = list(still_doubts(every))
    by_unit = [*units_of_one(every), *units_of_all(every)]
    exchanged, clocks = swapped_in_one(every), clocks_of_one(every)
    odd = odd_ones(every)
    standing_out = {d.recording for d in odd}
    late = [d for one in every if one.recording.title in standing_out and (d := late_input(one)) is not None]
    for one in every:
        found += outage_doubts(one.recording)
        inputs = input_doubts(one)
        # an input that the readings do not follow explains whatever else they do not follow
        known = any(d.is_serious for d in inputs)
        relation = [] if known else _relation(one, [o for o in every if o is not one])
        if not any(d.is_serious for d in relation):  # what explains every channel goes before what is open
            relation = [d for d in late if d.recording == one.recording.title] or relation
        relation = relation or [d for d in (*exchanged, *clocks) if d.recording == one.recording.title]
        units = unit_doubts(one) or size_doubts(one) or [d for d in by_unit if d.recording == one.recording.title]
        found += [*inputs, *relation, *units, *reading_doubts(one, not relation and not known)]
        if not any(d.is_serious for d in (*relation, *units)):  # milliseconds for seconds, say, are known as such
            found += _outside(one)
        if not relation and not known and not units:  # a start that another column or unit has is no start
            found += start_doubts(one)
    gain = functools.cache(lambda title: gain_of_one(*_apart(title, every)))
    found = _without_starts_by_gain(with_odd_starts(found, every), standing_out, gain)
    told = {d.recording for d in found if d.is_serious}  # why such a recording stands out is known
    found += [_odd(d, every, d.recording in told, gain) for d in odd]
    # numbers that are off hide that a recording stands out, and not that one channel of it alone is multiplied
    others = [o.recording.title for o in every if o.recording.title not in told | standing_out]
    found += [d for title in others if (d := gain(title)) is not None]
    if not told:  # else why it is not followed is known
        found += unfollowed(every)
    return tuple(sorted(without_consequences(found), key=lambda d: (not d.is_serious, -d.z)))


def _apart(title: str, every: Sequence[Compared]) -> tuple[Compared, list[Compared]]:
    """A recording, and the others."""
    one = next(o for o in every if o.recording.title == title)
    return one, [o for o in every if o is not one]


def _without_starts_by_gain(
    doubts: Sequence[Doubt], standing_out: Collection[str], gain: Callable[[str], Doubt | None]
) -> list[Doubt]:
    """Doubts without starts that are elsewhere since a sensor reads so many times what it reads in the others.

    A start is forgotten or stays; it multiplies nothing that comes after it.
    """
    found = list(doubts)
    for title in standing_out:
        serious = [d for d in found if d.recording == title and d.is_serious]
        if not serious or any(d.kind != "start" for d in serious):
            continue
        told = gain(title)
        if told is not None:
            found = [d for d in found if d not in serious or d.subject != told.subject]
    return found


def _odd(doubt: Doubt, every: Sequence[Compared], is_told: bool, gain_at: Callable[[str], Doubt | None]) -> Doubt:
    """A doubt about a recording that stands out: why, where that is known; not serious where another doubt says why."""
    if is_told:
        return replace(doubt, is_serious=False)
    one, others = _apart(doubt.recording, every)
    gain = gain_at(doubt.recording)
    if gain is not None and gain.is_serious:
        return gain
    sensor = sensor_of_one(one, others)
    if sensor is not None:  # a number or an input that explains the same is no better known
        return sensor
    asked = (exchanged_inputs, unit_of_input, size_of_input, other_course, other_number, changed_rig)
    return next((d for ask in asked if (d := ask(one, others)) is not None), gain or doubt)


def _relation(one: Compared, others: Sequence[Compared]) -> list[Doubt]:
    """What is wrong between readings and programme, the explanation that is known best first."""
    timing = time_unit_doubts(one) or timing_doubts(one, others)
    swaps = [*swap_doubts(one), *([] if size_doubts(one) else place_doubts(one))]
    if timing or swaps:
        return timing if not swaps or (timing and timing[0].z > max(d.z for d in swaps)) else swaps
    return copied_doubts(one, others) or sign_doubts(one) or shift_doubts(one) or edge_doubts(one) or switch_doubts(one)


def _outside(one: Compared) -> list[Doubt]:
    """Channels whose readings are not of the time that is simulated: nothing can be compared with them."""
    start, stop = (t.to("s") for t in (one.scenario.time.start, one.scenario.time.stop))
    found = []
    for channel in (b.channel for b in one.channels.values()):
        count = int(np.count_nonzero((channel.times >= start) & (channel.times <= stop)))
        if count < FEWEST_VALUES:
            text = (
                f"{count} of its readings are within the simulated time: they are from {channel.times[0]:.6g} to "
                f"{channel.times[-1]:.6g} s, and {start:.6g} to {stop:.6g} s is simulated"
            )
            remedy = "correct `zero` and `unit` of its clock, or `time` under `overrides`"
            found.append(
                Doubt(
                    one.recording.title,
                    channel.name,
                    "clock",
                    text,
                    remedy,
                    True,
                    float(channel.times[0]),
                    float(channel.times[-1]),
                    float(FEWEST_VALUES),
                )
            )
    return found
