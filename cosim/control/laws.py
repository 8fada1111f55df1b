"""Laws of controllers: from setpoint and measured value to what drives, one number per group.

A law is sampled: it is called once per sample, and its demand holds until the next. Its memory is a mapping of arrays,
one element per group, so that a run can be saved and continued.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cosim.unit.protocol import Array

#: Memory of a law: name to an array, shape (groups,).
Memory = MutableMapping[str, Array]


@dataclass(frozen=True)
class Sample:
    """What a law is given.

    Args:
        time: Simulated time [s].
        step: Time to the next sample [s].
        setpoint: Shape (groups,), in the unit of what is measured.
        measured: Shape (groups,), the same.
    """

    time: float
    step: float
    setpoint: Array
    measured: Array


class Law(Protocol):
    """From a sample to a demand. The demand is in the unit of the command, or in its square (`drive: squared`)."""

    def begin(self, groups: int) -> dict[str, Array]:
        """Memory at the start."""
        ...

    def demand(self, sample: Sample, memory: Memory, low: float, high: float) -> Array:
        """Demand of every group; the controller clips it to [low, high]. `memory` is changed in place."""
        ...


@dataclass(frozen=True)
class OnOff:
    """Full drive below the band, none above it, and what was there within it.

    Args:
        band: Width of the band around the setpoint.
    """

    band: float

    def begin(self, groups: int) -> dict[str, Array]:
        """Off."""
        return {"on": np.zeros(groups)}

    def demand(self, sample: Sample, memory: Memory, low: float, high: float) -> Array:
        """See `Law`."""
        error = sample.setpoint - sample.measured
        on = np.where(error > 0.5 * self.band, 1.0, np.where(error < -0.5 * self.band, 0.0, memory["on"]))
        memory["on"] = on
        return np.where(on > 0.0, high, low)


@dataclass(frozen=True)
class Pi:
    """Proportional-integral control, with feed-forward of what holds the setpoint.

    u = f (r - a) + K e + I, I' = K e / T_i, forward Euler. Anti-windup by conditional integration: I stands still while
    u is at a limit and e would drive it further (Astrom and Hagglund, Advanced PID Control, ISA 2006, section 3.5).

    Args:
        gain: K, demand per unit of the measured value.
        integral_time: T_i [s].
        feedforward: f, demand per unit of the measured value; 0: none.
        ambient: a, in the unit of the measured value.
    """

    gain: float
    integral_time: float
    feedforward: float = 0.0
    ambient: float = 0.0

    def begin(self, groups: int) -> dict[str, Array]:
        """No integral yet."""
        return {"integral": np.zeros(groups)}

    def demand(self, sample: Sample, memory: Memory, low: float, high: float) -> Array:
        """See `Law`."""
        error = sample.setpoint - sample.measured
        wanted = self.feedforward * (sample.setpoint - self.ambient) + self.gain * error + memory["integral"]
        winds_up = ((wanted >= high) & (error > 0.0)) | ((wanted <= low) & (error < 0.0))
        growth = self.gain * error * sample.step / self.integral_time
        memory["integral"] = memory["integral"] + np.where(winds_up, 0.0, growth)
        return wanted


@dataclass(frozen=True)
class Hold:
    """Heat to the setpoint, then hold lower, on the cooling branch of the hysteresis.

    A coil that has transformed stays stiff down to the cooling branch's transformation, far below the temperature that
    made it stiff: holding there costs less. A group that falls below `reheat_below` has lost its stiffness and is
    heated again; a setpoint at or below `hold_at` asks for no stiffness and is followed as it is.

    Args:
        hold_at: Temperature of the hold.
        reheat_below: Temperature below which a group is heated again.
        inner: Law that follows either temperature.
    """

    hold_at: float
    reheat_below: float
    inner: Pi | OnOff

    def begin(self, groups: int) -> dict[str, Array]:
        """Not heated yet."""
        return {"holding": np.zeros(groups), **self.inner.begin(groups)}

    def demand(self, sample: Sample, memory: Memory, low: float, high: float) -> Array:
        """See `Law`."""
        is_asked = sample.setpoint > self.hold_at
        has_reached = sample.measured >= sample.setpoint
        holding = np.where(memory["holding"] > 0.0, sample.measured >= self.reheat_below, has_reached) & is_asked
        memory["holding"] = holding.astype(np.float64)
        target = np.where(holding, self.hold_at, sample.setpoint)
        return self.inner.demand(Sample(sample.time, sample.step, target, sample.measured), memory, low, high)
