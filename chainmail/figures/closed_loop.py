"""What a controller sees, does and achieves over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from chainmail.figures.setpoints import Loop
from cosim.figure_style import COLD, DEGREES, HOT, figure, label_of
from cosim.unit.protocol import Array


def controllers(run: xr.Dataset) -> list[str]:
    """Names of the controllers of a run."""
    names = [str(n).rpartition(".")[0] for n in run.data_vars if str(n).endswith(".alarm")]
    return [n for n in names if f"{n}.command" in run]


def draw(path: Path, run: xr.Dataset, controller: str, loop: Loop | None = None) -> Path:
    """Draw what is measured beside the setpoint, temperature and stiffness of the coils, commands, and alarms.

    Args:
        path: File.
        run: With `controller.command` and `controller.alarm`.
        controller: Name of the component.
        loop: Setpoint and readings; None: they are not drawn.
    """
    is_warm = loop is None or loop.unit == "K"
    coils = ["actuator.temperature"] if "actuator.temperature" in run and is_warm else []
    panels = [*(coils or ["measured"] * (loop is not None)), *(["actuator.stiffness"] * ("actuator.stiffness" in run))]
    title, rows = f"Closed loop of {controller}", len(panels) + 1
    with figure(path, height=1.3 + 1.6 * rows, rows=rows, title=title, run=label_of(run)) as axes:
        for place, name in zip(axes, panels):
            if name == "actuator.stiffness":
                _range(place, run[name], "coil", HOT)
                place.set_ylabel("stiffness [N/m]")
                continue
            zero = 273.15 if is_warm else 0.0
            if name in run:
                _range(place, run[name] - zero, "coil", HOT)
            if loop is not None:
                _loop(place, run["time"].values, loop, zero)
            place.set_ylabel(f"temperature [{DEGREES}]" if is_warm else f"measured [{loop.unit if loop else ''}]")
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


def _loop(axes: Axes, time: Array, loop: Loop, zero: float) -> None:
    """Readings, setpoint and hold: all strings that have the same are one line."""
    if loop.measured is not None:
        axes.plot(time, loop.measured.mean(axis=1) - zero, color="0.35", lw=0.6, label="measured", zorder=1.5)
    if loop.setpoint is not None:
        different = np.unique(loop.setpoint, axis=1) - zero
        label = "setpoint" if different.shape[1] == 1 else f"setpoints of {loop.setpoint.shape[1]} strings"
        lines = axes.plot(time, different, color="black", lw=1.1, ls="--", drawstyle="steps-pre", zorder=3)
        lines[0].set_label(label)
    if loop.hold is not None:
        axes.axhline(loop.hold - zero, color="black", lw=0.9, ls=":", label="hold", zorder=1)
    # Up to five entries: above the axes they cover no line.
    axes.legend(frameon=False, fontsize=8, ncols=5, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.0)


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
        label=("coil" if what == "coil" else None) if rows.shape[1] == 1 else f"mean of {rows.shape[1]} {what}s",
    )
    if np.ptp(rows, axis=1).max() > 0.0:
        axes.fill_between(time, rows.min(axis=1), rows.max(axis=1), color=colour, alpha=0.2, lw=0, label="range")
        axes.legend(frameon=False, fontsize=8)
