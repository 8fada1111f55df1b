"""The course of a measured quantity in the results of a run."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from cosim.unit.quantity import conversion
from cosim.unit.variable import MEAN
from diagnosis.recording.quantity import TELLING, Target, is_numbered
from diagnosis.recording.units import PURE, instead

#: Quantities that jump with the supply: nothing is drawn between two outputs but a straight line.
_FLOWS = frozenset({"current", "voltage", "power"})
#: Quantity of a channel to the names that it has in results, in the order in which they are looked for.
_RESULTS = {
    ("supply", "current"): ("supply_current",),
    ("supply", "power"): ("terminal_power", "supply_power"),
    ("supply", "voltage"): ("terminal_voltage",),
    ("string", "current"): ("string_current",),
    ("string", "voltage"): ("string_voltage",),
    ("link", "length"): ("link_length",),
    ("link", "x"): ("position",),
    ("link", "y"): ("position",),
    ("link", "z"): ("position",),
    ("marker", "x"): ("marker_position",),
    ("marker", "y"): ("marker_position",),
    ("marker", "z"): ("marker_position",),
    ("fabric", "length"): ("fabric_length",),
}
#: Quantities that follow from several variables of a circuit.
_DERIVED = frozenset({("supply", "power"), ("string", "voltage")})
#: Largest size of a value [SI] that is compared; its square, summed over any recording, is still a number.
MOST = 1e100
#: Most instants whose weights are kept for the next channel.
READ_AGAIN = 10_000
_AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True)
class Series:
    """One quantity over a run.

    Args:
        times: [s], shape (outputs,).
        values: SI, shape (outputs,).
        is_flow: Whether it jumps with the supply.
        unit: SI unit of the values; of a quantity without a name of its own, that of the variable.
    """

    times: Array
    values: Array
    is_flow: bool
    unit: str


def series_of(results: xr.Dataset, target: Target, source: Path) -> Series:
    """What a channel measures, at the times of the outputs: of a mean over a step the value at its end.

    Args:
        results: Of `cosim.run`.
        target: What is measured.
        source: File that names it, for errors.

    Raises:
        InputError: The results have no such quantity or element.
    """
    found, is_mean = _read_from(results, target, source)
    step = results.attrs.get("macro_step_s")
    if not is_mean or step is None or not np.isfinite(found.values).all():
        return found
    return replace(found, values=_at_ends(found.values, found.times, float(step)))


def _at_ends(means: Array, times: Array, step: float) -> Array:
    """Values at the ends of steps whose means are known: by the harmonic mean of the slopes to both sides.

    It is nothing where they have opposite signs, and at a jump little more than that of the other side.

    Args:
        means: Over the step that ends at each time, shape (outputs,); the first is the value at the start.
        times: Of the outputs [s].
        step: Length of a step [s].

    Source: B. van Leer, J. Comput. Phys. 14 (1974) 361-370 and 32 (1979) 101-136 (means of cells, limited slopes).
    """
    if len(means) < 3:
        return means
    slopes = np.diff(means) / np.diff(times)
    before, after = slopes[:-1], slopes[1:]
    is_alike = before * after > 0.0
    found = means.copy()
    found[1:-1] += step * np.where(is_alike, before * after / np.where(is_alike, before + after, 1.0), 0.0)
    return found


def recorded_series(results: xr.Dataset, target: Target, source: Path) -> Series:
    """What the results have of a quantity, a mean as it is; arguments and errors as in `series_of`."""
    return _read_from(results, target, source)[0]


def _read_from(results: xr.Dataset, target: Target, source: Path) -> tuple[Series, bool]:
    """What the results have of a quantity, and whether it is the mean over the step that ends at its time."""
    found, index = place_of(results, target, source)
    values = np.asarray(found.values, dtype=np.float64).reshape(len(found), -1)[:, index]
    own = str(found.attrs.get("units", "1"))
    unit = own if target.si_unit == "1" else target.si_unit
    try:
        factor, offset = conversion(own, unit)
    except ValueError as error:
        raise InputError(source, f"channels.{target}", str(error), f"{found.name} is in {own}") from error
    values = np.where(np.abs(values) <= MOST, values, np.inf)
    series = Series(results["time"].values, factor * values + offset, target.quantity in _FLOWS, unit)
    return series, found.attrs.get("cell_methods") == MEAN


def place_of(results: xr.Dataset, target: Target, source: Path) -> tuple[xr.DataArray, int]:
    """Variable of the results that a channel measures, and the number of its element in the flattened variable.

    Raises:
        InputError: The results have no such quantity or element.
    """
    if (target.kind, target.quantity) in _DERIVED:
        results = results.assign(_derived(results))
    found = results[_variable(results, target, source)]
    _check_pure(target, str(found.attrs.get("units", PURE)), source)
    elements = _elements(results, found, target, source)
    return found, int(np.ravel_multi_index(elements, found.shape[1:])) if elements else 0


def _check_pure(target: Target, own: str, source: Path) -> None:
    """Refuse pure numbers, as a converter gives them, for what has a unit and a name that says it."""
    if not target.is_component or target.unit != PURE or target.quantity not in TELLING:
        return
    try:
        conversion(PURE, own)
    except ValueError as error:
        raise InputError(source, f"channels.{target}.unit", str(error), instead(PURE, own)) from error


def _derived(results: xr.Dataset) -> dict[str, xr.DataArray]:
    """Of every circuit: voltage across the coils of each string, power out of the terminals of all sources."""
    found: dict[str, xr.DataArray] = {}
    for name in map(str, results):
        circuit, _, variable = name.rpartition(".")
        if variable != "terminal_voltage" or "string_of_coil" not in results.coords:
            continue
        voltage, current = results[f"{circuit}.voltage"], results[f"{circuit}.string_current"]
        if results["string_of_coil"].dims != voltage.dims[1:]:
            continue
        first = np.flatnonzero(np.diff(results["string_of_coil"].values, prepend=0))
        across = np.add.reduceat(voltage.values, first, axis=1)
        terminal = results[name].values
        terminal = terminal[:, None] if terminal.ndim == 1 else terminal
        power = (terminal * current.values).sum(axis=1)
        about = {k: v for k, v in current.attrs.items() if k == "cell_methods"}
        found[f"{circuit}.string_voltage"] = xr.DataArray(across, dims=current.dims, attrs={"units": "V", **about})
        found[f"{circuit}.terminal_power"] = xr.DataArray(power, dims=current.dims[:1], attrs={"units": "W", **about})
    return found


def _variable(results: xr.Dataset, target: Target, source: Path) -> str:
    if target.is_component:
        name = f"{target.kind}.{target.quantity}"
        if name in results:
            return name
    else:
        for wanted in _RESULTS.get((target.kind, target.quantity), (target.quantity,)):
            fitting = [str(n) for n in results if str(n).rpartition(".")[2] == wanted and _fits(results[n], target)]
            if fitting:
                return min(fitting, key=lambda name: results[name].dims[1:] != (target.kind,))
    if (target.kind, target.quantity) == ("supply", "voltage") and any(
        str(n).endswith(".terminal_voltage") for n in results
    ):
        remedy = "name `string[n].voltage`, across the coils of a string"
        raise InputError(source, f"channels.{target}", "every string has a supply of its own", remedy)
    own = f"{target.kind}.{target.quantity}"  # a component may be called `supply`
    if own in results and not target.element:
        return own
    there = ", ".join(str(n) for n in results)
    raise InputError(source, f"channels.{target}", "the scenario has no such quantity", _remedy(target, there))


def _remedy(target: Target, there: str) -> str:
    """What to name instead: `coil.temperature` may be meant as that of a coil of a circuit."""
    if is_numbered(target.kind):
        return f"write `{target.kind}[1].{target.quantity}`, counted from 1, for one of several; it has: {there}"
    return f"it has: {there}"


def _fits(values: xr.DataArray, target: Target) -> bool:
    """Whether a variable has the elements that a channel speaks of (`power` may be a coil's or a programme's)."""
    dims = values.dims[1:]
    if target.kind == "coil":  # an FMU of somebody else may name its dimension otherwise
        return len(dims) == 1 and dims != ("string",)
    if target.kind == "string":
        return dims == ("string",)
    return dims == () if target.kind in ("supply", "fabric") else True


def _elements(results: xr.Dataset, values: xr.DataArray, target: Target, source: Path) -> tuple[int, ...]:
    """Indices from 0 of the element measured."""
    numbers = list(target.element)
    if target.kind == "coil" and len(numbers) == 2:
        numbers = [_coil(results, values, numbers[0], numbers[1], target, source)]
    indices = [n - 1 for n in numbers]
    if target.quantity in _AXES and not target.is_component:
        indices.append(_AXES[target.quantity])
    shape = values.shape[1:]
    if len(indices) != len(shape) or any(not 0 <= i < size for i, size in zip(indices, shape)):
        has = " x ".join(str(s) for s in shape) or "no"
        raise InputError(
            source, f"channels.{target}", f"{values.name} has {has} elements, counted from 1", "name one of them"
        )
    return tuple(indices)


def _coil(results: xr.Dataset, values: xr.DataArray, string: int, place: int, target: Target, source: Path) -> int:
    """Number of coil `place` of a string, counted from 1: coils are numbered string by string."""
    strings = np.ones(values.shape[1], dtype=int)
    if "string_of_coil" in results.coords and values.dims[1] == "coil":
        strings = results["string_of_coil"].values
    of_string = np.flatnonzero(np.asarray(strings) == string)
    if not 1 <= place <= len(of_string):
        raise InputError(
            source,
            f"channels.{target}",
            f"there is no coil {place} in string {string}",
            "strings and places are counted from 1",
        )
    return int(of_string[place - 1]) + 1


def sample(series: Series, times: Array) -> Array:
    """Values at given times, shape (times,); beyond the run its end values hold.

    A flow is drawn with straight lines between outputs, a state with parabolas and cubics through four outputs, whose
    error falls with the fourth power of the output step. A value beyond `MOST`, or none, makes those drawn with it
    infinite: the run has lost its way, and its squares would be no numbers.
    """
    is_lost = ~(np.abs(series.values) <= MOST)
    if not is_lost.any():
        return _drawn(series, series.values, times)
    found = _drawn(series, np.where(is_lost, 0.0, series.values), times)
    return np.where(_is_drawn_with(series, is_lost, times), np.inf, found)


def _drawn(series: Series, values: Array, times: Array) -> Array:
    """Values between those of a series; see `sample`."""
    if series.is_flow or len(series.times) < 4:
        return np.asarray(np.interp(times, series.times, values))
    used, weights = _read_at(series.times, times)
    return np.asarray(np.einsum("ij,ij->i", weights, values[used]))


def _is_drawn_with(series: Series, chosen: AnyArray, times: Array) -> AnyArray:
    """Whether any of the outputs that a value is drawn with is chosen, shape (times,)."""
    if series.is_flow or len(series.times) < 4:
        return np.asarray(np.interp(times, series.times, chosen.astype(np.float64)) > 0.0)
    return np.asarray(np.any(chosen[_read_at(series.times, times)[0]], axis=1))


def _read_at(grid: Array, times: Array) -> tuple[AnyArray, Array]:
    """See `_read`; of a few instants it is kept."""
    read = _read_again if len(times) <= READ_AGAIN else _read
    return read(grid.tobytes(), times.tobytes())


def _read(grid: bytes, instants: bytes) -> tuple[AnyArray, Array]:
    """Outputs that are read at instants, and their weights by the cubic through them; both of shape (instants, 4)."""
    own, times = np.frombuffer(grid), np.frombuffer(instants)
    clipped = np.clip(times, own[0], own[-1])
    first = np.clip(np.searchsorted(own, clipped, side="right") - 2, 0, len(own) - 4)
    used = first[:, None] + np.arange(4)
    nodes = own[used.T]
    since = clipped - nodes
    columns = np.ones((4, len(times)))
    for i in range(4):
        for j in range(4):
            if i != j:
                columns[i] *= since[j] / (nodes[i] - nodes[j])
    return used, np.ascontiguousarray(columns.T)


#: The channels of a recording are read at the same instants of the same grid, one after the other.
_read_again = lru_cache(maxsize=64)(_read)
