"""What a sensor reads that has a lag, hysteresis, a late clock, another gain, a bend, a bias, a drift, or a range."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.signal import lfilter
from scipy.special import ndtr

from cosim.unit.protocol import Array
from diagnosis.recording.recording import Channel
from diagnosis.recording.series import Series, sample
from diagnosis.search.problem import Term

#: Unit of a reading to the value about which a gain acts: an angle hangs at pi, a thermometer is set at 0 degC.
MIDDLES: Mapping[str, float] = {"rad": math.pi, "K": 273.15}

#: Law of a limited range to the side on which it ends.
ENDS: Mapping[str, float] = {"sensor_clipping": 1.0, "sensor_clipping_below": -1.0}


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
    own = [(t.identifier, v) for t, v in terms.items() if t.place == channel.name and t.unit == "measurement"]
    with np.errstate(over="ignore", invalid="ignore"):  # a simulation that runs away is infinite, and no finding
        return _reading(channel, own, series, step, every)


def _reading(
    channel: Channel, own: Sequence[tuple[str, tuple[float, ...]]], series: Series, step: float, every: int
) -> Array:
    def sum_of(identifier: str) -> float:
        return sum(v[0] for name, v in own if name == identifier)

    values = series.values
    for lag in (v[0] for name, v in own if name == "sensor_lag"):
        values = lagging(values, lag, step)
    values = values[::every]
    for half, travel in (v for name, v in own if name == "sensor_hysteresis"):
        values = values - half * turned(values, travel)
    outputs = Series(series.times[::every], values, series.is_flow, series.unit)
    found = sample(outputs, channel.times - sum_of("sensor_clock_offset"))
    middle = MIDDLES.get(channel.unit, 0.0)
    found = np.asarray(middle + sum_of("sensor_bias") + (1.0 + sum_of("sensor_gain")) * (found - middle))
    for bend, centre in (v for name, v in own if name == "sensor_bend"):
        found = found + bend * (found - centre) ** 2
    if drift := sum_of("sensor_drift"):
        found = found + drift * (channel.times - channel.times[:1])
    for name, amounts in own:
        if name in ENDS:
            clipped, end = amounts
            found = found + clipped * (cut_off(found, end, ENDS[name], channel.deviation) - found)
    return np.asarray(found)


def cut_off(values: Array, end: float, side: float, noise: float) -> Array:
    """Mean readings of a sensor whose range ends, shape as given.

    A reading is cut off with its noise: near the end, within the noise, its mean is beyond it by less than the truth is
    (mean of a normal number that is censored: Johnson, Kotz, Balakrishnan, Continuous Univariate Distributions, 1994,
    chapter 13).

    Args:
        values: What is measured, SI.
        end: Where the range ends, SI.
        side: 1 for its upper end, -1 for its lower one.
        noise: Deviation of the noise, SI.

    >>> cut_off(np.array([0.0, 5.0]), 1.0, 1.0, 0.01).tolist()
    [0.0, 1.0]
    """
    width = max(noise, 1e-12 * max(abs(end), 1.0))
    gap = np.clip(side * (end - values) / width, -40.0, 40.0)
    loss = gap * ndtr(gap) - gap + np.exp(-0.5 * gap**2) / math.sqrt(2.0 * math.pi)
    return np.asarray(np.where(gap <= -40.0, end, values - side * width * loss))


def lagging(values: Array, lag: float, step: float) -> Array:
    """What a sensor of first order reads of values at even times [s], from rest at the first, shape as given.

    Between two of them the input is a straight line, for which the response is exact (`sensor_lag` in the catalogue).
    """
    if lag <= 0.0:
        return values
    ratio = step / lag
    kept = math.exp(-ratio)
    mean = (1.0 - kept) / ratio  # share of the last step's rise that has not come through
    found, _ = lfilter([1.0 - mean, mean - kept], [1.0, -kept], values, zi=[mean * float(values[0])])
    return np.asarray(found)


def turned(values: Array, travel: float) -> Array:
    """Where a sensor is in its loop of hysteresis, -1 to 1, shape as given: the stop operator, from its middle on.

    After a turn it goes from one end to the other over twice the travel (M. Brokate, J. Sprekels, Hysteresis and Phase
    Transitions, Springer 1996, section 2.1).

    >>> turned(np.array([0.0, 1.0, 5.0, 4.0, 0.0]), 2.0).tolist()
    [0.0, 0.5, 1.0, 0.5, -1.0]
    """
    found, at = np.empty_like(values), 0.0
    for i, move in enumerate(np.diff(values, prepend=values[:1]).tolist()):
        at = min(max(at + move / travel, -1.0), 1.0)
        found[i] = at
    return found
