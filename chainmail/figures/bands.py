"""Median and band of an ensemble over time."""

from __future__ import annotations

import xarray as xr
from matplotlib.axes import Axes

from chainmail.measures import band


def draw_band(axes: Axes, values: xr.DataArray, colour: str, label: str, style: str = "-") -> None:
    """The median over the starts of an ensemble, and the band from 5 to 95 %; neither is smoothed.

    Args:
        axes: Where to draw.
        values: Dimensions `time`, `start`.
        colour: Of both.
        label: Of the median.
        style: Of its line.
    """
    low, middle, high = band(values)
    axes.fill_between(values["time"], low, high, color=colour, alpha=0.2, lw=0)
    axes.plot(values["time"], middle, color=colour, lw=1.4, ls=style, label=label)
