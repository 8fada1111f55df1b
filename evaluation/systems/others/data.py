"""Recordings as other methods need them: states, what the equations leave, and a free run with what was learnt.

States that are not measured come from readings that a Gaussian kernel K smooths: the derivative of K * x is K * x'. For
linear equations f, K * x' - f(K * x, K * u) is then what they leave, smoothed, also where an input u jumps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue
from evaluation.systems.case import start
from evaluation.systems.rigs import Rig

#: Deviations of the kernel that smooths readings, in samples; a method tries each.
WINDOWS = (3.0, 8.0)
#: Samples at both ends that are left out: there the kernel sees no readings.
ENDS = 32
#: Steps of the integration between two readings.
INNER = 2
#: Deviations of the noise beyond which a free run has run away.
RUNAWAY = 1e4

#: Function of states and inputs, shape (points, states + inputs), to residual derivatives, shape (points, targets).
Learnt = Callable[[Array], Array]


@dataclass(frozen=True)
class Data:
    """One recording.

    Args:
        inputs: Shape (samples, inputs).
        readings: Shape (samples, channels).
        noise: Deviation of each channel, shape (channels,).
        states: Estimates, shape (samples, states).
        smooth: The inputs as the kernel smooths them, shape (samples, inputs).
        residuals: Derivatives of the targets less those of the equations, shape (samples, targets).
    """

    inputs: Array
    readings: Array
    noise: Array
    states: Array
    smooth: Array
    residuals: Array

    @property
    def features(self) -> Array:
        """States and inputs, shape (samples, states + inputs), without the ends."""
        return np.hstack([self.states, self.smooth])[ENDS:-ENDS]

    @property
    def learnt(self) -> Array:
        """Residuals of the same samples."""
        return self.residuals[ENDS:-ENDS]


def read(rig: Rig, folder: Path, window: float) -> Data:
    """A recording with estimates of states and of what the equations leave."""
    from scipy.ndimage import gaussian_filter1d

    data = yaml.safe_load((folder / "recording.yaml").read_text(encoding="utf-8"))
    table = np.loadtxt(folder / "data.csv", delimiter=",", skiprows=1)
    count = len(rig.inputs)
    inputs, readings = table[:, 1 : 1 + count], table[:, 1 + count :]
    noise = [PhysicalValue.parse(data["channels"][c]["noise"]) for c in rig.outputs]
    states = np.zeros((len(table), len(rig.states)))
    rates = np.zeros_like(states)
    for column, state in enumerate(rig.outputs.values()):
        course = [gaussian_filter1d(readings[:, column], window, order=d) / rig.step**d for d in range(3)]
        states[:, state], rates[:, state] = course[0], course[1]
        if rig.targets.get(state + 1) == "velocity":
            states[:, state + 1], rates[:, state + 1] = course[1], course[2]
    driven = gaussian_filter1d(inputs, window, axis=0)
    model = np.array([rig.rates(rig.numbers, x, u) for x, u in zip(states, driven)])
    residuals = (rates - model)[:, list(rig.targets)]
    return Data(inputs, readings, np.array([n.number for n in noise]), states, driven, residuals)


def free_run(rig: Rig, learnt: Learnt | None, data: Data) -> float:
    """Chi-square per reading of a free run; infinite where it runs away."""
    x, h = start(rig), rig.step / INNER
    targets = list(rig.targets)
    limit = 100.0 * (np.max(np.abs(data.states), axis=0) + 1.0)

    def rate(y: Array, u: Array) -> Array:
        found = rig.rates(rig.numbers, y, u)
        if learnt is not None:
            found[targets] += learnt(np.concatenate([y, u])[None])[0]
        return found

    states = [x]
    for u in data.inputs[:-1]:
        for _ in range(INNER):
            a = rate(x, u)
            b = rate(x + 0.5 * h * a, u)
            c = rate(x + 0.5 * h * b, u)
            x = x + h / 6.0 * (a + 2.0 * (b + c) + rate(x + h * c, u))
        if not np.isfinite(x).all() or (np.abs(x) > limit).any():
            return float("inf")
        states.append(x)
    course = np.array(states)[:, list(rig.outputs.values())]
    misfit = (data.readings - course) / data.noise
    return float(np.mean(np.minimum(np.abs(misfit), RUNAWAY) ** 2))
