"""Power, temperature, stiffness and shape of several actuators over time, in one figure."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from chainmail.compare.layout import Layout
from chainmail.compare.measures import coil_series, shape_series, total_power
from cosim.figure_style import figure, mark_switches

#: Colours of the actuators; grey is that of the switches. Dashes let equal curves all be seen.
COLOURS = ("C0", "C1", "C2", "C4", "C5", "C6", "C3", "C8", "C9", "k")
DASHES = ("-", "--", "-.", ":")
#: Quantities whose peaks differ by more than this factor are drawn on a logarithmic axis.
WIDE = 5.0


def draw(path: Path, runs: Mapping[str, xr.Dataset], layout: Layout, title: str = "") -> Path:
    """Draw one line per actuator in every panel that any of them fills; `title` is that of the scenario."""
    panels = [
        (label, found)
        for label, found in (
            ("power [W]", {n: total_power(r, layout) for n, r in runs.items()}),
            (
                "temperature [°C]",
                {n: coil_series(r, f"{layout.actuator}.temperature", layout) for n, r in runs.items()},
            ),
            ("stiffness [N/m]", {n: coil_series(r, f"{layout.actuator}.stiffness", layout) for n, r in runs.items()}),
            *_shapes(runs, layout),
        )
        if any(v is not None for v in found.values())
    ]
    marks = [t for t in (layout.on, layout.off) if t is not None]
    height = 0.9 + 1.7 * len(panels)
    with figure(path, 7.0, height, len(panels), title="Actuators side by side", run=title) as axes:
        for place, (label, found) in zip(axes, panels, strict=True):
            for index, (name, values) in enumerate(found.items()):
                if values is not None:
                    kelvin = 273.15 if label.startswith("temperature") else 0.0
                    colour, dashes = COLOURS[index % len(COLOURS)], DASHES[index % len(DASHES)]
                    place.plot(values["time"], values.values - kelvin, color=colour, ls=dashes, lw=1.2, label=name)
            mark_switches(place, marks)
            place.set_ylabel(label)
            if not label.startswith("temperature"):
                _spread(place, [v for v in found.values() if v is not None])
        axes[-1].set_xlabel("time [s]")
        axes[0].legend(frameon=False, fontsize=8, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return path


def _spread(place: Axes, series: list[xr.DataArray]) -> None:
    """A logarithmic axis where actuators differ by much, linear near zero where a quantity is switched off."""
    peaks = [p for p in (float(np.abs(s).max()) for s in series) if p > 0.0]
    if not peaks or max(peaks) < WIDE * min(peaks):
        return
    if min(float(s.min()) for s in series) > 0.0:
        place.set_yscale("log")
        place.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    else:
        place.set_yscale("symlog", linthresh=min(peaks))
        place.set_ylim(bottom=0.0)
    place.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    place.yaxis.set_minor_formatter(NullFormatter())


def _shapes(runs: Mapping[str, xr.Dataset], layout: Layout) -> list[tuple[str, dict[str, xr.DataArray | None]]]:
    """Curvature [1/cm] of a fabric that bends, else length [mm]."""
    found = {n: shape_series(r, layout) for n, r in runs.items()}
    kinds = {what for values, what in found.values() if values is not None}
    labels = {"curvature": ("max. curvature [1/cm]", 0.01), "length": ("length [mm]", 1000.0)}
    return [
        (
            labels[kind][0],
            {n: None if v is None or what != kind else v * labels[kind][1] for n, (v, what) in found.items()},
        )
        for kind in sorted(kinds)
    ]
