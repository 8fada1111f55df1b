"""Maximum curvature over time; of the paper's prototype that is its Figure 3."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from chainmail.figures.bands import draw_band
from chainmail.measures import band, half_way_delay, plateau
from cosim.figure_style import (
    SWITCH,
    WITH_MODEL,
    WITHOUT_MODEL,
    draw_noisy,
    figure,
    label_of,
    mark_switches,
    with_degrees,
)

#: How the titles of the paper's runs end.
PAPER = "(paper, Figure 3)"
#: Seconds before a switch, or before the end, over which a level is read.
_LEVEL = 1.0


def draw(path: Path, runs: Sequence[xr.Dataset], marks: list[float]) -> Path:
    """Draw `fabric.max_curvature` [1/cm] of each run from t = 0 (or from its start) on.

    Thin: as simulated. Thick: its mean over 0.2 s. Of an ensemble: the median as it is, and the band over the starts.
    Of the paper's own experiment what its text states is marked. Where there are as many ensembles as single runs, the
    first of either have one colour, and so on: they are the same experiments.
    """
    is_paper = label_of(runs[0]).endswith(PAPER)
    title = "Maximum curvature" + (" (Figure 3 of the paper; words: its section 3)" if is_paper else "")
    named = label_of(runs[0]) if len(runs) == 1 else ""
    with figure(path, height=4.2, title=title, run=named) as (axes,):
        colours = _colours(runs)
        shown_labels: list[str] = []
        for run, colour in zip(runs, colours, strict=False):
            begin = 0.0 if marks and marks[0] > 0.0 else float(run["time"][0])
            shown = run["fabric.max_curvature"].sel(time=slice(begin, None)) / 100.0
            label = _shortened(with_degrees(label_of(run).split(" (")[0]), shown_labels)
            if "start" in shown.dims:
                label += f": median and 5 to 95 % of {run.sizes['start']} starts"
                draw_band(axes, shown, colour, label, "--" if colours.count(colour) > 1 else "-")
            else:
                draw_noisy(axes, shown["time"].values, shown.values, colour, label)
        mark_switches(axes, marks)
        axes.set_xlabel("time [s]")
        axes.set_ylabel(r"maximum curvature $\kappa_{max}$ [1/cm]")
        axes.set_ylim(bottom=0.0)
        if is_paper and len(marks) == 2:
            _mark_text(axes, runs[0], marks)
        axes.legend(frameon=False, fontsize=8, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=1)
    return path


def _shortened(label: str, before: list[str]) -> str:
    """`the same, ...` where a label goes on from one that was shown; that one is noted otherwise."""
    for known in before:
        if label.startswith(known) and label != known:
            return "the same" + label.removeprefix(known)
    before.append(label)
    return label


def _colours(runs: Sequence[xr.Dataset]) -> list[str]:
    colours = [WITH_MODEL, WITHOUT_MODEL, "0.3", "0.6"]
    is_ensemble = ["start" in run.dims for run in runs]
    if 2 * sum(is_ensemble) != len(runs) or len(runs) > 2 * len(colours):
        return colours
    singles, ensembles = iter(colours), iter(colours)
    return [next(ensembles if is_one else singles) for is_one in is_ensemble]


def _mark_text(axes: Axes, run: xr.Dataset, marks: list[float]) -> None:
    """What section 3 of the paper says in words, at the place of this run where it shows."""
    on, off = marks
    series = run["fabric.max_curvature"] / 100.0
    if "start" in series.dims:
        series = band(series)[1]
    end = float(run["time"][-1])
    levels = [plateau(series, t - _LEVEL, t) for t in (on, off, end)]
    top = float(axes.get_ylim()[1])
    delays = (
        half_way_delay(series.sel(time=slice(None, off)), on, *levels[:2]),
        half_way_delay(series, off, *levels[1:]),
    )
    for begin, delay, height in zip(marks, delays, (0.97, 0.97)):
        if np.isfinite(delay):
            _span(axes, begin, begin + delay, height * top, "delay")
    kept: dict[str, Any] = {
        "arrowprops": {"arrowstyle": "-", "color": SWITCH, "lw": 0.7},
        "fontsize": 8,
        "color": "0.25",
    }
    axes.annotate("full rigidity", (off - 1.0, levels[1]), (off + 1.5, levels[1] + 0.3 * top), **kept)
    axes.annotate(
        "flexibility regained,\nsmall residual", (end - 2.0, levels[2]), (end - 9.5, levels[2] - 0.4 * top), **kept
    )
    axes.text(on, 0.01 * top, " on", fontsize=8, color="0.4")
    axes.text(off, 0.01 * top, " off", fontsize=8, color="0.4")


def _span(axes: Axes, begin: float, end: float, height: float, text: str) -> None:
    axes.annotate("", (begin, height), (end, height), arrowprops={"arrowstyle": "<->", "color": "0.25", "lw": 0.8})
    axes.text(end, height, f" {text}", va="center", fontsize=8, color="0.25")
