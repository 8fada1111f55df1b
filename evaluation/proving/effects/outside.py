"""Effects for which no catalogue has an entry: they exist in the truth alone."""

from __future__ import annotations

import numpy as np

from evaluation.proving.effects.effect import Effect, LoopChange, Now
from evaluation.proving.effects.electrical import REFERENCE
from evaluation.proving.network import Branches
from evaluation.proving.rig import Array


class PeltierJunction(Effect):
    """The joint of thermocouple and coil pumps heat in proportion to the current, not to its square.

    Source: L. D. Landau, E. M. Lifshitz, Electrodynamics of Continuous Media, section 26 (Peltier effect).
    """

    identifier = "peltier_junction"
    unit = "thermal"
    is_named = False
    law = "heat = pi_coefficient * I"
    places = ("all", "string", "coil")
    strengths = {"pi_coefficient": (0.05, 0.2)}
    signed = "pi_coefficient"

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        heat = self.parameters["pi_coefficient"] * self.place.amount * now.current
        return np.broadcast_to(heat[:, None], wire.shape), np.zeros_like(wire)


class WetFilm(Effect):
    """A film of water evaporates and takes its heat along until it is gone.

    Source: F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th ed., section 6.7 (evaporative cooling);
    vapour pressure by the Magnus formula, O. A. Alduchov, R. E. Eskridge, J. Appl. Meteorol. 35 (1996) 601-609.
    """

    identifier = "wet_film"
    unit = "thermal"
    is_named = False
    law = "heat = -2.43e6 * transfer * (p(T) - 0.5 * p(T_ambient)) while film > 0"
    places = ("all", "string")
    #: Film in kg, transfer in kg/s/Pa, of a coil.
    strengths = {"film": (1e-6, 3e-6), "transfer": (6e-13, 5e-12)}

    def begin(self, now: Now) -> None:
        self._film = self.parameters["film"] * np.ones_like(now.temperature)

    def _excess(self, temperature: Array, ambient: Array) -> Array:
        return _vapour_pressure(temperature) - 0.5 * _vapour_pressure(ambient)

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        wet = np.clip(self._film / 2e-8, 0.0, 1.0) * self.place.amount  # the last hundredth dries in islands
        factor = -2.43e6 * self.parameters["transfer"] * wet[:, None]
        ambient = now.ambient[:, None]
        slope = _vapour_pressure(wire) * 17.625 * 243.04 / (wire - 30.11) ** 2
        return factor * self._excess(wire, ambient), factor * slope

    def advance(self, now: Now) -> None:
        wet = np.clip(self._film / 2e-8, 0.0, 1.0)
        lost = self.parameters["transfer"] * wet * self._excess(now.temperature, now.ambient) * now.size
        self._film = np.maximum(self._film - lost, 0.0)


def _vapour_pressure(temperature: Array) -> Array:
    """[Pa]"""
    return 610.94 * np.exp(17.625 * (temperature - 273.15) / (temperature - 30.11))


class BoilingOnset(Effect):
    """Above a temperature a volatile residue boils off the surface and carries heat away.

    Source: W. M. Rohsenow's threshold of nucleate boiling, linearised above the onset.
    """

    identifier = "boiling_onset"
    unit = "thermal"
    is_named = False
    law = "heat = -g * max(T - T_onset, 0)"
    places = ("all", "string", "coil")
    strengths = {"g": (0.0012, 0.012)}
    ranges = {"T_onset": (316.0, 326.0)}  # [K]

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        g = self.parameters["g"] * self.place.amount[:, None]
        over = wire - self.parameters["T_onset"]
        return -g * np.maximum(over, 0.0), np.where(over > 0.0, -g, 0.0)


class MotionDraught(Effect):
    """A coil that moves fans itself: convection rises with the speed of its load."""

    identifier = "motion_draught"
    unit = "thermal"
    is_named = False
    law = "heat = -hA * fan * abs(d(extension)) * (T - T_ambient)"
    strengths = {"fan": (100.0, 1500.0)}  # [s/m]
    needs_load = True

    def convection(self, now: Now, factor: Array) -> None:
        factor *= 1.0 + self.parameters["fan"] * self.place.amount * np.abs(now.speed)


class StringLeak(Effect):
    """Worn insulation: current leaves a string in its middle, the more readily the higher the voltage (a varistor)."""

    identifier = "string_leak"
    unit = "electrical"
    is_named = False
    law = "I_lower = I - V_middle / R_leak * V / (3 V)"
    places = ("string",)
    strengths = {"R_leak": (60.0, 10.0)}

    def branches(self, now: Now, network: Branches) -> None:
        network.leak += self.place.amount[network.first] / self.parameters["R_leak"] * now.voltage / 3.0


class ContactVoltage(Effect):
    """An oxide film takes a constant voltage from its string, as a diode does.

    Source: R. Holm, Electric Contacts, 4th ed., chapter 27 (fritting voltage of films).
    """

    identifier = "contact_voltage"
    unit = "electrical"
    is_named = False
    law = "I_string = max(V - V_contact, 0) / R_string"
    places = ("string", "all")
    strengths = {"V_contact": (0.05, 0.6)}

    def branches(self, now: Now, network: Branches) -> None:
        network.drop += self.parameters["V_contact"] * self.place.amount[network.first]


