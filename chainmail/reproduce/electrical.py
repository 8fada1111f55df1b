"""Currents and powers of section 2.2."""

from __future__ import annotations

import xarray as xr

from chainmail.reproduce.row import Row, compare


def electrical_rows(prototype: xr.Dataset) -> list[Row]:
    """Rows from the prototype run at 10 s, under full voltage.

    Args:
        prototype: Result of the scenario prototype_cantilever.
    """
    now = prototype.sel(time=10.0, method="nearest")
    s = "Electrical"
    truncated = "the paper prints 6 V / 13.2 Ohm without rounding up"
    return [
        compare(
            s,
            "current of a coil",
            "454 mA",
            1e3 * float(now["circuit.current"].mean()),
            454.0,
            "mA",
            1.0,
            "last printed digit",
            truncated,
        ),
        compare(s, "voltage of a coil", "1 V", float(now["circuit.voltage"].mean()), 1.0, "V", 1e-6, "solver"),
        compare(
            s,
            "total current",
            "2.72 A",
            float(now["circuit.supply_current"]),
            2.72,
            "A",
            0.01,
            "last printed digit",
            truncated,
        ),
        compare(
            s, "total power", "16.36 W", float(now["circuit.supply_power"]), 16.36, "W", 0.01, "last printed digit"
        ),
    ]
