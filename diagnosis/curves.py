"""Curves of the channels that a report draws: those in which findings show most, and those that are met worst."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnosis.diagnose import Result
from diagnosis.judge.diagnosis import ChannelFit, Diagnosis
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.report.fits import is_channel, plain_channel
from diagnosis.report.series import Series
from diagnosis.search.problem import Point

#: Channels drawn, of those fitted and of those held out.
DRAWN = 3


def curves(found: Result) -> list[Series]:
    """Channels held out, then channels that were fitted."""
    names = _names(found.diagnosis)
    drawn = [] if found.judge is None else _part(found, found.judge, found.held_out_points, True, names)
    return drawn + _part(found, found.training, found.points, False, names)


def _names(diagnosis: Diagnosis) -> list[str]:
    """Channels drawn in both parts, so that training and held out stand side by side."""
    parts = [[f for f in diagnosis.fit if f.is_held_out is part] for part in (True, False)]
    chosen = [[fits[i].channel for i in drawn_channels(diagnosis, fits)] for fits in parts]
    return list(dict.fromkeys(name for names in chosen for name in names))


def drawn_channels(diagnosis: Diagnosis, fits: Sequence[ChannelFit]) -> list[int]:
    """Numbers of the channels to draw: for each finding the one that shows it most, what is left, what is met worst."""
    worst = sorted(range(len(fits)), key=lambda i: -fits[i].chi_square["recalibrated"])
    telling = []
    left = [(one.channel,) for one in diagnosis.left[:1]]
    for channels in (*(f.channels for f in diagnosis.findings), *left):
        best = [i for shown in channels for i in worst if is_channel(shown, fits[i].channel, fits[i].recording)]
        alike = [i for shown in channels for i in worst if fits[i].channel == plain_channel(shown)]
        telling += (best or alike)[:1]
    return list(dict.fromkeys([*telling, *worst]))[:DRAWN]


def _part(
    found: Result, model: DiagnosisModel, points: Mapping[str, Point], is_held_out: bool, names: Sequence[str]
) -> list[Series]:
    fits = [f for f in found.diagnosis.fit if f.is_held_out is is_held_out]
    place = [(run, number) for run in range(len(model.runs)) for number in range(len(model.runs[run].series))]
    drawn = []
    own = drawn_channels(found.diagnosis, fits)
    worst = sorted(range(len(fits)), key=lambda i: -fits[i].chi_square["recalibrated"])
    shown = {fits[i].channel for i in own}
    partners = [next((i for i in worst if fits[i].channel == name), None) for name in names if name not in shown]
    for i in [*own, *(i for i in partners if i is not None)]:
        run, number = place[i]
        series = model.runs[run].series[number]
        count = len(series.samples)
        values = {stage: model.predict(point, run)[number] for stage, point in points.items()}
        drawn.append(
            Series(
                channel=series.channel.name,
                unit=series.channel.unit,
                times=series.channel.times[-count:],
                measured=np.where(series.used, series.channel.values[-count:], np.nan),
                before=values["before"],
                recalibrated=values["recalibrated"],
                after=values["after"],
                deviation=series.channel.deviation,
                recording=fits[i].recording,
                is_held_out=is_held_out,
            )
        )
    return drawn
