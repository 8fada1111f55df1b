"""Currents and power over time."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from chainmail.figures.temperatures import draw_coils
from cosim.figure_style import below, figure, label_of, mark_switches

#: Lines of the supply: dark grey, which no coil has.
SUPPLY = "0.25"


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw coil currents [mA], supply current [A] and supply power [W], an axis each."""
    with figure(path, height=6.0, rows=3, title="Currents and power", run=label_of(run)) as (coils, supply, power):
        draw_coils(coils, 1000.0 * run["circuit.current"], "coil")
        coils.set_ylabel("coil current [mA]")
        supply.plot(run["time"], run["circuit.supply_current"], color=SUPPLY)
        supply.set_ylabel("supply current [A]")
        power.plot(run["time"], run["circuit.supply_power"], color=SUPPLY)
        power.set_ylabel("supply power [W]")
        for axes in (coils, supply, power):
            mark_switches(axes, marks)
        below((coils, supply, power))
        for axes in (supply, power):  # one line each, named by the axis
            legend = axes.get_legend()
            if legend is not None:
                legend.remove()
    return path
