"""Numbers read off a run: delays, plateaus, rates, and the refit of equation (2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from chainmail.equations import Gompertz
from cosim.unit.protocol import Array

#: Bounds of the band that is drawn and told beside a median.
LOW, HIGH = 0.05, 0.95


def band(values: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray, xr.DataArray]:
    """5 per cent, median and 95 per cent over the dimension `start`, interpolated between the ordered values."""
    low, middle, high = (values.quantile(q, "start").drop_vars("quantile") for q in (LOW, 0.5, HIGH))
    return low, middle, high


def one_start(run: xr.Dataset) -> xr.Dataset:
    """Of an ensemble the start whose curvature is nearest to the median, over all times; any other run as it is.

    Where the starts differ in no curvature, or several fabrics have one, the first start or fabric counts.
    """
    if "start" not in run.dims:
        return run
    curved = [v for n, v in run.data_vars.items() if str(n).endswith(".max_curvature") and "start" in v.dims]
    if not curved:
        return run.isel(start=0)
    distance = ((curved[0] - band(curved[0])[1]) ** 2).mean("time")
    return run.isel(start=int(distance.argmin("start")))


def switches(run: xr.Dataset) -> list[float]:
    """Times [s] at which a supply voltage changes."""
    if "supply.voltage" not in run:
        return []
    values = run["supply.voltage"].values.reshape(run.sizes["time"], -1)
    changed = np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))
    return [float(run["time"].values[i]) for i in changed]


def plateau(values: xr.DataArray, begin: float, end: float) -> float:
    """Mean of a scalar series over a window [s]."""
    return float(values.sel(time=slice(begin, end)).mean())


def half_way_delay(values: xr.DataArray, switch: float, before: float, after: float) -> float:
    """Time [s] from a switch until a series has gone half of the way from `before` to `after` for good.

    The last crossing counts, so that a swinging fabric is not called changed at its first swing.

    Returns:
        Delay [s], or NaN where the series never gets there.
    """
    later = values.sel(time=slice(switch, None))
    middle = 0.5 * (before + after)
    is_beyond = (later.values > middle) if after > before else (later.values < middle)
    if not is_beyond[-1]:
        return float("nan")
    wrong = np.flatnonzero(~is_beyond)
    first = int(wrong[-1]) + 1 if wrong.size else 0
    return float(later["time"].values[first]) - switch


def exponential_rate(time: Array, values: Array, limit: float) -> float:
    """Rate alpha [1/s] of values = limit + const * exp(-alpha t), by linear regression of the logarithm.

    Args:
        time: Shape (n,) [s].
        values: Shape (n,), all on one side of `limit`.
        limit: Value after long time.
    """
    slope, _ = np.polyfit(time, np.log(np.abs(values - limit)), 1)
    return -float(slope)


@dataclass(frozen=True)
class Refit:
    """Equation (2) fitted again.

    Args:
        curve: The constants.
        residual_norm: Sum of squared residuals, in the unit of k squared.
    """

    curve: Gompertz
    residual_norm: float


def refit(temperature: Array, stiffness: Array, guess: Gompertz) -> Refit:
    """Fit equation (2) by non-linear least squares, as the paper does.

    b and c differ by orders of magnitude and are strongly correlated, so ln b is fitted.

    Args:
        temperature: Shape (n,) [degC].
        stiffness: Shape (n,), in the unit of a and d.
        guess: Start of the search.
    """

    def curve(p: Array) -> Gompertz:
        return Gompertz(p[0], float(np.exp(p[1])), p[2], p[3])

    def residual(p: Array) -> Array:
        return curve(p)(temperature) - stiffness

    from scipy.optimize import least_squares  # late: loading it takes half a second

    start = np.array([guess.a, np.log(guess.b), guess.c, guess.d])
    found = least_squares(residual, start, x_scale=np.abs(start), xtol=1e-14, ftol=1e-14, gtol=1e-14)
    return Refit(curve(found.x), float(np.sum(np.square(found.fun))))


def level_readings(run: xr.Dataset, interval: float, hold: float) -> tuple[Array, Array]:
    """Readings of a water-bath run: bath temperature [degC] and stiffness k = load / extension [N/mm].

    Args:
        run: Result of the scenario water_bath.
        interval: Time from level to level [s].
        hold: Time for which a level is held [s]; the reading is taken at its end.
    """
    end = float(run["time"][-1])
    moments = np.arange(hold, end + 0.5, interval)
    at = run.sel(time=moments, method="nearest")
    tension, extension = at["load.tension"].values[:, 0], at["load.extension"].values[:, 0]
    return at["bath.temperature"].values, tension / extension / 1000.0
