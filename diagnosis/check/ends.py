"""Ends of a sensor's range that a recording does not state: readings that repeat one value where the rig goes on.

A reading at an end of the range says no more than that the quantity lies there or beyond. An end stop or an overflow
of the rig holds the quantity itself, whose readings go on to scatter with the noise of the sensor.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.noise import repeats_end
from diagnosis.recording.recording import Channel, Recording

#: Readings of a channel below which nothing is said of its range, and at an end from which they may be one.
FEWEST, MANY = 32, 8
#: How far the simulation has to go beyond an end, in deviations of the noise and as a share of the channel's range.
BEYOND, SHARE = 10.0, 0.05
#: Share of the variance of the other readings that the simulation explains, scaled and offset as suits best.
MET = 0.95
#: Share of the readings at an end where the simulation has to be beyond it, and of readings where it is far beyond that
#: have to be at the end.
BOTH = 0.8
#: Share of an end by which the other end of a symmetric range may be nearer to zero, or farther.
SYMMETRIC = 1e-3


@dataclass(frozen=True)
class End:
    """Readings that repeat an end of their channel.

    Args:
        is_upper: Whether it is the largest value.
        value: SI.
        held: Which readings are there, shape (samples,).
    """

    is_upper: bool
    value: float
    held: AnyArray

    @property
    def count(self) -> int:
        """How many readings are there."""
        return int(np.count_nonzero(self.held))


def ends_of(channel: Channel) -> Iterator[End]:
    """Ends that readings repeat, where they scatter elsewhere.

    Where the quantity is 0 there, a sensor of what is switched off, or one that rounds coarsely, does the same.
    """
    values = channel.values
    if len(values) < FEWEST or channel.is_clipped.any():
        return
    repeats = repeats_end(values)
    for is_upper, value in ((True, float(values.max())), (False, float(values.min()))):
        end = End(is_upper, value, np.asarray(repeats & (values == value)))
        if end.count >= MANY and value != 0.0:
            yield end


def range_doubts(compared: Compared, beside: Beside) -> list[Doubt]:
    """Doubts about the range of a channel's sensor.

    Serious where the simulation goes on beyond its end, and of the other end of a symmetric range where it does so
    beyond one of them.
    """
    channel = beside.channel
    found, ends = [], list(ends_of(channel))
    free = ~np.any([np.zeros(len(channel.values), dtype=bool), *(end.held for end in ends)], axis=0)
    beyond = [_beyond(beside, end, free) for end in ends]
    for end, far in zip(ends, beyond):
        name, key = ("largest", "maximum") if end.is_upper else ("smallest", "minimum")
        shown = compared.units.text(end.value, channel.unit, is_difference=False)
        repeated = f"{end.count} of {len(channel.values)} readings repeat its {name} value, {shown}"
        there = f"{repeated}, while it scatters elsewhere"
        # a range that ends at a value ends at its opposite too, if readings repeat that
        opposite = [e for e, f in zip(ends, beyond) if f is not None and e.is_upper != end.is_upper]
        is_opposite = any(abs(e.value + end.value) < SYMMETRIC * abs(end.value) for e in opposite)
        if far is None and is_opposite:
            text = f"{there}, as far from zero as the other end of the range: the sensor's range ends there too"
            remedy = f"state `{key}`; here such readings count as what lies there or beyond"
        elif far is None:
            text = f"{there}: the sensor's range may end there"
            remedy = f"if it does, state `{key}`: such readings then count as what lies there or beyond"
        else:
            size = compared.units.text(far, channel.unit)
            text = (
                f"{there} and the simulation, scaled and offset to meet the others, goes on by up to {size}: the "
                f"sensor's range ends there, or it was cut off"
            )
            remedy = f"state `{key}`; here such readings count as what lies there or beyond"
        times = channel.times[end.held]
        found.append(
            Doubt(
                compared.recording.title,
                channel.name,
                "range",
                text,
                remedy,
                far is not None or is_opposite,
                float(times[0]),
                float(times[-1]),
                float(end.count),
            )
        )
    return found


def _beyond(beside: Beside, end: End, free: AnyArray) -> float | None:
    """How far the simulation goes beyond an end where, and only where, readings are there; None where it does not.

    Numbers of the scenario may be off: it is scaled and offset as suits the other readings best, which it has to meet.

    Args:
        beside: The channel beside its simulation.
        end: One of its ends.
        free: Which readings are at no end, shape (samples,).
    """
    if beside.simulated is None:
        return None
    values = beside.channel.values
    course = beside.at(beside.channel.times)
    if not np.isfinite(course).all() or np.std(course[free]) <= beside.floor or np.std(values[free]) == 0.0:
        return None
    slope, offset = np.polyfit(course[free], values[free], 1)
    rest = values[free] - slope * course[free] - offset
    if slope <= 0.0 or np.var(rest) > (1.0 - MET) * np.var(values[free]):
        return None
    over: Array = (1.0 if end.is_upper else -1.0) * (slope * course + offset - end.value)
    is_far = over > max(BEYOND * beside.floor, SHARE * float(np.ptp(values)))
    if not is_far.any() or np.mean(over[end.held] > 0.0) < BOTH or np.mean(end.held[is_far]) < BOTH:
        return None
    return float(over[end.held].max())


def with_ends(recording: Recording, doubts: Sequence[Doubt]) -> Recording:
    """The recording with the ends of range that are no question: readings there count as what lies there or beyond.

    Args:
        recording: As it was compared.
        doubts: About all recordings.
    """
    told = [d for d in doubts if d.kind == "range" and d.is_serious and d.recording == recording.title]
    channels = dict(recording.channels)
    for name in {d.subject for d in told}:
        channel = channels[name]
        low, high = channel.limits
        for end in ends_of(channel):
            held = channel.times[end.held]
            if any(d.subject == name and (d.begin, d.end) == (held[0], held[-1]) for d in told):
                low, high = (low, end.value) if end.is_upper else (end.value, high)
        clipped = (channel.values <= low) | (channel.values >= high)
        channels[name] = replace(channel, limits=(low, high), is_clipped=clipped)
    return replace(recording, channels=channels)
