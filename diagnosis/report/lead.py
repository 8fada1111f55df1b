"""What stands beside the verdict: the held-out channel that the model met worst, and its error in the user's unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from diagnosis.judge.diagnosis import ChannelFit, Diagnosis
from diagnosis.report.display import clean, number
from diagnosis.report.figures import STAGE_LOOKS, drawn, labelled, thinned, with_clock
from diagnosis.report.fits import STAGES
from diagnosis.report.series import Series
from diagnosis.report.user_units import Units, units_of

#: How the last stage that changed something is called.
_LAST = {"recalibrated": "recalibrated", "after": "amended"}


@dataclass(frozen=True)
class Lead:
    """What stands beside the verdict.

    Args:
        told: The number.
        whose: Channel and recording.
        picture: Data address.
        about: The picture in words.
    """

    told: str
    whose: str
    picture: str
    about: str


def lead(diagnosis: Diagnosis, series: Sequence[Series]) -> Lead | None:
    """Picture and number; None where no channel was judged."""
    found = worst(diagnosis, series)
    if found is None:
        return None
    one, fit = found
    units = units_of(diagnosis).of(one.channel)
    part = "held out" if one.is_held_out else "training: no recording was held out"
    whose = (
        f"{clean(one.channel)}, {clean(one.recording)} ({part})" if one.recording else f"{clean(one.channel)} ({part})"
    )
    return Lead(
        told(one, fit, units),
        whose,
        drawn(lambda f: _paint(f, one, units), 5.2, 3.6),
        f"{whose}: measured, before and {_LAST.get(_stages(one)[-1], 'before')}",
    )


def worst(diagnosis: Diagnosis, series: Sequence[Series]) -> tuple[Series, ChannelFit] | None:
    """The drawn channel with the largest chi-square of the model as it was; of held-out recordings where there are."""
    fits = {(f.channel, f.recording, f.is_held_out): f for f in diagnosis.fit}
    pairs = [(s, fits[key]) for s in series if (key := (s.channel, s.recording, s.is_held_out)) in fits]
    judged = [pair for pair in pairs if pair[0].is_held_out] or pairs
    known = [pair for pair in judged if np.isfinite(pair[1].chi_square.get("before", np.nan))]
    return max(known, key=lambda pair: pair[1].chi_square["before"], default=None)


def told(one: Series, fit: ChannelFit, units: Units) -> str:
    """`current error 9.88 -> 1.98 mA (RMSE), noise of its sensor 2.00 mA`."""
    factor, unit = units.difference(one.unit)
    sizes = [number(factor * fit.rmse[stage]) for stage in _stages(one)]
    noise = number(factor * float(np.sqrt(np.nanmean(np.square(one.deviation)))))
    quantity = clean(one.channel).rpartition(".")[2].replace("_", " ")
    source = "stated" if fit.is_noise_stated else "estimated from neighbouring readings"
    return (
        f"{quantity} error {' → '.join(sizes)} {unit}".rstrip()
        + f" (RMSE), noise of its sensor {noise} {unit}".rstrip()
        + f" ({source})"
    )


def _stages(one: Series) -> list[str]:
    """The first stage, and the last one that says something else."""
    own = list(one.curves)
    return [STAGES[0], own[-1]] if len(own) > 1 else [STAGES[0]]


def _paint(figure: Figure, one: Series, units: Units) -> None:
    """Above what was measured and what the models say, below measured minus simulated with the noise of the sensor."""
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 2.0))
    scaled = units.axis(one.measured, one.unit)
    factor, unit = units.difference(one.unit)
    keep = thinned(one.measured)
    upper.plot(one.times[keep], scaled(one.measured[keep]), ".", ms=2.5, color="#2d3748", label="measured")
    noise = 2.0 * factor * float(np.sqrt(np.nanmean(np.square(one.deviation))))
    lower.axhspan(-noise, noise, color="#cbd5e0", lw=0, label="2 deviations of the sensor")
    for stage in _stages(one):
        values, look = one.curves[stage], {**STAGE_LOOKS[stage], "lw": 1.4}
        keep = thinned(values)
        upper.plot(one.times[keep], scaled(values[keep]), label=_LAST.get(stage, stage), **look)
        rest = factor * (one.measured - values)
        keep = thinned(rest)
        lower.plot(one.times[keep], rest[keep], **{**look, "lw": 1.0})
    upper.set_ylabel(labelled(clean(one.channel).rpartition(".")[2], scaled.unit))
    lower.set_ylabel(labelled("residual", unit))
    lower.margins(x=0.01)
    with_clock(lower, units, float(one.times[-1]))
    figure.legend(loc="outside upper left", frameon=False, ncols=2, fontsize=8)