class SlowSupply(Effect):
    """A supply that follows its set point with a time constant."""

    identifier = "slow_supply"
    unit = "electrical"
    is_named = False
    law = "tau * d(V) = V_set - V"
    places = ("supply",)
    strengths = {"tau": (0.15, 1.5)}

    def begin(self, now: Now) -> None:
        self._behind: float | Array = 0.0
        self._set: float | Array = 0.0
        self._time = 0.0

    def voltage(self, now: Now, voltage: float | Array) -> float | Array:
        self._behind = self._behind * float(np.exp(-max(now.moment - self._time, 0.0) / self.parameters["tau"]))
        self._behind = self._behind + self._set - voltage  # the terminals do not jump
        self._set, self._time = voltage, now.moment
        return voltage + self._behind


class AgeingResistance(Effect):
    """Resistance grows with the charge that has flowed, as by electromigration."""

    identifier = "ageing_resistance"
    unit = "electrical"
    is_named = False
    law = "R = R_0 * (1 + growth * charge)"
    places = ("all", "string", "coil")
    strengths = {"growth": (0.0015, 0.01)}  # [1/C]

    def begin(self, now: Now) -> None:
        self._charge = np.zeros_like(now.current)

    def advance(self, now: Now) -> None:
        self._charge = self._charge + now.current * now.size

    def branches(self, now: Now, network: Branches) -> None:
        network.coil *= 1.0 + self.parameters["growth"] * self.place.amount * self._charge


class RateDependentLoop(Effect):
    """Transformation temperatures move with the rate of heating: phase boundaries move with friction of their own."""

    identifier = "rate_dependent_loop"
    unit = "stiffness"
    is_named = False
    law = "shift = drag * d(T)"
    places = ("all", "string", "coil")
    strengths = {"drag": (0.5, 2.5)}  # [s]

    def loop(self, now: Now, change: LoopChange) -> None:
        change.shift += self.parameters["drag"] * self.place.amount * now.rate


class AgeingStiffness(Effect):
    """Precipitation above a temperature: the loop moves with the time spent hot."""

    identifier = "ageing_stiffness"
    unit = "stiffness"
    is_named = False
    law = "d(shift) = -speed * step(T - T_hot)"
    places = ("all", "coil")
    strengths = {"speed": (0.08, 0.3)}  # [K/s]
    ranges = {"T_hot": (316.0, 328.0)}  # [K]

    def begin(self, now: Now) -> None:
        self._hot = np.zeros_like(now.temperature)

    def advance(self, now: Now) -> None:
        self._hot = self._hot + now.size * (now.temperature > self.parameters["T_hot"])

    def loop(self, now: Now, change: LoopChange) -> None:
        change.shift -= self.parameters["speed"] * self.place.amount * self._hot


class MagneticPull(Effect):
    """Neighbouring turns attract each other with the square of the current.

    Source: Ampere's force law.
    """

    identifier = "magnetic_pull"
    unit = "mechanical"
    is_named = False
    law = "tension = load - pull * I**2"
    places = ("all", "string", "coil")
    strengths = {"pull": (0.3, 1.2)}  # [N/A^2]
    needs_load = True

    def load(self, now: Now, tension: Array) -> None:
        tension -= self.parameters["pull"] * self.place.amount * now.current**2


class StickAndRelease(Effect):
    """A link sticks until the missing force passes a threshold, then lets go all at once."""

    identifier = "stick_and_release"
    unit = "mechanical"
    is_named = False
    law = "extension holds until abs(tension - stiffness * extension) > hold, then springs to tension / stiffness"
    places = ("all", "coil", "string")
    strengths = {"hold": (0.1, 0.35)}  # [N]
    needs_load = True

    def length(self, now: Now, extension: Array, before: Array) -> None:
        missing = np.abs(extension - before) * now.stiffness
        is_held = (missing <= self.parameters["hold"] * self.place.amount) & (before > 0.0)
        extension[is_held] = before[is_held]


class SoftStop(Effect):
    """A cushion that a long coil runs into."""

    identifier = "soft_stop"
    unit = "mechanical"
    is_named = False
    law = "tension = stiffness * extension + cushion * max(extension - reach, 0)"
    places = ("all", "string", "coil")
    strengths = {"cushion": (100.0, 600.0)}
    ranges = {"reach": (0.0041, 0.0048)}  # [m]
    needs_load = True

    def length(self, now: Now, extension: Array, before: Array) -> None:
        cushion = self.parameters["cushion"] * self.place.amount
        over = np.maximum(extension - self.parameters["reach"], 0.0)
        extension -= cushion * over / (now.stiffness + cushion)


class TwoWaySquare(Effect):
    """Trained coils shorten with the square of their warmth."""

    identifier = "two_way_square"
    unit = "mechanical"
    is_named = False
    law = "extension = extension_0 - curve * (T - reference_temperature)**2"
    places = ("all", "coil", "string")
    strengths = {"curve": (2e-7, 1e-6)}
    needs_load = True

    def length(self, now: Now, extension: Array, before: Array) -> None:
        extension -= self.parameters["curve"] * self.place.amount * (now.temperature - REFERENCE) ** 2


EFFECTS: tuple[type[Effect], ...] = (
    PeltierJunction,
    WetFilm,
    BoilingOnset,
    MotionDraught,
    StringLeak,
    ContactVoltage,
    SlowSupply,
    AgeingResistance,
    RateDependentLoop,
    AgeingStiffness,
    MagneticPull,
    SoftStop,
    TwoWaySquare,
    StickAndRelease,
)
