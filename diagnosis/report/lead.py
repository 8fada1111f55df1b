"""What stands beside the verdict: the held-out channel that the model met worst, and its error in the user's unit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from diagnosis.judge.diagnosis import ChannelFit, Diagnosis
from diagnosis.report.display import clean, number
from diagnosis.report.figures import STAGE_LOOKS, drawn, labelled, thinned
from diagnosis.report.fits import STAGES
from diagnosis.report.markup import Html, element, image
from diagnosis.report.series import Series
from diagnosis.report.user_units import Units

#: How the last stage that changed something is called.
_LAST = {"recalibrated": "recalibrated", "after": "amended"}


def lead(diagnosis: Diagnosis, series: Sequence[Series]) -> Html:
    """Picture and number; nothing where no channel was judged."""
    found = worst(diagnosis, series)
    if found is None:
        return Html("")
    one, fit = found
    units = Units(diagnosis.units)
    part = "held out" if one.is_held_out else "training: no recording was held out"
    whose = f"{clean(one.channel)}, {clean(one.recording)} ({part})" if one.recording else f"{clean(one.channel)} ({part})"
    figure = drawn(lambda f: _paint(f.subplots(), one, units), 5.2, 2.9)
    return element(
        "aside",
        element("p", element("strong", told(one, fit, units)), class_="number"),
        image(figure, f"{whose}: measured, before and {_LAST.get(_stages(one)[-1], 'before')}"),
        element("p", f"The channel that the model as it was met worst: {whose}.", class_="note"),
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
    return f"{quantity} error {' → '.join(sizes)} {unit}".rstrip() + f" (RMSE), noise of its sensor {noise} {unit}".rstrip()


def _stages(one: Series) -> list[str]:
    """The first stage, and the last one that says something else."""
    own = list(one.curves)
    return [STAGES[0], own[-1]] if len(own) > 1 else [STAGES[0]]


def _paint(axes: Axes, one: Series, units: Units) -> None:
    scaled = units.axis(one.measured, one.unit)
    keep = thinned(one.measured)
    axes.plot(one.times[keep], scaled(one.measured[keep]), ".", ms=3.0, color="#2d3748", label="measured")
    for stage in _stages(one):
        values = one.curves[stage]
        keep = thinned(values)
        axes.plot(one.times[keep], scaled(values[keep]), label=_LAST.get(stage, stage), **{**STAGE_LOOKS[stage], "lw": 1.5})
    axes.set(xlabel="time [s]", ylabel=labelled(clean(one.channel).rpartition(".")[2], scaled.unit))
    axes.margins(x=0.01)
    axes.legend(frameon=False, fontsize=8, ncols=3, loc="lower left", bbox_to_anchor=(0.0, 1.0))
