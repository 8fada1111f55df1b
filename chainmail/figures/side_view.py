"""Side view of the fabric: before its supply is switched, at the end of being driven, and at the end."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cosim.figure_style import COLD, HOT, RECOOLED, figure, label_of


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw the links in the plane of gravity, from their markers, at up to three moments."""
    positive = [m for m in marks if m >= 0.0]
    end = float(run["time"][-1])
    moments = [(positive[0] if positive else end, COLD)]
    if positive:
        moments.append((positive[1] if len(positive) > 1 else end, HOT))
    if len(positive) > 1:
        moments.append((end, RECOOLED))
    with figure(path, width=6.4, height=4.0, title="Side view", run=label_of(run)) as (axes,):
        for moment, colour in moments:
            now = run.sel(time=moment, method="nearest")
            _outline(
                axes,
                now["fabric.marker_position"].values,
                now["fabric.row_centre"].values,
                colour,
                _label(now),
            )
        axes.set_aspect("equal")
        if "start" in run.coords:
            label = f"start {int(run['start'])}, the nearest to the median"
            axes.annotate(label, (0.01, 0.01), xycoords="axes fraction", fontsize=7, color="0.4")
        axes.set_xlabel("y, away from the tether [cm]")
        axes.set_ylabel("z, up [cm]")
        axes.legend(frameon=False, fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    return path


def _label(now: xr.Dataset) -> str:
    """Instant and voltage of the one supply; how warm the coils are by then stands in the figure of temperatures."""
    voltage = now.get("supply.voltage")
    driven = f", {float(voltage):g} V" if voltage is not None and voltage.ndim == 0 else ""
    return f"t = {float(now['time']):.2f} s{driven}"


def _outline(axes: Axes, markers: np.ndarray, centres: np.ndarray, colour: str, label: str) -> None:
    """Every link from marker to marker, and the line of row centres."""
    pairs = 100.0 * markers.reshape(-1, 2, 3)
    for pair in pairs:
        axes.plot(pair[:, 1], pair[:, 2], color=colour, lw=4, alpha=0.45, solid_capstyle="round")
    axes.plot(100 * centres[:, 1], 100 * centres[:, 2], color=colour, lw=1.2, marker="o", ms=3, label=label)
