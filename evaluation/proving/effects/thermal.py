"""Thermal effects."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from evaluation.proving.effects.effect import Effect, Now
from evaluation.proving.rig import Array

STEFAN_BOLTZMANN = 5.670374419e-8  # [W/m^2/K^4], CODATA 2018


class LatentHeat(Effect):
    identifier = "latent_heat"
    unit = "thermal"
    law = "heat = -latent * d(phase)"
    places = ("all", "all", "string", "coil")
    same_parameters = ("latent",)
    strengths = {"latent": (0.15, 1.1)}

    def latent(self) -> Array:
        return self.parameters["latent"] * self.place.amount


class SecondMass(Effect):
    identifier = "second_mass"
    unit = "thermal"
    law = "heat = -g * (T - mass); C2 * d(mass) = g * (T - mass)"
    places = ("all", "all", "string", "coil")
    same_parameters: ClassVar[tuple[str, ...]] = ("g", "C2")
    strengths = {"g": (0.0004, 0.005), "C2": (0.01, 0.08)}
    _loss = 0.0

    def begin(self, now: Now) -> None:
        self._mass = now.temperature.copy()
        self._loss = self.parameters.get("loss", 0.0)

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        g = self.parameters["g"] * self.place.amount[:, None]
        return g * (self._mass[:, None] - wire), np.broadcast_to(-g, wire.shape)

    def advance(self, now: Now) -> None:
        g, capacity = self.parameters["g"], self.parameters["C2"]
        rate = (g + self._loss) / capacity
        rest = (g * now.temperature + self._loss * now.ambient) / (g + self._loss)
        self._mass = rest + (self._mass - rest) * np.exp(-rate * now.size)


class LossySecondMass(SecondMass):
    identifier = "lossy_second_mass"
    law = "heat = -g * (T - mass); C2 * d(mass) = g * (T - mass) - loss * (mass - T_ambient)"
    same_parameters = ("g", "C2", "loss")
    # Its equation is that of a mass without loss beside an h A that is greater by g * loss / (g + loss): by 6 to 11 %
    # (weak), up to 22 % and up to 43 %, of which a calibration takes 5 % for granted. The weak one is a second mass.
    strengths = {"g": (0.001, 0.006), "C2": (0.02, 0.1), "loss": (0.001, 0.01)}


class SharedMass(Effect):
    identifier = "shared_mass"
    unit = "thermal"
    law = "heat = -g * (T - chassis); C_chassis * d(chassis) = sum(g * (T - chassis)) - loss * (chassis - T_ambient)"
    places = ("all", "string")
    same_parameters = ("g", "C_chassis", "loss")
    strengths = {"g": (0.0008, 0.005), "C_chassis": (1.0, 5.0), "loss": (0.02, 0.04)}

    def begin(self, now: Now) -> None:
        self._chassis = float(now.temperature.mean())

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        g = self.parameters["g"] * self.place.amount[:, None]
        return g * (self._chassis - wire), np.broadcast_to(-g, wire.shape)

    def advance(self, now: Now) -> None:
        g, loss = self.parameters["g"] * self.place.amount, self.parameters["loss"]
        total = float(g.sum()) + loss
        rest = (float(g @ now.temperature) + loss * float(now.ambient.mean())) / total
        decay = np.exp(-total / self.parameters["C_chassis"] * now.size)
        self._chassis = rest + (self._chassis - rest) * decay


class Radiation(Effect):
    identifier = "radiation"
    unit = "thermal"
    law = "heat = -emissivity_area * 5.670374419e-8 * (T**4 - T_ambient**4)"
    places = ("all", "all", "string", "coil")
    same_parameters = ("emissivity_area",)
    strengths = {"emissivity_area": (1.5e-4, 8e-4)}

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        factor = STEFAN_BOLTZMANN * self.parameters["emissivity_area"] * self.place.amount[:, None]
        return -factor * (wire**4 - now.ambient[:, None] ** 4), -4.0 * factor * wire**3


class TemperatureDependentConvection(Effect):
    identifier = "temperature_dependent_convection"
    unit = "thermal"
    law = "heat = -hA * slope * abs(T - T_ambient) * (T - T_ambient)"
    places = ("all", "all", "string", "coil")
    same_parameters = ("slope",)
    strengths = {"slope": (0.002, 0.012)}
    #: h A of one coil [W/K]; set with the rig.
    conductance: Array

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        factor = self.parameters["slope"] * (self.conductance * self.place.amount)[:, None]
        over = wire - now.ambient[:, None]
        return -factor * np.abs(over) * over, -2.0 * factor * np.abs(over)


class ChassisInsulation(Effect):
    identifier = "chassis_insulation"
    unit = "thermal"
    law = "heat = hA * share * (T - T_ambient)"
    places = ("coil", "string")
    same_parameters = ("share",)
    strengths = {"share": (0.15, 0.4)}

    def convection(self, now: Now, factor: Array) -> None:
        factor *= 1.0 - self.parameters["share"] * self.place.amount


class InsulationWhenOff(Effect):
    identifier = "insulation_when_off"
    unit = "thermal"
    law = "heat = hA * share * (T - T_ambient) * is_off"
    places = ("all", "all", "string", "coil")
    same_parameters = ("share",)
    strengths = {"share": (0.08, 0.5)}

    def convection(self, now: Now, factor: Array) -> None:
        factor *= np.where(now.power <= 1e-9, 1.0 - self.parameters["share"] * self.place.amount, 1.0)


class Draught(Effect):
    identifier = "draught"
    unit = "thermal"
    law = "heat = -hA * amount * (T - T_ambient) * step(t - instant)"
    places = ("all", "string", "coil")
    same_parameters = ("amount", "instant")
    strengths = {"amount": (0.04, 0.5)}
    is_sudden = True
    is_of_a_day = True

    def convection(self, now: Now, factor: Array) -> None:
        if now.time >= self.parameters["instant"]:
            factor *= 1.0 + self.parameters["amount"] * self.place.amount


class UnevenCooling(Effect):
    identifier = "uneven_cooling"
    unit = "thermal"
    law = "heat = -hA * amount * (T - T_ambient)"
    places = ("row_gradient", "column_gradient")
    same_parameters = ("amount",)
    strengths = {"amount": (0.08, 0.3)}
    signed = "amount"

    def convection(self, now: Now, factor: Array) -> None:
        factor *= 1.0 + self.parameters["amount"] * self.place.amount


class NeighbourHeat(Effect):
    identifier = "neighbour_heat"
    unit = "thermal"
    law = "heat_a = -0.5 * (g_a + g_b) * (T_a - T_b); heat_b = -heat_a"
    places = ("all",)
    same_parameters = ("g",)
    strengths = {"g": (0.0006, 0.004)}
    #: Pairs of coils that touch, shape (pairs, 2); set with the rig.
    pairs: np.ndarray[tuple[int, int], np.dtype[np.int64]]

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array]:
        amount = self.parameters["g"] * self.place.amount
        a, b = self.pairs.T
        g = 0.5 * (amount[a] + amount[b])
        # A neighbour's warmth is that of the step's begin; a coil's own loss to it is taken where it acts.
        heat, slope = np.zeros_like(wire), np.zeros_like(amount)
        for here, there in ((a, b), (b, a)):
            np.add.at(heat, here, g[:, None] * (now.temperature[there, None] - wire[here]))
            np.add.at(slope, here, -g)
        return heat, np.broadcast_to(slope[:, None], wire.shape)


class AmbientDrift(Effect):
    identifier = "ambient_drift"
    unit = "thermal"
    law = "T_ambient = T_ambient_0 + drift * t"
    places = ("all",)
    same_parameters = ("drift",)
    strengths = {"drift": (0.004, 0.04)}
    signed = "drift"

    def surroundings(self, now: Now, ambient: Array) -> None:
        ambient += self.parameters["drift"] * self.place.amount * (now.time + 0.5 * now.size)


class AmbientStep(Effect):
    identifier = "ambient_step"
    unit = "thermal"
    law = "T_ambient = T_ambient_0 + step_size * step(t - instant)"
    places = ("all", "string")
    same_parameters = ("step_size", "instant")
    strengths = {"step_size": (0.4, 5.0)}
    signed = "step_size"
    is_sudden = True
    is_of_a_day = True

    def surroundings(self, now: Now, ambient: Array) -> None:
        if now.time >= self.parameters["instant"]:
            ambient += self.parameters["step_size"] * self.place.amount


EFFECTS: tuple[type[Effect], ...] = (
    LatentHeat,
    SecondMass,
    LossySecondMass,
    SharedMass,
    Radiation,
    TemperatureDependentConvection,
    ChassisInsulation,
    InsulationWhenOff,
    Draught,
    UnevenCooling,
    NeighbourHeat,
    AmbientDrift,
    AmbientStep,
)
