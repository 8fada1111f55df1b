"""Temperatures: equations (3), (4) and (5), and the two rates that contradict each other."""

from __future__ import annotations

import numpy as np
import xarray as xr

from chainmail.equations import Coil
from chainmail.measures import exponential_rate
from chainmail.reproduce.row import Row, compare, relation

#: Switching of the scenario single_coil_heating [s] and its voltages [V].
OFF = 40.0
VOLTAGES = np.array([0.5, 0.7, 0.8, 0.9, 1.0, 1.2])
_ONE_VOLT = 4


def thermal_rows(heating: xr.Dataset, own_rate: xr.Dataset) -> list[Row]:
    """Rows from the single-coil runs.

    Args:
        heating: Result of single_coil_heating (cooling at the regressed rate).
        own_rate: The same with the cooling rate that equation (3) implies.
    """
    coil, s = Coil(), "Thermal"
    celsius = heating["actuator.temperature"] - 273.15
    on, off = celsius.sel(time=slice(0.0, OFF)), celsius.sel(time=slice(OFF, None))
    law3 = coil.heating(on["time"].values[:, None], VOLTAGES[None, :])
    begin = off.values[0]
    law5 = coil.cooling(off["time"].values[:, None] - OFF, begin[None, :])
    one_volt = on.values[:, _ONE_VOLT]
    seventy = float(np.interp(70.0, one_volt, on["time"].values))
    terminal = float(coil.terminal_temperature(1.0))
    rest = terminal - float(one_volt[-1])
    return [
        compare(
            s,
            "terminal temperature at 1 V, equation (4)",
            f"{terminal:.2f} degC (T_a = 22 degC)",
            float(one_volt[-1]),
            terminal,
            "degC",
            0.05,
            "40 s of heating leave exp(-8.9) of the rise",
            f"{rest:.3f} degC are still missing after 40 s",
        ),
        compare(
            s,
            "time to 70 degC at 1 V",
            "12 s",
            seventy,
            12.0,
            "s",
            0.5,
            "printed without decimals",
            "T_a is not published; 22 degC is chosen so that this holds",
        ),
        compare(
            s,
            "heating against equation (3), largest difference over six voltages",
            "0",
            float(np.abs(on.values - law3).max()),
            0.0,
            "degC",
            1e-6,
            "exact exponential step",
        ),
        compare(
            s,
            "cooling against equation (5), largest difference",
            "0",
            float(np.abs(off.values - law5).max()),
            0.0,
            "degC",
            1e-6,
            "exact exponential step",
            "started from the temperature reached, which after 40 s is that of equation (4)",
        ),
        compare(
            s,
            "rate found in our cooling curve, regressed option on",
            "0.14 1/s",
            _cooling_rate(heating),
            0.14,
            "1/s",
            0.001,
            "regression",
        ),
        compare(
            s,
            "rate hA/(rho V c_p) in our cooling curve, regressed option off",
            "0.2226 1/s",
            _cooling_rate(own_rate),
            0.2226,
            "1/s",
            0.0002,
            "printed constants",
        ),
        relation(
            s,
            "the paper contradicts itself: rate heating / rate cooling",
            "0.2226 / 0.14",
            coil.heating_rate / coil.cooling_rate,
            "1",
            abs(coil.heating_rate / coil.cooling_rate - 1.59) < 0.01,
            "one hA and one heat capacity would give 1",
            "a lower h when off (chassis, no draught), a second heat capacity or latent heat could do it; the "
            "text names the chassis",
        ),
    ]


def _cooling_rate(run: xr.Dataset) -> float:
    window = run["actuator.temperature"].sel(time=slice(OFF + 1.0, OFF + 15.0))
    return exponential_rate(window["time"].values, window.values[:, _ONE_VOLT] - 273.15, Coil().ambient)
