"""Readings that a model was not fitted to, and what a fitted model predicts of them.

Held-out recordings where there are any; else stretches of the training recordings, each predicted by a fit to the
others. Noise is that of the sensors, as stated or as neighbouring readings scatter, never that of residuals.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.judge.constancy import Constancy, columns_by_terms, constancy
from diagnosis.judge.held_out import carried_over
from diagnosis.judge.independent import independent
from diagnosis.judge.initial_state import begun
from diagnosis.judge.parameter_error import Freedom, Tested, freedom, tested
from diagnosis.judge.recording_parameters import recording_parameters
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.protocol import DiagnosisModel, RecordedRun
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.models.wrappers.quasi_likelihood import BELIEVED, inflation
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.fit import fit
from diagnosis.search.objective import RUNAWAY
from diagnosis.search.posterior import HUBER, huber_weights
from diagnosis.search.problem import Point, Term
from diagnosis.search.shares import departures
from diagnosis.search.validation import blocks

#: Stretches of time in which the errors of a model are taken to be alike, per recording and quantity.
STRETCHES = 10
#: Numbers of a day (its room, its start) are estimated within this many prior deviations: 99.7 % of all days.
DAY = 3.0
#: Steps of that estimate: it is nearly linear.
STEPS = 3
#: Deviations of the noise by which one reading must stand out from both neighbours to be a single wild reading. Noise
#: alone reaches it in one of 2e9 readings (the deviation from a neighbour is sqrt(2) times the noise).
WILD = 8.5
#: Readings in a row that may be wild, and share of a channel's readings up to which they are set aside.
MOST_IN_A_ROW, MOST_WILD = 2, 0.05
#: Relative error of a deviation that was estimated from n readings, times sqrt(n): quantiles of differences have about
#: a third of the efficiency of the root mean square, whose figure is sqrt(1/2) (Gasser et al. 1986).
NOISE_ERROR = 1.2


@dataclass(frozen=True)
class Readings:
    """Readings that judge; every array has the shape (readings,).

    Args:
        channel: Number of its channel.
        recording: Number of its recording.
        block: Number of its block: a stretch of time of one quantity of one recording.
        is_wild: Whether it is a single wild reading, by its neighbours alone.
        chosen: Numbers of these readings among all of the model's, run by run, channel by channel.
        channels: Channels, in order.
        of_channel: Number of the recording of each channel.
        titles: Of the recordings.
    """

    channel: AnyArray
    recording: AnyArray
    block: AnyArray
    is_wild: AnyArray
    chosen: AnyArray
    channels: tuple[Channel, ...]
    of_channel: tuple[int, ...]
    titles: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.channel)

    @cached_property
    def weight(self) -> Array:
        """For how many independent readings each one counts, at most 1: contacts that stay where they are scatter all
        readings of a stretch alike."""
        counts = np.bincount(self.channel, minlength=len(self.channels))
        found = np.ones(len(self.channels))
        for number, (share, count) in enumerate(zip(self._shares, counts.tolist())):
            if share > 0.0 and count:
                found[number] = independent([[(count, share, 0.0)]]) / count
        return np.asarray(found[self.channel])

    @cached_property
    def drawn(self) -> Array:
        """Variance of what two predictions of one model gain over each other in each reading, as each is a mean of runs
        that scatter; more where channels scatter together.

        For a reading e and two means m and n of k runs, all independent, of the variances s^2, s^2/k and s^2/k,
        (e - m)^2 - (e - n)^2 = (n - m)(2 e - m - n) has the variance (2/k)(4 + 2/k) s^4, and e - m has (1 + 1/k) s^2,
        which is the scatter.
        """
        shared = np.array([c.scatter_together / c.scatter_runs for c in self.channels])
        runs = np.array([c.scatter_runs for c in self.channels], dtype=np.float64)
        factor = 2.0 * (4.0 + 2.0 / runs) / (1.0 + 1.0 / runs) ** 2
        return np.asarray((self._shares**2 * shared * factor)[self.channel])

    @cached_property
    def _shares(self) -> Array:
        """Share of the variance of each channel that is scatter of the simulation, shape (channels,)."""
        shares = [min((c.scatter / deviation(c)) ** 2, 1.0) if c.scatter > 0.0 else 0.0 for c in self.channels]
        return np.array(shares, dtype=np.float64)


def readings_of(runs: Sequence[RecordedRun], titles: Sequence[str]) -> Readings:
    """Readings of a model's runs that count.

    Args:
        runs: One for each recording.
        titles: Of the recordings.
    """
    channel, recording, block, wild, chosen = [], [], [], [], []
    channels: list[Channel] = []
    owners: list[int] = []
    numbers: dict[tuple[int, str, int], int] = {}
    begin = 0
    for n, run in enumerate(runs):
        times = [s.channel.times[-len(s.samples) :] for s in run.series]
        first, last = min(float(t[0]) for t in times), max(float(t[-1]) for t in times)
        for s, own in zip(run.series, times):
            used = np.flatnonzero(s.used)
            stretch = np.minimum((STRETCHES * (own - first) / max(last - first, 1e-300)).astype(int), STRETCHES - 1)
            keys = [(n, s.channel.target.quantity, int(k)) for k in stretch[used]]
            block.append(np.array([numbers.setdefault(k, len(numbers)) for k in keys], dtype=int))
            channel.append(np.full(len(used), len(channels)))
            recording.append(np.full(len(used), n))
            wild.append(wild_readings(s.channel.values[-len(own) :], deviation(s.channel))[used])
            chosen.append(begin + used)
            channels.append(s.channel)
            owners.append(n)
            begin += len(own)
    return Readings(
        np.concatenate(channel),
        np.concatenate(recording),
        np.concatenate(block),
        np.concatenate(wild),
        np.concatenate(chosen),
        tuple(channels),
        tuple(owners),
        tuple(titles),
    )


def wild_readings(values: Array, noise: float) -> AnyArray:
    """Which readings stand out from both neighbours, to the same side, while these agree with each other.

    Args:
        values: Of one channel, shape (readings,).
        noise: Standard deviation.
    """
    found = np.zeros(len(values), dtype=bool)
    if len(values) < 3:
        return found
    before, after = values[1:-1] - values[:-2], values[1:-1] - values[2:]
    is_out = (np.minimum(np.abs(before), np.abs(after)) > WILD * noise) & (before * after > 0.0)
    found[1:-1] = is_out & (np.abs(values[2:] - values[:-2]) < 0.5 * np.minimum(np.abs(before), np.abs(after)))
    return found


def set_aside(readings: Readings, residuals: Array) -> AnyArray:
    """Readings that say nothing of a model: single wild ones, and one or two in a row that it alone shows to be wild.

    Two wild readings next to each other, one beside a switch, the first and the last have no neighbours that tell.
    Those before and after them must be met, and no more than `MOST_WILD` of a channel may be such: more is a fault of
    the model.

    Args:
        readings: What the residuals belong to.
        residuals: What the model leaves, in deviations of the noise, shape (readings,).

    Returns:
        Shape (readings,).
    """
    found = np.zeros(len(residuals), dtype=bool)
    for n in range(len(readings.channels)):
        places = np.flatnonzero(readings.channel == n)
        # A swing that is read a few times in each period stands out from its neighbours too, and the model meets it.
        found[places] = readings.is_wild[places] & wild_readings(residuals[places], 1.0)
        kept = places[~found[places]]
        size = np.abs(residuals[kept])
        out = size > WILD
        edges = np.flatnonzero(np.diff(np.concatenate([[False], out, [False]]).astype(int)))
        spikes: list[int] = []
        for begin, end in zip(edges[0::2].tolist(), edges[1::2].tolist()):
            # The first and the last reading have one neighbour.
            beside = [float(size[k]) for k in (begin - 1, end) if 0 <= k < len(kept)]
            is_met = bool(beside) and max(beside) < HUBER
            if end - begin <= MOST_IN_A_ROW and is_met:
                spikes += range(begin, end)
        if len(spikes) + len(places) - len(kept) <= MOST_WILD * len(places):
            found[kept[spikes]] = True
    return found


@dataclass(frozen=True)
class Predicted:
    """What a model leaves of readings that it was not fitted to.

    Args:
        residuals: With what belongs to the day alone (room, start) estimated within its prior, in deviations of the
            noise, shape (readings,).
        plain: The same with the room and the start as they are written down.
        prior: Squares of the day's numbers in prior deviations, summed: the price of that estimate.
        day: Name of each number of the day to how far it is from what is written down, in its own unit and in
            deviations: what all recordings share of it counts too.
        points: By which each part of the readings was predicted; one where they are no parts.
    """

    residuals: Array
    plain: Array
    prior: float = 0.0
    day: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    points: tuple[Point, ...] = ()


class Unfitted(Protocol):
    """Predicts readings that a point was not fitted to."""

    readings: Readings
    basis: str

    def predict(self, point: Point, is_fitted: bool = True) -> Predicted:
        """What a model leaves of the readings.

        Args:
            point: Of the training model.
            is_fitted: Whether it comes from a fit to the training recordings.
        """
        ...

    def tested(self, point: Point, predicted: Predicted) -> Tested | None:
        """What the readings leave where fitted numbers may move within their own error; None where none can be moved.

        Args:
            point: A fit of the training model.
            predicted: What it predicts.
        """
        ...

    def strengths(self, point: Point, predicted: Predicted) -> dict[Term, Constancy]:
        """Strengths of the laws of a fit in the readings, of those that can be estimated from them alone.

        Args:
            point: A fit of the training model.
            predicted: What it predicts.
        """
        ...


def raw_residuals(model: DiagnosisModel, point: Point) -> Array:
    """(measured - simulated) / noise of every reading, run by run, channel by channel; clipped where not finite."""
    rows = []
    for n, run in enumerate(model.runs):
        for series, values in zip(run.series, model.predict(point, n)):
            measured = series.channel.values[-len(series.samples) :]
            rows.append((measured - values) / deviation(series.channel))
    found = np.concatenate(rows)
    return _finite(found)


def has_bins(model: DiagnosisModel) -> bool:
    """Whether residuals of the search are means of readings, as those of a fabric, and not readings themselves."""
    return model.residual_of_reading is not None


def can_be_moved(model: DiagnosisModel) -> bool:
    """Whether derivatives of its readings are known: not where each simulation takes minutes, or bins are fitted."""
    return model.can_be_fitted and not has_bins(model)


def _tested(model: DiagnosisModel, readings: Readings, kept: AnyArray, may: Freedom, columns: Array) -> Tested:
    """See `diagnosis.judge.parameter_error.tested`.

    Args:
        model: The model that predicts.
        readings: Its readings.
        kept: Which of them judge, shape (readings,).
        may: How its numbers may move.
        columns: Derivatives of all its residuals, shape (residuals, k).
    """
    chosen = readings.chosen[kept]
    return tested(
        may,
        columns[chosen],
        lambda point: raw_residuals(model, point)[chosen],
        readings.channel[kept],
        _has_zero(readings.channels),
    )


def _has_zero(channels: Sequence[Channel]) -> AnyArray:
    """Which channels have a zero that is unknown by a share of their noise, shape (channels,)."""
    return np.array([c.bias_bound == 0.0 for c in channels])


def _finite(residuals: Array) -> Array:
    """Residuals, those that are not finite or run away at `RUNAWAY`: their squares are numbers then."""
    return np.clip(np.where(np.isfinite(residuals), residuals, RUNAWAY), -RUNAWAY, RUNAWAY)


class HeldOutReadings:
    """See `Unfitted`: recordings that were held out.

    Args:
        judge: Model of the held-out recordings.
        trained: Model that was fitted.
        recordings: Held-out recordings, in order.
    """

    basis = "held-out recordings"

    def __init__(self, judge: DiagnosisModel, trained: DiagnosisModel, recordings: Sequence[Recording]) -> None:
        self._judge, self._trained, self._recordings = judge, trained, recordings
        self._has_beginning = any(r.beginning > 0 for r in recordings)
        nominal = {"nominal": Point(np.zeros(len(judge.parameters)))}
        shown = begun(judge, trained, nominal, recordings)[0] if self._has_beginning else judge
        self.readings = readings_of(shown.runs, [r.title for r in recordings])
        self._own = recording_parameters(judge, trained) if judge.can_be_fitted else []
        self._columns: Array | None = None

    def predict(self, point: Point, is_fitted: bool = True) -> Predicted:
        """See `Unfitted`."""
        carried = carried_over(point, self._trained, self._judge)
        if self._has_beginning:
            carried = begun(self._judge, self._trained, {"": carried}, self._recordings)[1][""]
            residuals = raw_residuals(self._judge, carried)[self.readings.chosen]
            return Predicted(residuals, residuals, points=(carried,))
        plain = raw_residuals(self._judge, carried)[self.readings.chosen]
        if not self._own:
            return Predicted(plain, plain, points=(carried,))
        found = self._with_day(carried)
        z = found.base[self._own]
        names = [p.name for p in self._judge.parameters]
        whole = departures(self._judge.parameters, found.base)
        moved = {names[i]: whole[names[i]] for i in self._own if names[i] in whole}
        residuals = raw_residuals(self._judge, found)[self.readings.chosen]
        return Predicted(residuals, plain, float(z @ z), moved, (carried,))

    def tested(self, point: Point, predicted: Predicted) -> Tested | None:
        """See `Unfitted`."""
        found = self._freedom(point, predicted)
        return (
            None
            if found is None
            else _tested(self._judge, self.readings, ~set_aside(self.readings, predicted.residuals), *found)
        )

    def strengths(self, point: Point, predicted: Predicted) -> dict[Term, Constancy]:
        """See `Unfitted`."""
        terms = [t for t in point.terms if not t.parameters[0].is_switch and t.recording is None]
        found = self._freedom(point, predicted) if terms else None
        if found is None:
            return {}
        kept, by_terms = ~self.readings.is_wild, columns_by_terms(found[0])
        chosen, channels = self.readings.chosen[kept], self.readings.channels
        return {
            term: constancy(
                *found,
                by_terms,
                term,
                point.terms[term][0],
                lambda p: raw_residuals(self._judge, p)[chosen],
                self.readings.channel[kept],
                self.readings.block[kept],
                _has_zero(channels),
                chosen,
            )
            for term in terms
        }

    def _freedom(self, point: Point, predicted: Predicted) -> tuple[Freedom, Array] | None:
        """How the numbers of a fit may move, and the derivatives of all residuals; None where none can be moved.

        The numbers of the day are part of the move, from where they are written down. Where they were fitted to a first
        stretch they move about what that gave.
        """
        if not can_be_moved(self._judge) or not can_be_moved(self._trained):
            return None
        may = freedom(self._trained.plain, point, self._judge, predicted.points[0])
        if not may.directions.shape[1]:
            return None
        columns = may.columns()
        if self._has_beginning:
            used = np.concatenate([s.used for run in self._judge.runs for s in run.series])
            used[self.readings.chosen] = False
            may = may.after(columns[used])
        return may, columns

    def _with_day(self, point: Point) -> Point:
        """The point with the day's own numbers estimated; see `day_estimated`."""
        if self._columns is None:
            self._columns = np.asarray(self._judge.base_jacobian(point)[:, self._own], dtype=np.float64)
        return day_estimated(self._judge, self._own, point, self._columns)


