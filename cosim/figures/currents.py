"""Currents and power over time."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from cosim.figures.style import figure, mark_switches
from cosim.figures.temperatures import draw_coils


def draw(path: Path, run: xr.Dataset, marks: list[float]) -> Path:
    """Draw coil currents [mA] and supply current [A] with supply power [W]."""
    with figure(path, height=5.0, rows=2) as (coils, supply):
        draw_coils(coils, 1000.0 * run["circuit.current"], "coil")
        coils.set_ylabel("coil current [mA]")
        mark_switches(coils, marks)
        coils.legend(frameon=False, fontsize=8)
        supply.plot(run["time"], run["circuit.supply_current"], color="C0", label="supply current [A]")
        supply.plot(run["time"], run["circuit.supply_power"], color="C1", label="supply power [W]")
        mark_switches(supply, marks)
        supply.set_xlabel("time [s]")
        supply.set_ylabel("supply [A], [W]")
        supply.legend(frameon=False, fontsize=8)
    return path
