"""Length of the fabric and of its links over time."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from chainmail.figures.bands import draw_band
from cosim.figure_style import draw_noisy, figure, label_of, mark_switches


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw fabric length [cm] and mean and range of the link length l [cm]."""
    with figure(path, height=5.0, rows=2, title="Lengths", run=label_of(run)) as (fabric, link):
        times = run["time"].values
        length = 100 * run["fabric.fabric_length"]
        if "start" in length.dims:
            draw_band(fabric, length, "C0", f"median and 5 to 95 % of {run.sizes['start']} starts")
            fabric.legend(frameon=False, fontsize=8)
        else:
            draw_noisy(fabric, times, length.values, "C0", "")
        fabric.set_ylabel("fabric length [cm]")
        mark_switches(fabric, marks)
        lengths = 100 * run["fabric.link_length"]
        every = [d for d in lengths.dims if d != "time"]  # links, of all starts where there are several
        of = "" if "start" not in every else f" in {run.sizes['start']} starts"
        draw_noisy(link, times, lengths.mean(every).values, "C0", f"mean of the links{of}")
        link.fill_between(times, lengths.min(every), lengths.max(every), color="C0", alpha=0.2, label="range")
        mark_switches(link, marks)
        link.set_xlabel("time [s]")
        link.set_ylabel("link length l [cm]")
        link.legend(frameon=False, fontsize=8)
    return path
