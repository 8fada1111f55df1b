"""Quantities that follow a held input at once, and readings taken at the instant at which that input changes.

The table of a recording does not say whether a reading was taken just before or just after a change that has its time.
Where the output jumps with the input (a direct term in its equation, such as the resistance of a battery), the two
differ by the whole jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.recording.noise import estimate_noise, find_quantum, repeats_end
from diagnosis.recording.recording import FEWEST_VALUES, Channel
from diagnosis.recording.series import Series, sample
from diagnosis.recording.usage import COURSE

#: Share of the bends of a simulated course that its input must explain, and how much of the rise in one output must be
#: over in the next, of an output that follows at once. A first-order lag of two output steps keeps 0.6 of its rate.
EXPLAINED, OVER = 0.8, 0.6
#: Output steps on either side of a change without another, and fewest such changes that tell whether an output jumps.
ALONE, FEWEST_ALONE = 2, 3
#: Share to which changes of the residuals must fall with the output after the change, where every reading is at one.
AFTER = 0.7
#: Share of the scatter between neighbours below which that of the residuals replaces it, as noise that nobody stated.
QUIETER = 0.5
#: Rounding of a time of a table [share of the output step].
ROUNDING = 1e-6


def settled(channel: Channel, series: Series, inputs: Sequence[tuple[Array, Array]]) -> Channel:
    """The channel with readings that can be compared where its output jumps with an input.

    Where few readings are near changes, those between the outputs before and after one are left out, and those next to
    them, through which the course is interpolated. Where the input is a recorded course that changes all the time, the
    readings decide whether they are compared with the output before or after the change.

    Args:
        channel: Readings.
        series: Its simulation, at even times.
        inputs: Instants [s] and values of each held input, from each instant on.
    """
    if not follows_at_once(series, inputs, channel.deviation):
        return channel
    levels = _levels(series, inputs)
    step = float(series.times[1] - series.times[0])
    switched = series.times[:-1][np.any(np.diff(levels, axis=1) != 0.0, axis=0)]
    if len(switched) >= COURSE * len(channel.times):
        later = replace(channel, times=channel.times + step, later=step)
        if _change(later, series) < AFTER * _change(channel, series):
            return later
        switched = series.times[:0]
    return _without(channel, switched, float(series.times[0]), step)


def follows_at_once(series: Series, inputs: Sequence[tuple[Array, Array]], deviation: float) -> bool:
    """Whether a simulated course jumps with an input.

    Args:
        series: At even times.
        inputs: Instants [s] and values of each held input, from each instant on.
        deviation: Of the channel's noise, SI.
    """
    if len(series.times) < 5 or not inputs:
        return False
    levels = _levels(series, inputs)
    return any(asked(series.values, levels, deviation) for asked in (_jumps_alone, _jumps))


def _levels(series: Series, inputs: Sequence[tuple[Array, Array]]) -> Array:
    """Inputs that each output was computed with, shape (inputs, outputs)."""
    return np.stack([_held(times, values, series.times) for times, values in inputs])


def _held(times: Array, values: Array, outputs: Array) -> Array:
    """Input that each output was computed with: what was held just before it; shape (outputs,)."""
    slack = ROUNDING * (outputs[1] - outputs[0])
    return np.asarray(values[np.maximum(np.searchsorted(times, outputs - slack, side="right") - 1, 0)])


def _jumps_alone(values: Array, levels: Array, deviation: float) -> bool:
    """Whether a simulated course jumps where inputs change, by changes with none beside them.

    The jump may have another size at each: a flow through a valve hangs on the pressure too.

    Args:
        values: Shape (outputs,).
        levels: Shape (inputs, outputs).
        deviation: Of the noise.
    """
    if not np.isfinite(values).all():
        return False
    has_changed = np.any(np.diff(levels, axis=1) != 0.0, axis=0)
    near = np.convolve(has_changed, np.ones(2 * ALONE + 1), mode="same")
    steps = np.flatnonzero(has_changed & (near == 1))
    steps = steps[(steps > 0) & (steps < len(values) - 2)]
    if len(steps) < FEWEST_ALONE:
        return False
    rates = np.diff(values)
    rise, after = np.abs(rates[steps] - rates[steps - 1]), np.abs(rates[steps + 1] - rates[steps - 1])
    return bool(rise.max() > deviation and after.sum() < (1.0 - OVER) * rise.sum())


def _jumps(values: Array, levels: Array, deviation: float) -> bool:
    """Whether a simulated course jumps with inputs that may change all the time, by more than the noise.

    Args:
        values: Shape (outputs,).
        levels: Shape (inputs, outputs).
        deviation: Of the noise.
    """
    bends = np.diff(values, 2)
    changes = np.diff(levels, axis=1)
    changes = changes[np.any(changes != 0.0, axis=1)]
    if not len(changes) or not np.isfinite(bends).all():
        return False
    # bend k is between steps k and k + 1: a jump in step k + 1 bends it up, and back down in the next
    now, before = changes[:, 1:], changes[:, :-1]
    is_near = np.any((now != 0.0) | (before != 0.0), axis=0)
    features, wanted = np.vstack([now, before])[:, is_near].T, bends[is_near]
    found = np.linalg.lstsq(features, wanted, rcond=None)[0]
    left = float(np.sum((wanted - features @ found) ** 2))
    rise, back = found[: len(changes)], found[len(changes) :]
    size = np.abs(rise) * np.max(np.abs(changes), axis=1)
    largest = int(np.argmax(size))
    is_over = -back[largest] * np.sign(rise[largest]) > OVER * abs(rise[largest])
    is_explained = left < (1.0 - EXPLAINED) * float(np.sum(wanted**2))
    return bool(size[largest] > deviation and is_over and is_explained)


def _change(channel: Channel, series: Series) -> float:
    """Mean size of the change of the residual from one reading to the next [SI]."""
    return float(np.mean(np.abs(np.diff(channel.values - sample(series, channel.times)))))


def _without(channel: Channel, switched: Array, start: float, step: float) -> Channel:
    """The channel without readings of an output step in which an input changes, and those interpolated from it.

    Of a reading at the first output nobody knows whether the inputs had their first value already.
    """
    slack = ROUNDING * step
    place = np.searchsorted(switched, channel.times + slack)
    since = channel.times - np.concatenate([[-np.inf], switched])[place]
    until = np.append(switched, np.inf)[place] - channel.times
    is_between = np.abs((channel.times - start) / step - np.round((channel.times - start) / step)) > ROUNDING
    is_at: AnyArray = (
        (channel.times < start + slack) | (since < step - slack) | is_between & ((since < 2.0 * step) | (until < step))
    )
    if len(channel.times) - int(is_at.sum()) < FEWEST_VALUES or not is_at.any():
        return channel
    return channel.only(~is_at, {"at a switch": int(is_at.sum())})


def quieter(channel: Channel, series: Series) -> float:
    """Standard deviation of a channel's noise by neighbouring readings, less what its simulation explains of them.

    Readings that follow an input which changes all the time differ from their neighbours by more than their noise. A
    gain of the simulation, fitted to bends of the readings, is free: a wrong model leaves more than the noise, never
    less.

    Args:
        channel: Readings.
        series: Its simulation.
    """
    own = estimate_noise(channel.times, channel.values, channel.quantum)
    simulated = sample(series, channel.times)
    if len(channel.values) < FEWEST_VALUES or not np.isfinite(simulated).all() or np.ptp(simulated) == 0.0:
        return own
    bends, wanted = np.diff(simulated, 2), np.diff(channel.values, 2)
    size = float(bends @ bends)
    gain = float(bends @ wanted) / size if size > 0.0 else 0.0
    step = channel.quantum or find_quantum(channel.values)
    is_free = ~repeats_end(channel.values)
    return min(own, estimate_noise(channel.times, channel.values - gain * simulated, step, is_free))
