"""What other methods are given: residuals of the recalibrated model with the variables of the unit, by channel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.coil_network.kernel.inputs import Programme
from diagnosis.models.coil_network.kernel.layout import QUANTITIES
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.search.problem import Point
from evaluation.proof.oracle import Data

#: Columns of `Course.variables`: simulated temperature of the coil (mean over a string's or all coils) and its rate,
#: simulated value of the channel itself, drive (voltage, power or bath), time since the last switch, time.
NAMES = ("temperature", "rate", "value", "drive", "since_switch", "time")


@dataclass(frozen=True)
class Course:
    """One channel of one recording.

    Args:
        channel: Its name.
        quantity: What it measures.
        times: [s], shape (samples,).
        residuals: (measured - simulated) / deviation, shape (samples,).
        variables: Columns as in `NAMES`, SI, shape (samples, 6).
        used: Samples that count.
    """

    channel: str
    quantity: str
    times: Array
    residuals: Array
    variables: Array
    used: AnyArray


def courses(model: CoilNetworkModel, point: Point) -> list[Course]:
    """Courses of all channels of all recordings of a model, at a point."""
    return [course for number in range(len(model.runs)) for course in _of_run(model, point, number)]


def of_training(data: Data, point: Point) -> list[Course]:
    """Courses that a method may learn from."""
    return courses(data.model, point)


def _of_run(model: CoilNetworkModel, point: Point, number: int) -> list[Course]:
    run = model.runs[number]
    predicted = model.predict(point, number)
    times = [s.channel.times[-len(s.samples) :] for s in run.series]
    temperatures = {s.element: (t, p) for s, t, p in zip(run.series, times, predicted) if s.quantity == "temperature"}
    switches = np.array([run.translation.start, *run.translation.drive.switches()])
    found = []
    for series, at, values in zip(run.series, times, predicted):
        coils = _coils(model, series.quantity, series.element)
        warm = np.mean([np.interp(at, *c) for n, c in temperatures.items() if n in coils or not coils], axis=0)
        columns = [
            warm,
            np.gradient(warm, at),
            values,
            _drive(model, number, coils, at),
            at - switches[np.maximum(np.searchsorted(switches, at, side="right") - 1, 0)],
            at,
        ]
        residuals = (series.channel.values[-len(series.samples) :] - values) / series.channel.deviation
        found.append(
            Course(series.channel.name, series.quantity, at, residuals, np.stack(columns, axis=1), series.used)
        )
    return found


def _coils(model: CoilNetworkModel, quantity: str, element: int) -> Sequence[int]:
    """Coils that a channel belongs to; none: all."""
    axis, layout = QUANTITIES[quantity].axis, model.coils
    if axis == "coil":
        return (element,)
    return range(layout.first[element], layout.first[element + 1]) if axis == "string" else ()


def _drive(model: CoilNetworkModel, number: int, coils: Sequence[int], at: Array) -> Array:
    """Voltage of the coils' supply, power of the coil, or temperature of the surroundings where neither drives it."""
    drive, layout = model.runs[number].translation.drive, model.coils
    programme = drive.voltage or drive.power or drive.ambient
    if programme is drive.power and not np.any(programme.values):
        programme = drive.ambient
    values = _at(programme, at)
    if values.ndim == 1:
        return values
    if programme is drive.voltage:
        column = int(layout.string_of_coil[coils[0]]) if coils else 0
        return np.asarray(values[:, min(column, values.shape[1] - 1)])
    return np.asarray(values[:, coils[0]] if coils else values.sum(axis=1))


def _at(programme: Programme, at: Array) -> Array:
    if programme.is_linear:
        columns = programme.values.reshape(len(programme.times), -1).T
        values = np.stack([np.interp(at, programme.times, c) for c in columns], axis=-1)
        return values.reshape(len(at), *programme.values.shape[1:])
    index = np.maximum(np.searchsorted(programme.times, at, side="right") - 1, 0)
    return np.asarray(programme.values[index], dtype=np.float64)
