"""Stiffness of the coils against temperature, over the two branches of equation (2)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from cosim.figures.style import COLD, HOT, figure
from cosim.paper.laws import COOLING, HEATING


def draw(path: Path, run: xr.Dataset) -> Path:
    """Draw k [N/mm] against T [degC] of every coil whose course differs."""
    with figure(path) as (axes,):
        celsius = run["actuator.temperature"].values - 273.15
        stiffness = run["actuator.stiffness"].values / 1000.0
        grid = np.linspace(min(20.0, celsius.min()), max(75.0, celsius.max()), 300)
        axes.plot(grid, HEATING(grid), color=HOT, ls="--", lw=1, label="equation (2), T rising")
        axes.plot(grid, COOLING(grid), color=COLD, ls="--", lw=1, label="equation (2), T falling")
        distinct = np.unique(celsius.round(9), axis=1, return_index=True)[1]
        for index in sorted(distinct)[:8]:
            axes.plot(celsius[:, index], stiffness[:, index], color="0.1", lw=1.3, alpha=0.8,
                      label="run" if index == min(distinct) else None)  # fmt: skip
        axes.set_xlabel("coil temperature [degC]")
        axes.set_ylabel("stiffness k [N/mm]")
        axes.legend(frameon=False, fontsize=8)
    return path
