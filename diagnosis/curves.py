"""Curves of the channels that a report draws: those that the recalibrated model meets worst."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from diagnosis.diagnose import Found
from diagnosis.report.series import Series
from diagnosis.search.problem import Point
from diagnosis.simulator.models import DiagnosisModel

#: Channels drawn, of those fitted and of those held out.
DRAWN = 3


def curves(found: Found) -> list[Series]:
    """The worst channels held out, then the worst that were fitted."""
    drawn = [] if found.judge is None else _worst(found, found.judge, found.held_out_points, True)
    return drawn + _worst(found, found.training, found.points, False)


def _worst(found: Found, model: DiagnosisModel, points: Mapping[str, Point], is_held_out: bool) -> list[Series]:
    fits = [f for f in found.diagnosis.fit if f.is_held_out is is_held_out]
    order = sorted(range(len(fits)), key=lambda i: -fits[i].chi_square["recalibrated"])[:DRAWN]
    place = [(run, number) for run in range(len(model.runs)) for number in range(len(model.runs[run].series))]
    drawn = []
    for i in order:
        run, number = place[i]
        series = model.runs[run].series[number]
        count = len(series.samples)
        values = {stage: model.predict(point, run)[number] for stage, point in points.items()}
        drawn.append(
            Series(
                channel=series.channel.name, unit=series.channel.unit, times=series.channel.times[-count:],
                measured=np.where(series.used, series.channel.values[-count:], np.nan), before=values["before"],
                recalibrated=values["recalibrated"], after=values["after"], deviation=series.channel.deviation,
                recording=fits[i].recording, is_held_out=is_held_out,
            )
        )  # fmt: skip
    return drawn
