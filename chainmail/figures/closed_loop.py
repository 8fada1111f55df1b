"""What a controller sees, does and achieves over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cosim.figure_style import COLD, DEGREES, HOT, figure, label_of


def controllers(run: xr.Dataset) -> list[str]:
    """Names of the controllers of a run."""
    names = [str(n).rpartition(".")[0] for n in run.data_vars if str(n).endswith(".alarm")]
    return [n for n in names if f"{n}.command" in run]


def draw(path: Path, run: xr.Dataset, controller: str) -> Path:
    """Draw temperature and stiffness of the coils, the command of every string, and alarms of the supervisor.

    Args:
        path: File.
        run: With `controller.command` and `controller.alarm`.
        controller: Name of the component.
    """
    panels = [n for n in ("actuator.temperature", "actuator.stiffness") if n in run]
    title, rows = f"Closed loop of {controller}", len(panels) + 1
    with figure(path, height=1.3 + 1.6 * rows, rows=rows, title=title, run=label_of(run)) as axes:
        for place, name in zip(axes, panels):
            is_warm = name.endswith("temperature")
            _range(place, run[name] - (273.15 if is_warm else 0.0), "coil", HOT)
            place.set_ylabel(f"temperature [{DEGREES}]" if is_warm else "stiffness [N/m]")
        command = run[f"{controller}.command"]
        _range(axes[-1], command, "string", COLD)
        axes[-1].set_ylabel(f"command [{command.attrs.get('units', '')}]")
        alarm = run[f"{controller}.alarm"].values.reshape(run.sizes["time"], -1).max(axis=1)
        time = run["time"].values
        for code, colour, text in ((1, "#e0a800", "limited by the supervisor"), (2, "#d62728", "thermometer failed")):
            is_on = alarm == 1 if code == 1 else alarm >= 2
            if is_on.any():
                axes[-1].fill_between(
                    time,
                    0,
                    1,
                    where=is_on,
                    step="pre",
                    transform=axes[-1].get_xaxis_transform(),
                    color=colour,
                    alpha=0.25,
                    lw=0,
                    label=text,
                )
        axes[-1].set_xlabel("time [s]")
        if axes[-1].get_legend_handles_labels()[1]:
            axes[-1].legend(frameon=False, fontsize=8)
    return path


def _range(axes: Axes, values: xr.DataArray, what: str, colour: str) -> None:
    """One line, or mean and range of many."""
    rows = values.values.reshape(values.sizes["time"], -1)
    time = values["time"].values
    # A command holds over the step that ends at its time.
    axes.plot(
        time,
        rows.mean(axis=1),
        color=colour,
        lw=1.1,
        drawstyle="steps-pre" if what == "string" else "default",
        label=None if rows.shape[1] == 1 else f"mean of {rows.shape[1]} {what}s",
    )
    if np.ptp(rows, axis=1).max() > 0.0:
        axes.fill_between(time, rows.min(axis=1), rows.max(axis=1), color=colour, alpha=0.2, lw=0, label="range")
        axes.legend(frameon=False, fontsize=8)
