"""What a held-out recording does not know itself, estimated from its first stretch, which then does not judge.

The angle at which somebody lets an arm go belongs to the day and not to the model. Where a recording says so
(`uncertain`) and gives a first stretch for it (`beginning`), these numbers alone are fitted, to that stretch alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit import AnyArray, Array
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, Term
from diagnosis.simulator.masked import MaskedModel
from diagnosis.simulator.models import DiagnosisModel, RecordedRun
from diagnosis.simulator.wrapped import WrappedModel


@dataclass(frozen=True)
class _Series:
    """See `diagnosis.simulator.models.Series`."""

    channel: Channel
    samples: AnyArray
    used: AnyArray


@dataclass(frozen=True)
class _Run:
    """See `diagnosis.simulator.models.RecordedRun`."""

    series: tuple[_Series, ...]


class BegunModel(WrappedModel):
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


class _OwnNumbers(WrappedModel):
    """A model of which only some parameters are free; everything else, terms too, stays as it is."""

    def __init__(self, inner: DiagnosisModel, point: Point, own: Sequence[int]) -> None:
        super().__init__(inner)
        self._point, self._own = point, list(own)
        self.parameters = [inner.parameters[i] for i in own]

    def inside(self, point: Point) -> Point:
        base = self._point.base.copy()
        base[self._own] = point.base
        return Point(base, self._point.terms)

    def base_jacobian(self, point: Point) -> Array:
        return np.asarray(super().base_jacobian(point)[:, self._own])

    def terms(self) -> list[Term]:
        return []


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
    known = {p.name for p in trained.parameters}
    own = [i for i, p in enumerate(judge.parameters) if p.name not in known or " of recording " in p.name]
    first = np.concatenate(
        [
            s.channel.times[-len(s.samples) :] < s.channel.times[0] + r.beginning
            for run, r in zip(judge.runs, recordings)
            for s in run.series
        ]
    )
    found = {}
    for stage, point in points.items():
        free = _OwnNumbers(MaskedModel(judge, first), point, own)
        values = fit(free, Point(point.base[own]), iterations=30).point.base
        base = point.base.copy()
        base[own] = values
        found[stage] = Point(base, point.terms)
    return BegunModel(judge, recordings), found


def _begun(run: RecordedRun, length: float) -> _Run:
    series = []
    for s in run.series:
        times = s.channel.times[-len(s.samples) :]
        series.append(_Series(s.channel, s.samples, np.asarray(s.used & (times >= s.channel.times[0] + length))))
    return _Run(tuple(series))
