"""How well each channel is met, by recordings that were fitted and by those that were not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import ChannelFit, Difference
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Point
from diagnosis.search.structure import WINDOWS

#: The three models that are compared.
STAGES = ("before", "recalibrated", "after")
#: Root mean square by which two predictions of a channel may differ, in deviations of its noise. It changes the mean
#: square of residuals by at most 0.01 where they are noise, and by a fifth of a standard deviation where they are not.
TOLERANCE = 0.1

#: Stage to what it predicts: recording, channel, samples, SI.
Predictions = Mapping[str, Sequence[Sequence[Array]]]


def carried_over(point: Point, trained: DiagnosisModel, other: DiagnosisModel) -> Point:
    """A fitted point for other recordings: what belongs to a day is known of the days that were fitted alone.

    Parameters are the same by their names (`diagnosis.search.shares`): what all recordings share, and what belongs to a
    day with a name, where both models have recordings of it. Nothing is fitted to held-out recordings; what is theirs
    alone is taken as the scenario has it. Where the two models doubt a number differently, its amount is carried.
    Terms that the other recordings do not have (a fault of one day) are left away.
    """
    known = {p.name: (z, p.deviation) for p, z in zip(trained.parameters, point.base) if p.is_carried}
    found = [(p, *known.get(p.name, (0.0, 1.0))) for p in other.parameters]
    base = np.array([z * (deviation / p.deviation) for p, z, deviation in found])
    wanted = {t.identifier for t in point.terms}  # a rig of 36 coils has thousands of terms
    same = {str(t): t for t in other.terms() if t.identifier in wanted} if wanted else {}
    return Point(base, {same[str(t)]: v for t, v in point.terms.items() if str(t) in same})


def predictions(model: DiagnosisModel, points: Mapping[str, Point]) -> Predictions:
    """What the model itself predicts of each of its recordings."""
    return {stage: [model.predict(point, n) for n in range(len(model.runs))] for stage, point in points.items()}


def channel_fits(
    model: DiagnosisModel,
    recordings: Sequence[Recording],
    points: Mapping[str, Point],
    is_held_out: bool,
    predicted: Predictions | None = None,
) -> list[ChannelFit]:
    """Fit of every channel at several points.

    Args:
        model: Model of these recordings.
        recordings: The same, in order.
        points: Stage to point.
        is_held_out: Whether nothing was fitted to them.
        predicted: What is compared with the readings; None: what the model predicts.
    """
    given = predictions(model, points) if predicted is None else predicted
    found = []
    for number, recording in enumerate(recordings):
        for i, series in enumerate(model.runs[number].series):
            measured = series.channel.values[-len(series.samples) :]
            rmse, chi_square, whiteness = {}, {}, {}
            for stage in points:
                difference = (measured - given[stage][number][i])[series.used]
                scaled = difference / series.channel.deviation
                rmse[stage] = root_mean_square(difference)
                chi_square[stage] = _square(root_mean_square(scaled))
                whiteness[stage] = _largest(scaled)
            found.append(
                ChannelFit(
                    recording.title,
                    is_held_out,
                    series.channel.name,
                    series.channel.unit,
                    rmse,
                    chi_square,
                    whiteness,
                    int(np.count_nonzero(series.used)),
                    is_noise_stated=series.channel.is_deviation_given,
                )
            )
    return found


def differences(
    model: DiagnosisModel, recordings: Sequence[Recording], fast: Predictions, free: Predictions
) -> tuple[Difference, ...]:
    """Channels of which two ways to simulate give predictions that differ by more than `TOLERANCE`, the most first.

    Args:
        model: Model of these recordings.
        recordings: The same, in order.
        fast: What the model predicts.
        free: What free runs of the closed co-simulation give.
    """
    found = []
    for stage, by_recording in free.items():
        for number, recording in enumerate(recordings):
            for i, series in enumerate(model.runs[number].series):
                own, other, used = by_recording[number][i], fast[stage][number][i], series.used
                size = root_mean_square((own - other)[used] / series.channel.deviation)
                if not size <= TOLERANCE:
                    measured = series.channel.values[-len(series.samples) :]
                    scaled = ((measured - other) / series.channel.deviation)[used]
                    chi_square = _square(root_mean_square(scaled))
                    found.append(Difference(recording.title, series.channel.name, stage, size, chi_square))
    return tuple(sorted(found, key=lambda d: -d.size))


def root_mean_square(values: Array) -> float:
    """Square root of the mean square, infinite where a value is; scaled, so that large values have a square too."""
    largest = float(np.max(np.abs(values), initial=0.0))
    if largest == 0.0 or not np.isfinite(largest):
        return largest
    return largest * float(np.sqrt(np.mean((values / largest) ** 2)))


def _square(value: float) -> float:
    return value * value  # ** raises where the square is too large


def _largest(scaled: Array) -> float:
    largest = 0.0
    for window in WINDOWS:
        if len(scaled) >= window:
            sums = np.convolve(scaled, np.ones(window), mode="valid") / np.sqrt(window)
            largest = max(largest, float(np.max(np.abs(sums))))
    return largest
