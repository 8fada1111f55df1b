"""What a held-out recording does not know itself, estimated from its first stretch, which then does not judge.

The angle at which somebody lets an arm go belongs to the day and not to the model. Where a recording says so
(`uncertain`) and gives a first stretch for it (`beginning`), these numbers alone are fitted, to that stretch alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnosis.judge.recording_parameters import OwnNumbers, recording_parameters
from diagnosis.models.protocol import ComparedRun, ComparedSeries, DiagnosisModel, RecordedRun, compared_run
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.recording.recording import Recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point


class InitialStateModel(WrappedModel):
    """A model of held-out recordings whose first stretches do not judge.

    Args:
        inner: The model that simulates.
        recordings: The recordings, in order.
    """

    def __init__(self, inner: DiagnosisModel, recordings: Sequence[Recording]) -> None:
        super().__init__(inner)
        self._runs = [_begun(run, r.beginning) for run, r in zip(inner.runs, recordings)]

    @property
    def runs(self) -> Sequence[RecordedRun]:
        """One for each recording, in order."""
        return self._runs


def begun(
    judge: DiagnosisModel, trained: DiagnosisModel, points: Mapping[str, Point], recordings: Sequence[Recording]
) -> tuple[DiagnosisModel, dict[str, Point]]:
    """Points with what belongs to held-out recordings alone estimated from their first stretches.

    Args:
        judge: Model of the held-out recordings.
        trained: Model that was fitted; what it has too is left as it was fitted.
        points: Stage to point of the judge.
        recordings: Held-out recordings.

    Returns:
        The model that judges with what is left of the recordings, and its points; both as given where no recording has
        a first stretch.
    """
    if not any(r.beginning > 0 for r in recordings):
        return judge, dict(points)
    own = recording_parameters(judge, trained)
    first = np.concatenate(
        [
            s.channel.times[-len(s.samples) :] < s.channel.times[0] + r.beginning
            for run, r in zip(judge.runs, recordings)
            for s in run.series
        ]
    )
    found = {}
    for stage, point in points.items():
        free = OwnNumbers(MaskedModel(judge, first), point, own)
        values = fit(free, Point(point.base[own]), iterations=30).point.base
        base = point.base.copy()
        base[own] = values
        found[stage] = Point(base, point.terms)
    return InitialStateModel(judge, recordings), found


def _begun(run: RecordedRun, length: float) -> ComparedRun:
    series = []
    for s in run.series:
        times = s.channel.times[-len(s.samples) :]
        series.append(ComparedSeries(s.channel, s.samples, np.asarray(s.used & (times >= s.channel.times[0] + length))))
    return compared_run(series, run.shares)
