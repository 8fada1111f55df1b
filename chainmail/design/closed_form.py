"""Closed forms of circuit and heat: what voltage, time and energy a row of coils needs. No simulation.

A string of n equal coils at a voltage U heats each with p = U^2 / (n^2 R); equation (3) of the paper then says
T = T_room + p / G (1 - exp(-G t / C)) with G = h A and C = rho V c_p.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """A row of coils in series.

    Args:
        coils: n.
        resistance: R of one coil [ohm].
        conductance: G of one coil [W/K].
        capacity: C of one coil [J/K].
        ambient: T_room [K].
        cooling_rate: Of a coil that is switched off, equation (5) [1/s].
    """

    coils: int
    resistance: float
    conductance: float
    capacity: float
    ambient: float
    cooling_rate: float = 0.14

    def power(self, voltage: float) -> float:
        """Of the whole row [W]."""
        return voltage**2 / (self.coils * self.resistance)

    def voltage_of(self, power: float) -> float:
        """Voltage at which the whole row takes a power [V]."""
        return math.sqrt(power * self.coils * self.resistance)

    def limit(self, voltage: float) -> float:
        """Temperature after long time [K], equation (4)."""
        return self.ambient + self.power(voltage) / self.coils / self.conductance

    def heating_time(self, voltage: float, temperature: float) -> float:
        """Time from T_room to a temperature [s]; infinite where the voltage never reaches it.

        >>> row = Row(6, 2.2, 0.0088065, 0.03956, 295.15)
        >>> round(row.limit(6.0) - 273.15, 1), round(row.heating_time(6.0, 343.15), 1)
        (73.6, 11.9)
        """
        share = (temperature - self.ambient) / (self.limit(voltage) - self.ambient) if voltage > 0.0 else math.inf
        if share >= 1.0:
            return math.inf
        return -self.capacity / self.conductance * math.log(1.0 - share)

    def holding_voltage(self, temperature: float) -> float:
        """Voltage that holds a temperature [V]."""
        return self.coils * math.sqrt(self.resistance * self.conductance * max(temperature - self.ambient, 0.0))

    def voltage_for(self, temperature: float, time: float) -> float:
        """Voltage that reaches a temperature from T_room in a time [V]."""
        share = 1.0 - math.exp(-self.conductance / self.capacity * time)
        return self.holding_voltage(self.ambient + (temperature - self.ambient) / share)

    def coasting_time(self, hot: float, hold: float) -> float:
        """Time in which a coil that is switched off cools from one temperature to another, equation (5) [s]."""
        return math.log((hot - self.ambient) / (hold - self.ambient)) / self.cooling_rate

    def heating_energy(self, voltage: float, temperature: float) -> float:
        """Energy to reach a temperature from T_room [J]; it falls with the voltage."""
        return self.power(voltage) * self.heating_time(voltage, temperature)


def heated_together(
    rows: Sequence[Row], temperatures: Sequence[float], voltage: float, power: float, longest: float
) -> tuple[float, ...] | None:
    """Voltages that bring rows to temperatures of their own in one time, the shortest that the limits allow [V].

    Heating energy falls with the voltage, so the shortest time is the cheapest.

    Args:
        rows: Heated rows.
        temperatures: Of each at the end [K].
        voltage: Greatest of a row [V].
        power: Greatest of all rows together [W]; may be infinite.
        longest: Time that there is [s].

    Returns:
        A voltage per row; None where even the longest time is too short.
    """

    def needed(time: float) -> list[float]:
        return [r.voltage_for(t, time) for r, t in zip(rows, temperatures)]

    def is_allowed(time: float) -> bool:
        volts = needed(time)
        return max(volts) <= voltage and sum(r.power(v) for r, v in zip(rows, volts)) <= power

    if longest <= 0.0 or not is_allowed(longest):
        return None
    low, high = 0.0, longest
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if middle > 0.0 and is_allowed(middle) else (middle, high)
    return tuple(needed(high))


def nearest_power(row: Row, temperature: float, time: float) -> float:
    """Least power of one row that reaches a temperature in a time [W]: what is possible where a request is not."""
    return row.power(row.voltage_for(temperature, time))
