"""Figure 3 of the paper: maximum curvature over time, with and without the heating model."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from cosim.figures.style import WITH_MODEL, WITHOUT_MODEL, figure, mark_switches
from cosim.paper.measures import band


def draw(path: Path, runs: Sequence[xr.Dataset], marks: list[float]) -> Path:
    """Draw `fabric.max_curvature` [1/cm] of each run from t = 0 (or from its start) on."""
    with figure(path) as (axes,):
        for run, colour in zip(runs, (WITH_MODEL, WITHOUT_MODEL, "0.3", "0.6"), strict=False):
            begin = 0.0 if marks and marks[0] > 0.0 else float(run["time"][0])
            shown = run["fabric.max_curvature"].sel(time=slice(begin, None)) / 100.0
            label = str(run.attrs["title"]).split(" (")[0]
            if "start" in shown.dims:
                low, shown, high = band(shown)
                axes.fill_between(shown["time"], low, high, color=colour, alpha=0.2, lw=0)
                label += f": median and 5 to 95 % of {run.sizes['start']} starts"
            axes.plot(shown["time"], shown, color=colour, lw=1.2, label=label)
        mark_switches(axes, marks)
        axes.set_xlabel("time [s]")
        axes.set_ylabel(r"maximum curvature $\kappa_{max}$ [1/cm]")
        axes.set_ylim(bottom=0.0)
        axes.legend(frameon=False, fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return path
