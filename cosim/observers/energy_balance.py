"""Energy over a run: electrical in = stored in the coils + given to the air."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.system import System


@dataclass(frozen=True)
class EnergyBalance:
    """Energies since the start [J].

    Args:
        electrical: Integral of the power of all coils, exact because power is constant over a macro-step.
        stored: Heat stored above the initial temperature, as the actuators report it.
        convected: Heat given to the surroundings, as the actuators report it.
        largest: Largest of the three at any output time.
    """

    electrical: float
    stored: float
    convected: float
    largest: float

    @property
    def residual(self) -> float:
        """(stored + convected - electrical) / largest; 0 where nothing flowed.

        After a closed cycle all three may end near zero; what flowed in between is the measure.
        """
        return (self.stored + self.convected - self.electrical) / self.largest if self.largest else 0.0


class EnergyMeter:
    """Adds up the power that flows into every actuator that reports its energies.

    Args:
        system: The system; units with `power` in and `stored_energy` and `convected_energy` out are metered.
    """

    def __init__(self, system: System) -> None:
        wanted = {"power", "stored_energy", "convected_energy"}
        self.units = [u for u in system.units.values() if wanted <= set(u.variables)]
        self.electrical = 0.0
        self.largest = 0.0

    def add_step(self, size: float) -> None:
        """Account for a step of `size` [s] that has just been made."""
        for unit in self.units:
            self.electrical += float(np.sum(unit.get("power"))) * size

    def note_largest(self) -> None:
        """Keep the largest energy so far."""
        self.largest = max(self.largest, abs(self.electrical), *map(abs, self._reported()))

    def balance(self) -> EnergyBalance | None:
        """Balance now, or None where no unit reports its energies."""
        if not self.units:
            return None
        self.note_largest()
        return EnergyBalance(self.electrical, *self._reported(), self.largest)

    def _reported(self) -> tuple[float, float]:
        stored, convected = (
            sum(float(np.sum(unit.get(name))) for unit in self.units) for name in ("stored_energy", "convected_energy")
        )
        return stored, convected
