"""Stiffness: equation (2) from our own water-bath run."""

from __future__ import annotations

import numpy as np
import xarray as xr

from chainmail.equations import COOLING, HEATING
from chainmail.measures import level_readings, refit
from chainmail.reproduce.row import Row, compare, relation

#: Levels of the scenario water_bath: interval and hold [s], and number of levels while heating.
INTERVAL, HOLD, RISING = 60.0, 50.0, 21


def stiffness_rows(bath: xr.Dataset) -> list[Row]:
    """Rows from the water-bath run.

    Args:
        bath: Result of the scenario water_bath.
    """
    s = "Stiffness"
    temperature, k = level_readings(bath, INTERVAL, HOLD)
    up, down = slice(0, RISING), slice(RISING - 1, None)
    # The level of 70 degC belongs to both branches; they differ there, and the bath run can give only one value.
    falling = slice(RISING, None)
    up_fit, down_fit = refit(temperature[up], k[up], HEATING), refit(temperature[falling], k[falling], COOLING)
    rows = [
        compare(
            s,
            "k at 30 degC, heating",
            f"{float(HEATING(30.0)):.4f} N/mm",
            float(k[0]),
            float(HEATING(30.0)),
            "N/mm",
            1e-4,
            "last printed digit",
        ),
        compare(
            s,
            "k at 70 degC, heating",
            f"{float(HEATING(70.0)):.4f} N/mm",
            float(k[RISING - 1]),
            float(HEATING(70.0)),
            "N/mm",
            3e-4,
            "the branches differ by 0.0012 here",
        ),
        compare(
            s,
            "k at 30 degC, cooling",
            f"{float(COOLING(30.0)):.4f} N/mm",
            float(k[-1]),
            float(COOLING(30.0)),
            "N/mm",
            3e-4,
            "the coil lags the bath slightly",
        ),
        compare(
            s,
            "heating branch, largest difference over 21 levels",
            "0",
            float(np.abs(k[up] - HEATING(temperature[up])).max()),
            0.0,
            "N/mm",
            1e-3,
            "lag of the coil behind the bath",
        ),
        compare(
            s,
            "cooling branch, largest difference over 21 levels",
            "0",
            float(np.abs(k[down] - COOLING(temperature[down])).max()),
            0.0,
            "N/mm",
            2e-3,
            "the branches meet at one temperature only; k must not jump there",
        ),
    ]
    for branch, fit, law in (("heating", up_fit, HEATING), ("cooling", down_fit, COOLING)):
        for name in ("a", "b", "c", "d"):
            target = float(getattr(law, name))
            rows.append(
                compare(
                    s,
                    f"refit of equation (2), {branch}, {name}",
                    f"{target:g}",
                    float(getattr(fit.curve, name)),
                    target,
                    {"c": "1/degC", "b": "1"}.get(name, "N/mm"),
                    abs(target) * (0.15 if name == "b" else 0.02),
                    "b is ill determined: ln b counts" if name == "b" else "2 %",
                )
            )
    total = up_fit.residual_norm + down_fit.residual_norm
    # Published: the misfit of measured points.  Ours is the misfit of a noise-free run, so it can only be smaller.
    rows.append(
        relation(
            s,
            "residual norm of the refit",
            "0.0058",
            total,
            "(N/mm)^2",
            total < 0.0058,
            "noise-free run: below the paper's",
            "the paper's is measuring noise and the coil's own shape; ours has neither",
        )
    )
    return rows
