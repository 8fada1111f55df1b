"""Stiffness of the coils against temperature, over the two branches of equation (2)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from chainmail.equations import COOLING, HEATING
from cosim.figure_style import COLD, DEGREES, HOT, figure, label_of


def draw(path: Path, run: xr.Dataset) -> Path:
    """Draw k [N/mm] against T [°C] of every coil whose course differs."""
    with figure(path, title="Stiffness over temperature", run=label_of(run)) as (axes,):
        celsius = run["actuator.temperature"].values - 273.15
        stiffness = run["actuator.stiffness"].values / 1000.0
        grid = np.linspace(min(20.0, celsius.min()), max(75.0, celsius.max()), 300)
        # Dashed on top: the run lies on the equation where it is right, and would hide it.
        axes.plot(grid, HEATING(grid), color=HOT, ls=(0, (4, 3)), lw=1.2, zorder=4, label="equation (2), T rising")
        axes.plot(grid, COOLING(grid), color=COLD, ls=(0, (4, 3)), lw=1.2, zorder=4, label="equation (2), T falling")
        distinct = np.unique(celsius.round(9), axis=1, return_index=True)[1]
        for index in sorted(distinct)[:8]:
            axes.plot(
                celsius[:, index],
                stiffness[:, index],
                color="0.65",
                lw=2.6,
                label="run" if index == min(distinct) else None,
            )
        axes.set_xlabel(f"coil temperature [{DEGREES}]")
        axes.set_ylabel("stiffness k [N/mm]")
        axes.legend(frameon=False, fontsize=8)
    return path
