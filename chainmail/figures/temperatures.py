"""Temperatures of the coils over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cosim.figure_style import DEGREES, HOT, figure, label_of, mark_switches


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw the temperature [°C] of each coil, or the range where there are many, and the surroundings."""
    with figure(path, title="Temperatures of the coils", run=label_of(run)) as (axes,):
        celsius = run["actuator.temperature"] - 273.15
        draw_coils(axes, celsius, "coil")
        for name in surroundings(run):
            ambient = run[name] - (273.15 if run[name].attrs["units"] == "K" else 0.0)
            label = name.split(".")[0].replace("$", r"\$").lstrip("_")
            axes.plot(run["time"], ambient, color="0.25", ls=":", zorder=3, label=label)
        mark_switches(axes, marks)
        axes.set_xlabel("time [s]")
        axes.set_ylabel(f"coil temperature [{DEGREES}]")
        axes.legend(frameon=False, fontsize=8)
    return path


def surroundings(run: xr.Dataset) -> list[str]:
    """Temperatures that are no coil's: of the room, of a bath."""
    every = [n for n in map(str, run.data_vars) if n.endswith(".temperature") and not n.startswith("actuator.")]
    return [n for n in every if run[n].dims == ("time",) and run[n].attrs.get("units") in ("K", "degC")]


def draw_coils(axes: Axes, values: xr.DataArray, label: str) -> None:
    """Lines of up to eight different coils; otherwise mean, lowest and highest."""
    # Named after the component where a sensor of another size took the plain name.
    coils = str(values.dims[-1])
    distinct = np.unique(values.values.round(9), axis=1, return_index=True)[1]
    if len(distinct) == 1 and values.sizes[coils] > 1:
        axes.plot(values["time"], values.values[:, 0], color=HOT, label=f"all {values.sizes[coils]} {label}s")
    elif len(distinct) <= 8:
        for index in sorted(distinct):
            axes.plot(values["time"], values.values[:, index], lw=1.1, label=f"{label} {index + 1}")
    else:
        axes.plot(values["time"], values.mean(coils), color=HOT, label=f"mean {label}")
        axes.fill_between(values["time"], values.min(coils), values.max(coils), color=HOT, alpha=0.2, label="range")
