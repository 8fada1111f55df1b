"""What drives a network: supply, ambient and prescribed quantities on a grid of steps."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from diagnosis.models.coil_network.kernel.layout import Array

#: Values within a fifth of each other are alike: their variance is at most a hundredth of their square (range R: at
#: most R^2 / 4), so that a law that goes with the square of a course feels its mean to 1 %.
ALIKE = 0.2


@dataclass(frozen=True)
class Programme:
    """A quantity over time.

    Args:
        times: Instants [s], rising, shape (points,).
        values: Shape (points,) or (points, elements), SI.
        is_linear: Interpolated between the points; otherwise held from each point to the next.
    """

    times: Array
    values: Array
    is_linear: bool = False

    @staticmethod
    def constant(value: float | Array) -> Programme:
        """The same at all times."""
        return Programme(np.zeros(1), np.asarray(value, dtype=np.float64)[None])

    def over(self, begin: Array, end: Array) -> Array:
        """Value that stands for each step: held from its begin or, if linear, at its middle; shape (steps, ...).

        The co-simulation's sources do the same (cosim/programme.py), so that a ramp keeps its integral.
        """
        if not self.is_linear:
            # A hair later than the begin: grids made in floating point may lie a rounding error before a jump.
            index = np.searchsorted(self.times, begin + 1e-6 * (end - begin), side="right") - 1
            return np.asarray(self.values[np.maximum(index, 0)], dtype=np.float64)
        middle = 0.5 * (begin + end)
        columns = self.values.reshape(len(self.times), -1).T
        values = np.stack([np.interp(middle, self.times, column) for column in columns], axis=-1)
        return values.reshape(len(middle), *self.values.shape[1:])


@dataclass(frozen=True)
class CoilNetworkInputs:
    """Grid of steps and what drives the network over it; make it with `on_grid`.

    Args:
        time: Ends of the steps [s], the start first, shape (steps + 1,), rising.
        ambient: [K], shape (steps,).
        voltage: Of every source [V], shape (steps, sources); none where power is given.
        power: In every coil [W], shape (steps, coils), in place of a circuit.
        temperature: Of every coil [K], shape (steps + 1, coils), in place of the heat balance (a unit driven alone).
        is_switch: Whether voltage or power jumps at the begin of each step, shape (steps,).
    """

    time: Array
    ambient: Array
    voltage: Array | None
    power: Array | None
    temperature: Array | None
    is_switch: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Drive:
    """Programmes that drive a network.

    Args:
        ambient: Temperature of the surroundings [K], no second dimension.
        voltage: Supply [V]: no second dimension for a common supply, else (points, strings).
        power: [W], (points, coils).
        temperature: [K], (points, coils), taken as linear between its points.
    """

    ambient: Programme
    voltage: Programme | None = None
    power: Programme | None = None
    temperature: Programme | None = None

    def thinned(self, span: float) -> Drive:
        """The same with neighbouring values of a recorded course that are alike in place of one: their mean.

        What a heater takes is the mean of its power, what a coil takes the mean square of its voltage. Values that are
        not `ALIKE` stay apart, so that a switch stays where it is.

        Args:
            span: Longest time over which a mean is taken [s].
        """
        voltage = None if self.voltage is None else _merged(self.voltage, span, is_squared=True)
        power = None if self.power is None else _merged(self.power, span)
        return Drive(_merged(self.ambient, span), voltage, power, self.temperature)

    def switches(self) -> list[float]:
        """Instants at which a programme that is held jumps [s], those of linear ones at which it bends."""
        programmes = (self.ambient, self.voltage, self.power)
        return sorted({float(t) for p in programmes if p is not None for t in p.times[1:]})

    def on_grid(self, time: Array) -> CoilNetworkInputs:
        """Inputs over given steps.

        Args:
            time: Ends of the steps [s], the start first, shape (steps + 1,), rising.

        Raises:
            ValueError: The grid is not rising or a programme holds values that are not finite.
        """
        time = np.ascontiguousarray(time, dtype=np.float64)
        if time.ndim != 1 or time.size < 2 or not np.all(np.diff(time) > 0.0):
            raise ValueError("the grid needs at least one step, and rising times")
        begin, end = time[:-1], time[1:]
        is_switch = np.zeros(begin.size, dtype=bool)
        is_switch[0] = True
        sampled: dict[str, Array | None] = {}
        for name, programme in (("ambient", self.ambient), ("voltage", self.voltage), ("power", self.power)):
            values = None if programme is None else programme.over(begin, end)
            if values is not None and not np.isfinite(values).all():
                raise ValueError(f"the programme of {name} holds a value that is not finite")
            sampled[name] = values
            if values is not None and programme is not None and not programme.is_linear:
                rows = values.reshape(begin.size, -1)
                is_switch[1:] |= np.any(rows[1:] != rows[:-1], axis=1)
        ambient, voltage = sampled["ambient"], sampled["voltage"]
        assert ambient is not None
        given = None if self.temperature is None else _at(self.temperature, time)
        return CoilNetworkInputs(
            time,
            ambient,
            None if voltage is None else voltage.reshape(begin.size, -1),
            sampled["power"],
            given,
            is_switch,
        )


def _merged(programme: Programme, span: float, is_squared: bool = False) -> Programme:
    """A held programme with means of values that are alike, each over at most `span` [s]."""
    times = programme.times
    if programme.is_linear or len(times) < 3:
        return programme
    values = programme.values.reshape(len(times), -1)
    begins, low, high = [0], values[0], values[0]
    for i in range(1, len(times) - 1):
        lower, higher = np.minimum(low, values[i]), np.maximum(high, values[i])
        is_alike = np.all(higher - lower <= ALIKE * np.minimum(np.abs(lower), np.abs(higher)))
        if is_alike and times[i + 1] - times[begins[-1]] <= span * (1.0 + 1e-9):
            low, high = lower, higher
        else:
            begins.append(i)
            low = high = values[i]
    begins.append(len(times) - 1)
    lasts = np.append(np.diff(times), 1.0)[:, None]
    parts = np.add.reduceat(lasts * (values**2 if is_squared else values), begins)
    means = parts / np.add.reduceat(lasts, begins)
    if is_squared:
        means = np.sqrt(means) * np.sign(values[begins])
    return Programme(times[begins], means.reshape(len(begins), *programme.values.shape[1:]))


def _at(programme: Programme, time: Array) -> Array:
    columns = programme.values.reshape(len(programme.times), -1).T
    return np.stack([np.interp(time, programme.times, column) for column in columns], axis=-1)


def grid(start: float, stop: float, step: float, switches: Sequence[float] = ()) -> Array:
    """Ends of steps of about `step` [s], with every switch on the end of a step.

    Args:
        start: First instant [s].
        stop: Last instant [s].
        step: Longest step [s].
        switches: Instants at which an input jumps [s]; those outside are left out.
    """
    inner = sorted({float(v) for v in switches if start < v < stop})
    knots = [start, *inner, stop]
    parts = []
    for low, high in itertools.pairwise(knots):
        count = max(1, int(np.ceil((high - low) / step - 1e-9)))
        parts.append(low + (high - low) / count * np.arange(count))
    return np.concatenate([*parts, [stop]])
