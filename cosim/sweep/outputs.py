"""Numbers and series read off a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from cosim.sweep.file import Output, Recorded
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion

#: Quantities that are computed here, beside the recorded ones.
ENERGY, TIP_SAG, ROW_BEND = "energy", "tip_sag", "row_bend"


@dataclass(frozen=True)
class Value:
    """One number of a run, or a series.

    Args:
        values: Shape () or (time,), in `unit`.
        unit: Its unit.
    """

    values: Array
    unit: str


def quantity(run: xr.Dataset, name: str) -> xr.DataArray:
    """A recorded variable by its name `component.variable`, or a derived one.

    `component.tip_sag` [m]: how far the centre of a fabric's last row lies below the mean of its first two, the
    tethered rows of a cantilever. `component.row_bend` [rad]: by how much the way from a row to the next one points
    further down than that from the row before; 0 at the first and the last row.
    `energy` [J]: electrical energy of the whole run (no series).

    Raises:
        ValueError: The run has no such quantity.
    """
    if name in run.data_vars:
        return run[name]
    component, _, last = name.rpartition(".")
    centre = run.get(f"{component}.row_centre")
    if last == TIP_SAG and centre is not None:
        height = centre.isel(axis=2)
        sag = height.isel(row=slice(0, 2)).mean("row") - height.isel(row=-1)
        return sag.assign_attrs(units="m", long_name="sag of the tip below the tethered rows")
    if last == ROW_BEND and centre is not None:
        way = centre.diff("row", label="lower")
        slope = xr.apply_ufunc(np.arctan2, -way.isel(axis=2), way.isel(axis=1))
        # A bend belongs to the row between two ways; the first and the last row have none.
        bend: xr.DataArray = slope.diff("row", label="upper").reindex(row=centre["row"], fill_value=0.0)
        ordered: xr.DataArray = bend.transpose("time", "row").rename(name)
        return ordered.assign_attrs(units="rad", long_name="bend at every row")
    there = ", ".join(sorted(str(n) for n in run.data_vars))
    raise ValueError(f"no run of this scenario has a quantity `{name}`; there are: {there}, energy")


def number(run: xr.Dataset, output: Output) -> Value:
    """The number that an output asks for.

    Raises:
        ValueError: There is no such quantity, element or time, or its unit is another.
    """
    if output.quantity == ENERGY:
        if "energy_electrical_J" not in run.attrs:
            raise ValueError("this scenario has no electrical energy balance; integrate a power: `over: integral`")
        return _converted(Value(np.asarray(float(run.attrs["energy_electrical_J"])), "J"), output.unit)
    values = element(quantity(run, output.quantity), output.of)
    unit = str(values.attrs.get("units", ""))
    time = values["time"].values
    if output.over == "at":
        assert output.at is not None
        value = _at(values.values, time, output.at.to("s"))
    elif output.over == "final":
        value = float(values.values[-1])
    else:
        first = time[0] if output.from_ is None else output.from_.to("s")
        last = time[-1] if output.to is None else output.to.to("s")
        chosen = (time >= first - 1e-9) & (time <= last + 1e-9)
        if not chosen.any():
            raise ValueError(f"no output lies between {first:g} s and {last:g} s")
        if output.over == "integral":
            return _converted(_integral(values.values[chosen], time[chosen], unit), output.unit)
        value = float(getattr(np, output.over)(values.values[chosen]))
    return _converted(Value(np.asarray(value), unit), output.unit)


def series(run: xr.Dataset, recorded: Recorded) -> Value:
    """The series that is asked for, shape (time,).

    Raises:
        ValueError: There is no such quantity or element.
    """
    values = element(quantity(run, recorded.quantity), recorded.of)
    return Value(np.asarray(values.values, dtype=np.float64), str(values.attrs.get("units", "")))


def element(values: xr.DataArray, of: str | int) -> xr.DataArray:
    """One number per time of an array with elements; that of a single value is itself.

    Raises:
        ValueError: It is no number, or has no such element.
    """
    if values.dtype.kind not in "biuf":
        raise ValueError(f"`{values.name}` is no number")
    dims = [d for d in values.dims if d != "time"]
    if not dims:
        return values
    if isinstance(of, str):
        return getattr(values, of)(dims, keep_attrs=True)  # type: ignore[no-any-return]
    flat = values.stack(element=dims)
    if of > flat.sizes["element"]:
        raise ValueError(f"`{values.name}` has {flat.sizes['element']} elements; there is no element {of}")
    return flat.isel(element=of - 1)


def _at(values: Array, time: Array, moment: float) -> float:
    """Value at the output nearest to a time, which must lie within half an output step of it."""
    step = float(np.max(np.diff(time))) if len(time) > 1 else 0.0
    nearest = int(np.argmin(np.abs(time - moment)))
    if abs(time[nearest] - moment) > 0.5 * step + 1e-9:
        raise ValueError(f"there is no output at {moment:g} s: the run goes from {time[0]:g} s to {time[-1]:g} s")
    return float(values[nearest])


def _integral(values: Array, time: Array, unit: str) -> Value:
    """Sum of values times intervals: what is recorded at a time is that of the step that ends there."""
    total = float(np.sum(values[1:] * np.diff(time)))
    return Value(np.asarray(total), "J" if unit == "W" else f"({unit})*s" if unit not in ("", "1") else "s")


def _converted(value: Value, unit: str | None) -> Value:
    if unit is None:
        return value
    factor, offset = conversion(value.unit or "1", unit)
    return Value(np.asarray(factor * value.values + offset), unit)
