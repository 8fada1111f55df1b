"""Residuals of one quantity of one recording on its sample times, with all that is needed to test them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.locate.fitted import Fitted
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import QUANTITIES
from diagnosis.models.coil_network.runs import ZERO, Series, deviation

#: Lags after which a sensor has followed a jump (to 5 %).
SETTLED = 3.0


@dataclass(frozen=True)
class Noise:
    """What the sensor of a recorded input brings into residuals.

    Args:
        source: What several channels share: draws of one source are the same for all.
        members: Numbers of the channels that it reaches, shape (members,).
        factor: Residuals, in deviations, per independent draw, shape (samples, members, draws).
    """

    source: tuple[object, ...]
    members: AnyArray
    factor: Array


@dataclass(frozen=True)
class Panel:
    """One quantity of one recording.

    Residuals, columns and noise are in deviations of the channel's own sensor.

    Args:
        recording: Number of the recording, from 0.
        quantity: Of the network.
        times: Union of the sample times [s], shape (samples,).
        channels: Numbers of its channels in the layout, shape (elements,).
        elements: Coil, string (or 0 for the supply) of each, shape (elements,).
        deviation: Of each reading, SI, shape (samples, elements).
        residual: Measured less simulated, 0 where not used, shape (samples, elements).
        used: Shape (samples, elements).
        columns: Derivative of the residual by the parameters, shape (samples, elements, parameters).
        noise: What recorded inputs bring in.
        respond: Number of an element to the response of its channel to the unknown input of its equation, shape
            (samples, steps), SI; None where the unit has none.
    """

    recording: int
    quantity: str
    times: Array
    channels: AnyArray
    elements: AnyArray
    deviation: Array
    residual: Array
    used: AnyArray
    columns: Array
    noise: tuple[Noise, ...] = ()
    respond: Callable[[int], Array] | None = None

    def less(self, change: Array) -> Panel:
        """The same where the simulation gives more by `change` (samples, elements), SI."""
        return replace(self, residual=np.where(self.used, self.residual - change / self.deviation, 0.0))

    def place(self, coil_or_string: int) -> int | None:
        """Number of the channel of an element here, or None."""
        found = np.flatnonzero(self.elements == coil_or_string)
        return int(found[0]) if found.size else None


def panels(model: Fitted, quantity: str) -> list[Panel]:
    """Residuals of the closed simulation, every recording that has the quantity.

    Args:
        model: Recalibrated.
        quantity: Of the network.
    """
    fit, rows = model.fit, model.fit.columns.values
    found, begin, number = [], 0, 0
    for recording, run in enumerate(model.network.runs):
        members = []
        for series in run.series:
            end = begin + len(series.samples)
            if series.quantity == quantity:
                members.append((series, slice(begin, end), number))
            begin, number = end, number + 1
        if not members:
            continue
        shape = (len(run.times[quantity]), len(members))
        residual, used = np.zeros(shape), np.zeros(shape, dtype=bool)
        columns = np.zeros((*shape, rows.shape[1]))
        sizes = np.ones(shape)
        for k, (series, span, channel) in enumerate(members):
            counted = series.used & _is_settled(series, run.inputs)
            used[series.samples, k] = counted
            own = _with_zero(rows[span], series) * fit.widths
            residual[series.samples, k] = np.where(counted, _with_zero(fit.residuals[span], series), 0.0)
            columns[series.samples, k] = np.where(counted[:, None], own, 0.0)
            sizes[:, k] = deviation(series.channel) * np.sqrt(model.inflation[channel])
        elements = np.array([s.element for s, _, _ in members])
        channels = np.array([n for _, _, n in members])
        noise = (_zeros(recording, quantity, used, [series for series, _, _ in members]),)
        found.append(
            Panel(recording, quantity, run.times[quantity], channels, elements, sizes, residual, used, columns, noise)
        )
    return found


def _with_zero(values: Array, series: Series) -> Array:
    """Residuals or columns, shape (samples, ...), as they are where a channel's unknown zero is not whitened away.

    See `diagnosis.models.coil_network.runs.Run`: it takes a share of the mean away, by which the mean shrinks to
    1 / sqrt(1 + n ZERO^2) of itself.
    """
    count = max(int(np.count_nonzero(series.used)), 1)
    grown = np.sqrt(1.0 + count * ZERO**2) - 1.0 if series.channel.bias_bound == 0.0 else 0.0
    mean = values[series.used].sum(axis=0) / count
    used = series.used.reshape((-1, *(1,) * (values.ndim - 1)))
    return np.asarray(values + used * mean * grown, dtype=np.float64)


def _zeros(recording: int, quantity: str, used: AnyArray, members: Sequence[Series]) -> Noise:
    """The unknown zero of each channel as noise that is the same at all times."""
    sizes = np.array([ZERO if s.channel.bias_bound == 0.0 else 0.0 for s in members])
    count = len(members)
    return Noise(("zero", recording, quantity), np.arange(count), used[:, :, None] * np.diag(sizes))


def _is_settled(series: Series, inputs: CoilNetworkInputs) -> Array:
    """Which samples of a flow lie so far from a jump that neither clock nor lag of its sensor matters."""
    found = np.ones(len(series.samples), dtype=bool)
    switches = inputs.time[:-1][inputs.is_switch]
    if not QUANTITIES[series.quantity].is_flow or len(switches) > 0.2 * len(series.samples):
        return found  # a course recorded as an input always jumps
    reach = series.channel.offset_bound + SETTLED * series.channel.lag_bound
    last = np.searchsorted(switches, series.times, side="right") - 1
    next_one = np.minimum(last + 1, len(switches) - 1)
    found &= ~((series.times >= switches[last]) & (series.times - switches[last] < reach))
    near = np.abs(switches[next_one] - series.times) < series.channel.offset_bound
    return np.asarray(found & ~near)


def thinned(panel: Panel, most: int) -> Panel:
    """At most `most` sample times: means of neighbours, with the deviation that a mean has."""
    every = -(-len(panel.times) // most)
    if every == 1:
        return panel
    count = -(-len(panel.times) // every)
    group = np.arange(len(panel.times)) // every
    weight = np.zeros((count, panel.used.shape[1]))
    np.add.at(weight, group, panel.used.astype(np.float64))
    # A mean of n samples has the deviation 1 / sqrt(n); divided by it, a sum over sqrt(n) is left.
    root = np.sqrt(np.maximum(weight, 1.0))

    def together(values: Array) -> Array:
        total = np.zeros((count, *values.shape[1:]))
        np.add.at(total, group, values)
        return np.asarray(total / root.reshape(root.shape + (1,) * (values.ndim - 2)))

    times = np.bincount(group, panel.times) / np.bincount(group)
    return replace(
        panel,
        times=times,
        residual=together(panel.residual),
        used=weight > 0,
        columns=together(panel.columns),
        deviation=panel.deviation[:1] / root,
    )