def with_rows_estimated(judge: DiagnosisModel, point: Point) -> Point:
    """The point with the instants estimated at which inputs changed between two rows of held-out tables.

    Nothing says them, and predictions are judged with them: so they stand in tables too.

    Args:
        judge: Model of the held-out recordings.
        point: Of that model.
    """
    own = [i for i, p in enumerate(judge.parameters) if p.is_within_row and p.own is not None]
    if not own or not judge.can_be_fitted:
        return point
    columns = np.asarray(judge.base_jacobian(point)[:, own], dtype=np.float64)
    return day_estimated(judge, own, point, columns)


def day_estimated(model: DiagnosisModel, own: Sequence[int], point: Point, columns: Array) -> Point:
    """The point with some numbers estimated: Gauss-Newton with their priors and Huber weights.

    Where even then more than noise is left, errors of the model count as those of the sensors do, so that no room is
    moved far to make up for them.

    Args:
        model: Of the recordings to which they belong.
        own: Which parameters.
        point: From where.
        columns: Derivatives of the residuals by them, shape (residuals, numbers).
    """
    base = point.base.copy()
    most = np.minimum(DAY, [model.parameters[i].bounds for i in own])
    scale = np.ones(len(columns))
    for _ in range(STEPS):
        for _ in range(STEPS):
            here = _finite(model.residuals([Point(base, point.terms)])[0])
            weight = huber_weights(here * scale) ** 2 * scale**2
            normal = columns.T @ (weight[:, None] * columns) + np.eye(len(own))
            slope = columns.T @ (weight * here) + base[own]
            moved = np.clip(base[own] - np.linalg.solve(normal, slope), -most, most)
            is_settled = bool(np.max(np.abs(moved - base[own])) < 1e-3)
            base[own] = moved
            if is_settled:
                break
        factor = inflation(_finite(model.residuals([Point(base, point.terms)])[0]), model.layout)
        wanted = 1.0 / np.sqrt(np.where(factor > BELIEVED, factor, 1.0))[np.asarray(model.layout.channel, dtype=int)]
        if np.allclose(wanted, scale, rtol=0.05):
            break
        scale = wanted
    return Point(base, point.terms)


