"""What a designer reads off a run: delays, energy, temperature, stiffness, shape, current."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr

from chainmail.compare.layout import Layout
from chainmail.measures import half_way_delay, plateau

NAN = float("nan")
#: A quantity that moves by less than this share of itself has not moved: no delay is given.
MOVED = 0.01
#: Windows over which levels are averaged [s]: before a switch, and at the end of the run; at most this share of the
#: phase that they end, so that a short phase is read where it has got to.
BEFORE, LAST, SHARE = 1.0, 2.0, 0.1


@dataclass(frozen=True)
class Measure:
    """One number of a run.

    Args:
        key: Name in CSV and JSON, with its unit.
        label: Name in tables.
        unit: Unit as shown.
        value: The number; NaN where the quantity does not exist.
    """

    key: str
    label: str
    unit: str
    value: float


def measures(run: xr.Dataset, layout: Layout) -> list[Measure]:
    """All measures of a run, always the same ones in the same order."""
    stiffness = coil_series(run, f"{layout.actuator}.stiffness", layout)
    shape, what = shape_series(run, layout)
    curvature = None if what != "curvature" else shape
    length = _length(run, layout)
    stiff, bent, long = (_levels(s, layout) for s in (stiffness, curvature, length))
    on_k, off_k = _delays(stiffness, layout)
    on_s, off_s = _delays(shape, layout)
    power = total_power(run, layout)
    return [
        Measure("delay_on_stiffness_s", "delay on, stiffness half-way", "s", on_k),
        Measure("delay_off_stiffness_s", "delay off, stiffness half-way", "s", off_k),
        Measure("delay_on_shape_s", "delay on, shape half-way", "s", on_s),
        Measure("delay_off_shape_s", "delay off, shape half-way", "s", off_s),
        Measure("energy_J", "electrical energy", "J", _energy(power)),
        Measure("peak_power_W", "peak power", "W", _peak(power)),
        Measure("peak_current_A", "peak supply current", "A", _peak(_supply_current(run, layout))),
        Measure(
            "peak_temperature_degC",
            "peak temperature",
            "°C",
            _peak(run.get(f"{layout.actuator}.temperature")) - 273.15,
        ),
        Measure("cold_stiffness_N_per_m", "stiffness, cold", "N/m", stiff[0]),
        Measure("peak_stiffness_N_per_m", "peak stiffness", "N/m", _peak(run.get(f"{layout.actuator}.stiffness"))),
        Measure("cold_curvature_per_cm", "maximum curvature, cold", "1/cm", bent[0] / 100.0),
        Measure("driven_curvature_per_cm", "maximum curvature, driven", "1/cm", bent[1] / 100.0),
        Measure("after_curvature_per_cm", "maximum curvature, afterwards", "1/cm", bent[2] / 100.0),
        Measure("cold_length_mm", "length, cold", "mm", 1000.0 * long[0]),
        Measure("driven_length_mm", "length, driven", "mm", 1000.0 * long[1]),
        Measure("length_change_percent", "length change", "%", 100.0 * (long[1] / long[0] - 1.0)),
        Measure("energy_residual", "energy residual", "1", float(run.attrs.get("energy_residual", NAN))),
        Measure(
            "wall_time_s",
            "computing time of the actuator",
            "s",
            float(run.attrs.get(f"wall_time_{layout.actuator}_s", NAN)),
        ),
    ]


def shape_series(run: xr.Dataset, layout: Layout) -> tuple[xr.DataArray | None, str]:
    """Curvature of a fabric, else length of what hangs."""
    curvature = run.get(f"{layout.mechanical}.max_curvature")
    # A hanging fabric has no curvature to speak of; there its length is the shape.
    if curvature is not None and float(curvature.max()) > 1.0:
        return curvature, "curvature"
    return _length(run, layout), "length"


def _length(run: xr.Dataset, layout: Layout) -> xr.DataArray | None:
    found = run.get(f"{layout.mechanical}.fabric_length")
    return found if found is not None else coil_series(run, f"{layout.mechanical}.length", layout)


def coil_series(run: xr.Dataset, name: str, layout: Layout) -> xr.DataArray | None:
    """Series of the coil that changes most between cold and driven: in a fabric heated in part, a heated one."""
    values = run.get(name)
    if values is None or values.ndim == 1:
        return values
    dim = values.dims[1]
    change = [
        abs(_levels(values.isel({dim: i}), layout)[1] - _levels(values.isel({dim: i}), layout)[0])
        for i in range(values.sizes[dim])
    ]
    return values.isel({dim: int(np.nanargmax(change)) if not np.isnan(change).all() else 0})


def _levels(values: xr.DataArray | None, layout: Layout) -> tuple[float, float, float]:
    """Mean before the drive, at its end, and at the end of the run.

    NaN before it where the run begins under power, and after it where the drive lasts to the end.
    """
    if values is None:
        return NAN, NAN, NAN
    begin, end = float(values["time"][0]), float(values["time"][-1])
    on, off = (begin if layout.on is None else layout.on), (end if layout.off is None else layout.off)
    cold = plateau(values, on - min(BEFORE, SHARE * (on - begin)), on) if layout.on is None or on > begin else NAN
    driven = plateau(values, off - min(BEFORE, SHARE * (off - on)), off)
    return cold, driven, NAN if layout.off is None else plateau(values, end - min(LAST, SHARE * (end - off)), end)


def _delays(values: xr.DataArray | None, layout: Layout) -> tuple[float, float]:
    """Delays [s] from each switch to half of the change."""
    if values is None or layout.on is None:
        return NAN, NAN
    cold, driven, after = _levels(values, layout)
    last = float(values["time"][-1]) if layout.off is None else layout.off
    on = half_way_delay(values.sel(time=slice(None, last)), layout.on, cold, driven) if _moved(cold, driven) else NAN
    if layout.off is None or not _moved(driven, after):
        return on, NAN
    return on, half_way_delay(values, layout.off, driven, after)


def _moved(before: float, after: float) -> bool:
    return abs(after - before) > MOVED * max(abs(before), abs(after))


def total_power(run: xr.Dataset, layout: Layout) -> xr.DataArray | None:
    """Power of all coils [W] over time."""
    power = run.get(f"{layout.electrical}.power")
    if power is None:
        return None
    return power if power.ndim == 1 else power.sum([power.dims[1]])


def _energy(power: xr.DataArray | None) -> float:
    """Integral [J] of power; the power at an output time is that of the step that ends there."""
    if power is None:
        return NAN
    return float(np.sum(power.values[1:] * np.diff(power["time"].values)))


def _supply_current(run: xr.Dataset, layout: Layout) -> xr.DataArray | None:
    found = run.get(f"{layout.electrical}.supply_current")
    return found if found is not None else run.get(f"{layout.electrical}.current")


def _peak(values: xr.DataArray | None) -> float:
    return NAN if values is None or math.isnan(float(values.max())) else float(np.abs(values).max())
