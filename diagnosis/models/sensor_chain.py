"""What a sensor with a lag, a late clock or another gain reads of a course."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.recording.recording import Channel
from diagnosis.recording.series import Series, sample
from diagnosis.search.problem import Term

#: Unit of a reading to the value about which a gain acts: an angle hangs at pi, a thermometer is set at 0 degC.
MIDDLES: Mapping[str, float] = {"rad": math.pi, "K": 273.15}


def read(
    channel: Channel, terms: Mapping[Term, tuple[float, ...]], series: Series, step: float, every: int = 1
) -> Array:
    """Readings of a channel, SI, shape (samples,).

    Args:
        channel: What is read, and when.
        terms: Terms that are present, those of other channels among them.
        series: Course of what is measured, at even times.
        step: Time between two of its values [s].
        every: Values from one that is an output to the next.
    """
    values, late, gain = series.values, 0.0, 0.0
    for term, (amount, *_) in terms.items():
        if term.place != channel.name or term.unit != "measurement":
            continue
        if term.identifier == "sensor_clock_offset":
            late += amount
        elif term.identifier == "sensor_gain":
            gain += amount
        elif term.identifier == "sensor_lag":
            values = lagging(values, amount, step)
    outputs = Series(series.times[::every], values[::every], series.is_flow, series.unit)
    found = sample(outputs, channel.times - late)
    middle = MIDDLES.get(channel.unit, 0.0)
    return np.asarray(middle + (1.0 + gain) * (found - middle))


def lagging(values: Array, lag: float, step: float) -> Array:
    """What a sensor of first order reads of values at even times [s], from rest at the first, shape as given.

    Between two of them the input is a straight line, for which the response is exact (`sensor_lag` in the catalogue).
    """
    if lag <= 0.0:
        return values
    ratio = step / lag
    kept = math.exp(-ratio)
    mean = (1.0 - kept) / ratio  # share of the last step's rise that has not come through
    found, reads = np.empty_like(values), float(values[0])
    before = reads
    for i, now in enumerate(values.tolist()):
        if i:
            reads = kept * reads + (1.0 - kept) * before + (1.0 - mean) * (now - before)
            before = now
        found[i] = reads
    return found
