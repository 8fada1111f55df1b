"""Length of the fabric and of its links over time."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from cosim.figures.style import draw_noisy, figure, label_of, mark_switches


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw fabric length [cm] and mean and range of the link length l [cm]."""
    with figure(path, height=5.0, rows=2, title="Lengths", run=label_of(run)) as (fabric, link):
        times = run["time"].values
        draw_noisy(fabric, times, 100 * run["fabric.fabric_length"].values, "C0", "")
        fabric.set_ylabel("fabric length [cm]")
        mark_switches(fabric, marks)
        lengths = 100 * run["fabric.link_length"]
        draw_noisy(link, times, lengths.mean("link").values, "C0", "mean of the links")
        link.fill_between(run["time"], lengths.min("link"), lengths.max("link"), color="C0", alpha=0.2, label="range")
        mark_switches(link, marks)
        link.set_xlabel("time [s]")
        link.set_ylabel("link length l [cm]")
        link.legend(frameon=False, fontsize=8)
    return path