class LeftOutReadings:
    """See `Unfitted`: parts of the training, each predicted by a fit to the rest.

    Args:
        model: Model of the training recordings.
        titles: Of the recordings.
        parts: Which residuals of the model belong to each part, shape (residuals,) each.
        basis: In plain words.
        on_progress: Told what is being done.
    """

    def __init__(
        self,
        model: DiagnosisModel,
        titles: Sequence[str],
        parts: Sequence[AnyArray],
        basis: str,
        on_progress: Callable[[str], None] = lambda text: None,
    ) -> None:
        self._model, self._parts, self.basis = model, parts, basis
        self._inner = model.plain
        self._on_progress = on_progress
        self.readings = readings_of(model.runs, titles)

    def predict(self, point: Point, is_fitted: bool = True) -> Predicted:
        """See `Unfitted`."""
        if not is_fitted:
            residuals = raw_residuals(self._inner, point)[self.readings.chosen]
            return Predicted(residuals, residuals)
        found = np.zeros(len(self._readings_of(self._parts[0])))
        points = []
        for number, part in enumerate(self._parts):
            self._on_progress(f"predicting part {number + 1} of {len(self._parts)} from the others")
            points.append(fit(MaskedModel(self._model, ~part), point, iterations=20).point)
            own = self._readings_of(part)
            found[own] = raw_residuals(self._inner, points[-1])[own]
        residuals = found[self.readings.chosen]
        return Predicted(residuals, residuals, points=tuple(points))

    def _readings_of(self, part: AnyArray) -> AnyArray:
        """Which readings belong to residuals of the search, shape (readings,)."""
        place = self._inner.residual_of_reading
        return part if place is None else np.asarray(part[place])

    def tested(self, point: Point, predicted: Predicted) -> Tested | None:
        """See `Unfitted`; each part by the fit to the others."""
        if not can_be_moved(self._inner) or not predicted.points:
            return None
        sums = []
        for number, (part, other) in enumerate(zip(self._parts, predicted.points)):
            self._on_progress(f"testing part {number + 1} of {len(self._parts)} within the error of the others")
            may = freedom(MaskedModel(self._inner, ~part), other, self._inner, other)
            if not may.directions.shape[1]:
                return None
            kept = part[self.readings.chosen] & ~set_aside(self.readings, predicted.residuals)
            sums.append(_tested(self._inner, self.readings, kept, may, may.columns()))
        return Tested(sum(s.total for s in sums), np.sum([s.channels for s in sums], axis=0))

    def strengths(self, point: Point, predicted: Predicted) -> dict[Term, Constancy]:
        """See `Unfitted`: a stretch of a recording is too short for an estimate of its own."""
        return {}


def left_out_stretches(
    model: DiagnosisModel, titles: Sequence[str], on_progress: Callable[[str], None] = lambda text: None
) -> LeftOutReadings:
    """Stretches of time, one fifth of each recording after the other (blocked cross-validation)."""
    return LeftOutReadings(
        model, titles, blocks(model.layout), "stretches of the training recordings, each left out of a fit", on_progress
    )


def left_out_readings(model: DiagnosisModel, titles: Sequence[str]) -> LeftOutReadings:
    """Every other reading of each channel: for what belongs to one stretch of one day, which no other stretch shows."""
    alternate = np.zeros(len(model.layout.time), dtype=bool)
    for number in range(len(model.layout.names)):
        alternate[np.flatnonzero(model.layout.channel == number)[::2]] = True
    return LeftOutReadings(model, titles, [alternate, ~alternate], "every other reading, left out of a fit")
