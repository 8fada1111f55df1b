"""Every recorded quantity over time: what a system has that is neither a fabric nor a network of coils."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.figure_style import DEGREES, figure, label_of, mark_switches, style_beside
from cosim.unit.protocol import Array

#: Most axes of a figure, and most lines of an axis; more cannot be told apart.
MOST_AXES, MOST_LINES = 8, 10
#: Longest legend that fits beside a line.
_LONGEST = 40


def by_unit(run: xr.Dataset) -> dict[str, dict[str, Array]]:
    """Unit to the lines that have it, name to values over time, in the order in which they are recorded.

    An element of an array counts from 1. Text is left out, and so is what never is a finite number.
    """
    found: dict[str, dict[str, Array]] = {}
    for name, values in run.data_vars.items():
        if values.dims[:1] != ("time",) or values.dtype.kind not in "biuf":
            continue
        unit = str(values.attrs.get("units", "1"))
        celsius = unit == "K"
        flat = values.values.reshape(len(values), -1).astype(np.float64) - (273.15 if celsius else 0.0)
        for number, place in enumerate(np.ndindex(*values.shape[1:])):
            index = f"[{','.join(str(i + 1) for i in place)}]" if place else ""
            if np.isfinite(flat[:, number]).any():
                found.setdefault(DEGREES if celsius else unit, {})[f"{name}{index}"] = flat[:, number]
    return found


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw an axis for each unit; what is left out of a large system is said above."""
    groups = by_unit(run)
    shown = dict(list(groups.items())[:MOST_AXES])
    title = f"Recorded quantities{_left_out(groups, shown)}"
    with figure(
        path, width=8.5, height=0.8 + 1.6 * len(shown), rows=len(shown), title=title, run=label_of(run)
    ) as places:
        for axes, (unit, lines) in zip(places, shown.items(), strict=True):
            drawn: list[Array] = []
            for name, values in list(lines.items())[:MOST_LINES]:
                label = name if len(name) <= _LONGEST else f"{name[: _LONGEST - 4]} ..."
                style = style_beside(values, drawn)
                axes.plot(run["time"], values, lw=1.1, ls=style, label=label.replace("$", r"\$").lstrip("_"))
                drawn.append(values)
            axes.set_ylabel("[1]" if unit == "1" else f"[{unit}]".replace("$", r"\$"))
            mark_switches(axes, marks)
            axes.legend(
                frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5)
            )  # beside, not over lines
        places[-1].set_xlabel("time [s]")
    return path


def _left_out(groups: Mapping[str, Mapping[str, Array]], shown: Mapping[str, Mapping[str, Array]]) -> str:
    every = sum(len(lines) for lines in groups.values())
    drawn = sum(min(len(lines), MOST_LINES) for lines in shown.values())
    return f", {drawn} of {every} (all of them: results.nc)" if drawn < every else ""
