"""All runs of a sweep as one labelled data set, a table, and failures by reason."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cosim.compute.result import Result
from cosim.sweep.axes import Points
from cosim.sweep.file import SweepFile

_NUMBER = re.compile(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")


@dataclass(frozen=True)
class Made:
    """A sweep with its results.

    Args:
        sweep: What was asked for.
        axes: Its axes.
        results: One per run, in the order of `cosim.sweep.axes.grid`.
    """

    sweep: SweepFile
    axes: Sequence[Points]
    results: Sequence[Result]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points of every axis."""
        return tuple(a.size for a in self.axes)


def dataset(made: Made) -> xr.Dataset:
    """Outputs with all axes as dimensions; NaN where a run failed, with its reason in `failure`.

    Wall times are left out: the data set is the same to the last bit wherever the runs were made.
    """
    names = [a.name for a in made.axes]
    units = units_of(made)
    variables: dict[str, Any] = {}
    for number, name in enumerate(made.sweep.outputs):
        values = np.array([r.arrays[0][number] if r.is_complete else np.nan for r in made.results])
        asked = made.sweep.outputs[name]
        about = {"units": units.get(name, ""), "quantity": asked.quantity, "over": asked.over}
        variables[name] = (names, values.reshape(made.shape), about)
    coordinates: dict[str, Any] = {}
    time = next((r.arrays[1] for r in made.results if r.is_complete), None) if made.sweep.series else None
    if time is not None:
        coordinates["time"] = ("time", time, {"units": "s", "long_name": "simulated time"})
        for number, name in enumerate(made.sweep.series):
            rows = [r.arrays[2 + number] if r.is_complete else np.full(len(time), np.nan) for r in made.results]
            about = {"units": units.get(name, ""), "quantity": made.sweep.series[name].quantity}
            variables[name] = ((*names, "time"), np.reshape(rows, (*made.shape, len(time))), about)
    reasons = np.array([r.failure for r in made.results], dtype=object).reshape(made.shape)
    variables["failure"] = (names, reasons, {"long_name": "why the run failed; empty: it did not"})
    for axis in made.axes:
        coordinates |= _coordinates(axis)
    return xr.Dataset(variables, coordinates, {"title": made.sweep.title, "scenario": made.sweep.scenario})


def units_of(made: Made) -> dict[str, str]:
    """Units of outputs and series, by name; empty where no run was complete."""
    for result in made.results:
        if result.is_complete:
            return dict(zip((*made.sweep.outputs, *made.sweep.series), result.text))
    return {}


def _coordinates(axis: Points) -> dict[str, Any]:
    """An axis of one key has that key's values; any other counts its points, with the keys beside it."""
    if axis.kind in ("key", "starts"):
        return {axis.name: (axis.name, *_labels(axis, 0))}
    found: dict[str, Any] = {axis.name: (axis.name, np.arange(1, axis.size + 1), {"long_name": "number of the point"})}
    for number, column in enumerate(axis.columns):
        found[f"{axis.name}.{column.key}"] = (axis.name, *_labels(axis, number))
    return found


def _labels(axis: Points, number: int) -> tuple[Any, dict[str, str]]:
    column = axis.columns[number]
    is_drawn = axis.kind in ("sobol", "indices")
    if column.numbers is not None and (is_drawn or len(np.unique(column.numbers)) == axis.size):
        return column.numbers, {"units": column.unit, "key": column.key}
    return np.array(column.labels(), dtype=object), {"key": column.key}


def table(made: Made) -> str:
    """One line per run, as CSV: axes, outputs, reason of failure."""
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    units = units_of(made)
    heads = [
        (f"{a.name}.{c.key}" if len(a.columns) > 1 else a.name, c, i)
        for i, a in enumerate(made.axes)
        for c in a.columns
    ]
    outputs = [f"{n} [{units[n]}]" if units.get(n) else n for n in made.sweep.outputs]
    writer.writerow(["run", *(h for h, _, _ in heads), *outputs, "failure"])
    for number, (place, result) in enumerate(zip(np.ndindex(*made.shape), made.results), start=1):
        values = [f"{v:.12g}" for v in result.arrays[0]] if result.is_complete else [""] * len(outputs)
        writer.writerow([number, *(c.values[place[i]] for _, c, i in heads), *values, result.failure])
    return buffer.getvalue()


def reasons(results: Sequence[Result]) -> list[tuple[str, list[int]]]:
    """Reasons of failure with the numbers of their runs (from 1), most frequent first.

    Reasons that differ in numbers alone (which link, when) are one.
    """
    found: dict[str, tuple[str, list[int]]] = {}
    for number, result in enumerate(results, start=1):
        if result.failure:
            kind = _NUMBER.sub("#", result.failure)
            found.setdefault(kind, (result.failure, []))[1].append(number)
    return sorted(found.values(), key=lambda entry: (-len(entry[1]), entry[1]))


def failures_table(results: Sequence[Result]) -> str:
    """Failures by reason, as CSV."""
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    writer.writerow(["runs that failed", "first reason of its kind", "numbers of the runs"])
    for text, numbers in reasons(results):
        writer.writerow([len(numbers), " ".join(text.split()), " ".join(map(str, numbers))])
    return buffer.getvalue()


def indices_table(found: Mapping[tuple[str, str], Any]) -> str:
    """Sobol' indices as CSV.

    Args:
        found: Output and axis to keys and `Indices`.
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    writer.writerow(["output", "axis", "key", "first order", "+-", "total", "+-"])
    for (output, axis), (keys, indices) in found.items():
        for number, key in enumerate(keys):
            numbers = (indices.first, indices.first_error, indices.total, indices.total_error)
            writer.writerow([output, axis, key, *(f"{v[number]:.4g}" for v in numbers)])
    return buffer.getvalue()
