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
    """

    electrical: float
    stored: float
    convected: float

    @property
    def residual(self) -> float:
        """(stored + convected - electrical) / largest of them; 0 where nothing flowed."""
        scale = max(abs(self.electrical), abs(self.stored), abs(self.convected))
        return (self.stored + self.convected - self.electrical) / scale if scale else 0.0


class EnergyMeter:
    """Adds up the power that flows into every actuator that reports its energies.

    Args:
        system: The system; units with `power` in and `stored_energy` and `convected_energy` out are metered.
    """

    def __init__(self, system: System) -> None:
        wanted = {"power", "stored_energy", "convected_energy"}
        self.units = [u for u in system.units.values() if wanted <= set(u.variables)]
        self.electrical = 0.0

    def add_step(self, size: float) -> None:
        """Account for a step of `size` [s] that has just been made."""
        for unit in self.units:
            self.electrical += float(np.sum(unit.get("power"))) * size

    def balance(self) -> EnergyBalance | None:
        """Balance now, or None where no unit reports its energies."""
        if not self.units:
            return None
        total = {n: sum(float(np.sum(u.get(n))) for u in self.units) for n in ("stored_energy", "convected_energy")}
        return EnergyBalance(self.electrical, total["stored_energy"], total["convected_energy"])
