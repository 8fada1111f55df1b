"""How well each channel is met, by recordings that were fitted and by those that were not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from cosim.unit import Array
from diagnosis.judge.diagnosis import ChannelFit
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Point
from diagnosis.search.structure import WINDOWS
from diagnosis.simulator.models import DiagnosisModel

#: The three models that are compared.
STAGES = ("before", "recalibrated", "after")


def carried_over(point: Point, trained: DiagnosisModel, other: DiagnosisModel) -> Point:
    """A fitted point for other recordings: what belongs to a day (its ambient) is taken as the scenario has it.

    Nothing is fitted to held-out recordings, not even their ambient temperature.
    """
    values = {p.name: z for p, z in zip(trained.parameters, point.base) if " of recording " not in p.name}
    base = np.array([values.get(p.name, 0.0) for p in other.parameters])
    same = {str(t): t for t in other.terms()}
    return Point(base, {same[str(t)]: v for t, v in point.terms.items()})


def channel_fits(
    model: DiagnosisModel, recordings: Sequence[Recording], points: Mapping[str, Point], is_held_out: bool
) -> list[ChannelFit]:
    """Fit of every channel at several points.

    Args:
        model: Model of these recordings.
        recordings: The same, in order.
        points: Stage to point.
        is_held_out: Whether nothing was fitted to them.
    """
    found = []
    for number, recording in enumerate(recordings):
        run = model.runs[number]
        predicted = {stage: model.predict(point, number) for stage, point in points.items()}
        for i, series in enumerate(run.series):
            measured = series.channel.values[-len(series.samples) :]
            rmse, chi_square, whiteness = {}, {}, {}
            for stage in points:
                difference = (measured - predicted[stage][i])[series.used]
                scaled = difference / series.channel.deviation
                rmse[stage] = _root_mean_square(difference)
                chi_square[stage] = _root_mean_square(scaled) ** 2
                whiteness[stage] = _largest(scaled)
            found.append(
                ChannelFit(recording.title, is_held_out, series.channel.name, series.channel.unit, rmse, chi_square,
                           whiteness, int(np.count_nonzero(series.used)))
            )  # fmt: skip
    return found


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


def _largest(scaled: Array) -> float:
    largest = 0.0
    for window in WINDOWS:
        if len(scaled) >= window:
            sums = np.convolve(scaled, np.ones(window), mode="valid") / np.sqrt(window)
            largest = max(largest, float(np.max(np.abs(sums))))
    return largest
