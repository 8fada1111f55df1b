"""The readings of one sensor in one recording, and what a fault of it does to their residuals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_banded

from cosim.unit.protocol import AnyArray, Array
from diagnosis.faults.law import DRIFT, FEWEST, LATE, OFFSET, RISE, SCALED, SLOWER, STUCK, WIDE, Span
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.problem import TermParameter


@dataclass(frozen=True, eq=False)
class Readings:
    """One channel of one recording.

    Args:
        number: Of the channel, over all recordings.
        recording: Number of the recording.
        label: Channel, and its recording where there are several.
        unit: SI unit of its readings.
        own: Its residuals among those of the model.
        edges: Times between samples, the first and the last beyond them [s], shape (samples + 1,).
        measured: Readings, SI, shape (samples,).
        deviation: Of their noise, SI.
        used: Which of them count, shape (samples,).
        share: Share of the sum of the residuals that is taken from each: the zero of the channel is unknown
            (`diagnosis.models.coil_network.kernel.whiten`).
        times: Of the samples [s], rising, shape (samples,).
    """

    number: int
    recording: int
    label: str
    unit: str
    own: slice
    edges: Array
    measured: Array
    deviation: float
    used: AnyArray
    share: float
    times: Array

    @property
    def step(self) -> float:
        """Typical time between two samples [s]."""
        return float(np.median(np.diff(self.times))) if len(self.times) > 1 else 1.0

    @property
    def span(self) -> Span:
        """When a fault of it may be."""
        return Span(float(self.edges[0]), float(self.edges[-1]), int(np.count_nonzero(self.used)))

    def box(self, begin: float, end: float) -> Array:
        """Share of each sample's time, to halfway to its neighbours, that lies in an interval; shape (samples,)."""
        low, high = self.edges[:-1], self.edges[1:]
        overlap = np.minimum(high, end) - np.maximum(low, begin)
        return np.clip(overlap / np.maximum(high - low, 1e-300), 0.0, 1.0)

    def ramp(self, begin: float, end: float) -> Array:
        """What rises from 0 at the begin of an interval to 1 at its end, and is 0 else; shape (samples,)."""
        middle = 0.5 * (self.edges[:-1] + self.edges[1:])
        return np.asarray(np.clip((middle - begin) / max(end - begin, 1e-300), 0.0, 1.0) * self.box(begin, end))

    def held(self, begin: float, end: float) -> float:
        """Mean of the readings in an interval, SI."""
        weight = self.box(begin, end) * self.used
        return float(weight @ self.measured / weight.sum()) if weight.any() else float(self.measured[0])

    def plain(self, residuals: Array) -> Array:
        """(measured - simulated) / deviation, from residuals of which a share of their sum was taken away."""
        total = float(np.sum(residuals[self.used])) / (1.0 - self.share * np.count_nonzero(self.used))
        return np.asarray(residuals + self.share * total * self.used)

    def residuals(self, plain: Array) -> Array:
        """The way back from `plain`, of rows too: 0 where a sample does not count."""
        counted = np.where(self.used, plain, 0.0)
        return np.asarray(counted - self.share * counted.sum(axis=-1, keepdims=True) * self.used)

    def with_offset(self, plain: Array, amount: float, begin: float, end: float) -> Array:
        """Plain residuals where the sensor reads too much by an amount within an interval."""
        return np.asarray(plain - amount / self.deviation * self.box(begin, end))

    def with_drift(self, plain: Array, amount: float, begin: float, end: float) -> Array:
        """Plain residuals where the zero of the sensor moves by an amount from begin to end of an interval."""
        return np.asarray(plain - amount / self.deviation * self.ramp(begin, end))

    def with_lag(self, plain: Array, lag: float, begin: float, end: float) -> Array:
        """Plain residuals where the sensor follows with a first-order lag [s] within an interval."""
        read = self.measured / self.deviation
        return np.asarray(read - self.slower(read - plain, lag, begin, end))

    def with_shift(self, plain: Array, offset: float, begin: float, end: float) -> Array:
        """Plain residuals where the sensor reads what was some time before [s], within an interval."""
        read = self.measured / self.deviation
        return np.asarray(read - self.shifted(read - plain, offset, begin, end))

    def scaled(self, rows: Array, gain: float, begin: float, end: float) -> Array:
        """Rows of values at the samples, larger by a share within an interval."""
        return np.asarray(rows * (1.0 + gain * self.box(begin, end)))

    def slower(self, rows: Array, lag: float, begin: float, end: float) -> Array:
        """Rows of values at the samples behind a first-order lag [s] from begin to end, settled at its begin.

        Between two samples the value is a straight line, for which the response is exact. Samples that do not count are
        left out.
        """
        there = np.flatnonzero(self._inside(begin, end))
        if lag <= 0.0 or len(there) < FEWEST:
            return rows
        times, values = self.times[there], rows[..., there]
        kept = np.exp(-np.diff(times) / lag)
        slopes = lag * np.diff(values, axis=-1) / np.diff(times)
        right = np.concatenate(
            [values[..., :1], values[..., 1:] - slopes - kept * (values[..., :-1] - slopes)], axis=-1
        )
        band = np.ones((2, len(there)))
        band[1, :-1] = -kept
        found = rows.copy()
        found[..., there] = solve_banded((1, 0), band, right.T).T
        return found

    def shifted(self, rows: Array, offset: float, begin: float, end: float) -> Array:
        """Rows of values at the samples, from begin to end as they were some time before [s]."""
        used, there = np.flatnonzero(self.used), np.flatnonzero(self._inside(begin, end))
        if offset == 0.0 or len(there) < FEWEST:
            return rows
        times = self.times[used]
        after = np.clip(np.searchsorted(times, self.times[there] - offset), 1, len(times) - 1)
        share = np.clip((self.times[there] - offset - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0)
        found = rows.copy()
        found[..., there] = (1.0 - share) * rows[..., used[after - 1]] + share * rows[..., used[after]]
        return found

    def _inside(self, begin: float, end: float) -> AnyArray:
        """Samples that count within an interval, shape (samples,)."""
        return np.asarray(self.used & (self.box(begin, end) >= 0.5))

    def with_gain(self, plain: Array, amount: float, begin: float, end: float) -> Array:
        """Plain residuals where the sensor reads too much by a share within an interval."""
        box = amount * self.box(begin, end)
        return np.asarray(plain - box * self.rise(plain))

    def rise(self, plain: Array) -> Array:
        """What is simulated at the samples, beyond what a gain is counted from, in deviations of the noise."""
        return np.asarray((self.measured - self.origin) / self.deviation - plain)

    @property
    def origin(self) -> float:
        """What a gain is counted from: 0, or the first reading of what has its zero elsewhere, SI."""
        return 0.0 if self.has_gain or not len(self.measured) else float(self.measured[0])

    @property
    def has_gain(self) -> bool:
        """Whether a gain is something else than an offset: a temperature has its zero elsewhere."""
        largest = float(np.max(np.abs(self.measured), initial=0.0))
        return self.unit != "K" and len(self.measured) > 0 and float(np.ptp(self.measured)) >= WIDE * largest

    def with_held(self, plain: Array, share: float, begin: float, end: float) -> Array:
        """Plain residuals where the sensor holds its reading within an interval."""
        box = share * self.box(begin, end)
        return np.asarray((1.0 - box) * plain + box * (self.measured - self.held(begin, end)) / self.deviation)

    def offset(self, meaning: str = "change of the reading in the interval") -> TermParameter:
        """Bounds of an offset: no larger than the readings are wide, and more than one reading scatters."""
        most = max(float(np.ptp(self.measured)), 10.0 * self.deviation)
        return TermParameter(
            "offset",
            self.unit,
            -most,
            most,
            (self.deviation,),
            negligible=self.deviation,
            meaning=meaning,
        )


#: What the readings of a sensor do under each fault.
ACTS: Mapping[str, Callable[[Readings, Array, float, float, float], Array]] = {
    OFFSET.identifier: Readings.with_offset,
    DRIFT.identifier: Readings.with_drift,
    SCALED.identifier: Readings.with_gain,
    RISE.identifier: Readings.with_gain,
    STUCK.identifier: Readings.with_held,
    SLOWER.identifier: Readings.with_lag,
    LATE.identifier: Readings.with_shift,
}


def readings_of(model: DiagnosisModel) -> list[Readings]:
    """Every channel of every recording of a model that compares sample by sample, in the order of its residuals."""
    found: list[Readings] = []
    begin = 0
    labels = _labels(model)
    for recording, run in enumerate(model.runs):
        for series, share in zip(run.series, run.shares.tolist()):
            channel, count = series.channel, len(series.samples)
            times = channel.times[-count:] if count else np.zeros(0)
            found.append(
                Readings(
                    len(found),
                    recording,
                    labels[len(found)],
                    channel.unit,
                    slice(begin, begin + count),
                    _edges(times),
                    channel.values[-count:] if count else times,
                    deviation(channel),
                    np.asarray(series.used, dtype=bool),
                    share,
                    times,
                )
            )
            begin += count
    return found


def _labels(model: DiagnosisModel) -> Sequence[str]:
    """Names of the channels with their recordings; with its number too where two recordings have one title."""
    names = model.layout.names
    if len(set(names)) == len(names):
        return names
    return list(_numbered(model))


def _numbered(model: DiagnosisModel) -> Iterator[str]:
    for recording, run in enumerate(model.runs):
        for series in run.series:
            yield f"{series.channel.name} (recording {recording + 1})"


def _edges(times: Array) -> Array:
    if len(times) < 2:
        return np.concatenate([times - 0.5, times + 0.5])
    middle = 0.5 * (times[1:] + times[:-1])
    return np.concatenate([[2.0 * times[0] - middle[0]], middle, [2.0 * times[-1] - middle[-1]]])
