"""One look for all figures."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")  # figures are written to files; no display is needed
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosim.unit.protocol import Array

#: Colours of Figure 3 of the paper, and of cold, hot and re-cooled.
WITH_MODEL, WITHOUT_MODEL = "#1f4fd8", "#c218b8"
COLD, HOT, RECOOLED = "#2b6cb0", "#c53030", "#2f855a"
#: Instants at which the supply switches: grey, which no coil and no run has.
SWITCH = "0.55"
#: Formats in which figures are written.
FORMATS = ("png", "svg", "pdf")
#: Window of the mean that is drawn over a noisy line [s].
WINDOW = 0.2
DEGREES = "°C"


@contextmanager
def figure(
    path: Path, width: float = 6.4, height: float = 3.8, rows: int = 1, title: str = "", run: str = ""
) -> Iterator[list[Axes]]:
    """Axes of a new figure that is saved at the end.

    Args:
        path: The file; its ending is the format.
        width: [inch].
        height: [inch].
        rows: Axes, one above the other, with one axis of time.
        title: What it shows, above.
        run: Which run it shows, small below the title.
    """
    look: dict[Any, Any] = {
        "font.size": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "figure.dpi": 150,
        "svg.hashsalt": "figure",
        "svg.fonttype": "path",
    }
    with plt.rc_context(look):
        drawn: Figure
        drawn, axes = plt.subplots(rows, 1, figsize=(width, height), sharex=True, squeeze=False, layout="constrained")
        if title:
            drawn.suptitle(_heading(title, run, width), x=0.01, ha="left", fontsize=9, linespacing=1.3)
        try:
            yield list(axes[:, 0])
            dated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(path.suffix[1:])
            drawn.savefig(path, metadata=dated)
        finally:
            plt.close(drawn)


def _heading(title: str, run: str, width: float) -> str:
    """Title and run; a long name of a run takes a second line."""
    lines = textwrap.wrap(run, width=round(16 * width), max_lines=2, placeholder=" ...") if run else []
    return "\n".join(with_degrees(text.replace("$", r"\$")) for text in (title, *lines))


def with_degrees(text: str) -> str:
    """A text or a unit as a figure shows it: degC by its sign."""
    return text.replace("degC", DEGREES)


def style_beside(values: Array, drawn: Sequence[Array]) -> str:
    """Style of a line: dashed where it lies on one that is drawn already, so that both are seen.

    Args:
        values: Of the line, shape (points,).
        drawn: Of the lines before it on these axes.
    """
    is_covered = any(np.allclose(values, other, rtol=1e-9, atol=0.0, equal_nan=True) for other in drawn)
    return "--" if is_covered else "-"


def label_of(run: xr.Dataset) -> str:
    """Title of a run."""
    return str(run.attrs.get("title", ""))


def mark_switches(axes: Axes, moments: list[float]) -> None:
    """Grey vertical lines where the supply switches."""
    for index, moment in enumerate(moments):
        axes.axvline(
            moment, color=SWITCH, lw=1, ls=(0, (5, 2)), zorder=0.5, label="supply switched" if index == 0 else None
        )


def smoothed(times: Array, values: Array, window: float = WINDOW) -> Array:
    """Mean over a window of time around each sample, over what there is of it at the ends.

    Args:
        times: Evenly spaced [s], shape (n,).
        values: Shape (n,).
        window: [s].
    """
    if len(times) < 3:
        return values
    half = round(0.5 * window / float(times[1] - times[0]))
    sums = np.concatenate([[0.0], np.cumsum(values)])
    first = np.maximum(np.arange(len(values)) - half, 0)
    last = np.minimum(np.arange(len(values)) + half + 1, len(values))
    return np.asarray((sums[last] - sums[first]) / (last - first))


def draw_noisy(axes: Axes, times: Array, values: Array, colour: str, label: str) -> None:
    """A thin pale line as it is, for links that touch and part make noise, and its mean over 0.2 s on top."""
    mean = smoothed(times, values)
    axes.plot(times, values, color=colour, lw=0.5, alpha=0.35)
    axes.plot(times, mean, color=colour, lw=1.4, label=label)


def below(axes: Sequence[Axes]) -> None:
    """A legend for each of some axes that has labels, and the axis of time below the last."""
    axes[-1].set_xlabel("time [s]")
    for one in axes:
        if one.get_legend_handles_labels()[0]:
            one.legend(fontsize=8, facecolor="white", edgecolor="none", framealpha=0.85)
