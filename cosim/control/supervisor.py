"""A supervisor over any controller: it keeps a temperature below its limit, also where a thermometer fails.

While a thermometer is right, the limit holds by this bound: heat can raise a coil by at most `fastest_rise` times the
share of full heat, so its temperature now is at most its reading, plus what was put in since that reading was true
(delay and lag), and until the next sample it rises by at most that rate. The command is lowered until the sum stays
below limit less margin. Losses are left out, so the bound is on the safe side.

A thermometer is taken for failed, and its group is switched off for good, where its reading
- lies outside what it can read, or is at one of these ends (an open thermocouple reads full scale);
- has not changed by a single bit for `frozen_after` although noise or rounding should move it;
- is lower by `tolerance` than the coldest coil would be: `slowest_rise`, cooled with `cooling_time`, seen through the
  same delay and lag (a thermometer that fell off).
"""

from __future__ import annotations

import math
from collections.abc import MutableMapping
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array

#: What `alarm` says of a group.
NO_ALARM, LIMITED, OUT_OF_RANGE, FROZEN, NO_RESPONSE = 0, 1, 2, 3, 4


@dataclass(frozen=True)
class Supervisor:
    """Bounds of the plant and its thermometers; temperatures in the unit of what is measured.

    Args:
        limit: Highest temperature allowed.
        margin: Largest error of a right thermometer (noise, bias, rounding).
        fastest_rise: Rise at full command of the coil that heats fastest, without losses [unit/s].
        slowest_rise: The same of the coil that heats slowest; 0: no check of the response.
        cooling_time: Shortest time constant of cooling [s].
        ambient: Lowest temperature of the surroundings.
        tolerance: Smallest distance from the coldest coil that is a failure.
        delay: From a temperature to its reading [s]: the sensor's delay and its sampling.
        lag: Time constant of the sensor [s].
        lowest: Smallest reading that can be right.
        highest: Largest reading that can be right.
        frozen_after: Time without any change after which a reading is frozen [s]; 0: no check.
    """

    limit: float
    margin: float
    fastest_rise: float
    slowest_rise: float = 0.0
    cooling_time: float = 1.0
    ambient: float = 0.0
    tolerance: float = math.inf
    delay: float = 0.0
    lag: float = 0.0
    lowest: float = -math.inf
    highest: float = math.inf
    frozen_after: float = 0.0

    def begin(self, elements: int, step: float) -> dict[str, Array]:
        """Memory at the start, every coil at the ambient temperature.

        Args:
            elements: Thermometers.
            step: Interval between samples [s].
        """
        waiting = math.ceil(self.delay / step - 1e-9)
        return {
            "waiting": np.zeros((waiting, elements)),
            "lagging": np.zeros(elements),
            "coldest": np.full(elements, self.ambient),
            "seen": np.full((waiting + 1, elements), self.ambient),
            "last": np.full(elements, np.nan),
            "unchanged": np.zeros(elements),
            "failed": np.zeros(elements),
        }

    def check(self, measured: Array, memory: MutableMapping[str, Array], step: float) -> Array:
        """Thermometers that fail by now, as codes, shape (elements,); a failure stays."""
        failed = memory["failed"]
        same = measured == memory["last"]
        memory["unchanged"] = np.where(same, memory["unchanged"] + step, 0.0)
        memory["last"] = measured.copy()
        if self.slowest_rise > 0.0:
            late = measured < memory["seen"][0] - self.tolerance
            failed = np.where((failed == NO_ALARM) & late, NO_RESPONSE, failed)
        if self.frozen_after > 0.0:
            frozen = memory["unchanged"] >= self.frozen_after - 1e-9
            failed = np.where((failed == NO_ALARM) & frozen, FROZEN, failed)
        outside = ~((measured > self.lowest) & (measured < self.highest))
        memory["failed"] = np.where((failed == NO_ALARM) & outside, OUT_OF_RANGE, failed)
        return memory["failed"]

    def allowed(self, measured: Array, memory: MutableMapping[str, Array], step: float) -> Array:
        """Share of full heat, 0 to 1, that keeps every element below the limit until the next sample."""
        highest = measured + self.margin + memory["waiting"].sum(axis=0) + memory["lagging"]
        return np.asarray(np.clip((self.limit - highest) / (self.fastest_rise * step), 0.0, 1.0))

    def heated(self, share: Array, memory: MutableMapping[str, Array], step: float) -> None:
        """A share of full heat is given until the next sample; shape (elements,)."""
        rise = self.fastest_rise * share * step
        # What leaves the delay has still to come through the lag: y' = (x - y) / lag.
        entering = rise
        if len(memory["waiting"]):
            entering = memory["waiting"][0].copy()
            memory["waiting"] = np.vstack([memory["waiting"][1:], rise])
        decay = math.exp(-step / self.lag) if self.lag > 0.0 else 0.0
        # As if all of it came at the end of the step: no less than what the lag still hides.
        memory["lagging"] = memory["lagging"] * decay + (entering if self.lag > 0.0 else 0.0)
        if self.slowest_rise > 0.0:
            before, now = memory["coldest"], self._coldest(share, memory["coldest"], step)
            memory["coldest"] = now
            # The lower end of the step, so that what is seen stays below what a right thermometer reads.
            seen = decay * memory["seen"][-1] + (1.0 - decay) * (np.minimum(before, now) if self.lag > 0.0 else now)
            memory["seen"] = np.vstack([memory["seen"][1:], seen])

    def _coldest(self, share: Array, coldest: Array, step: float) -> Array:
        """Exact step of C T' = P - G (T - ambient) with constant heat."""
        decay = math.exp(-step / self.cooling_time)
        limit = self.ambient + self.slowest_rise * share * self.cooling_time
        return np.asarray(limit + (coldest - limit) * decay)
