"""Electrical effects."""

from __future__ import annotations

import numpy as np

from evaluation.proving.effects.effect import Effect, Now
from evaluation.proving.hysteresis import CELSIUS
from evaluation.proving.network import Branches
from evaluation.proving.rig import Array

REFERENCE = 22.0 + CELSIUS  # [K]


def after(now: Now, instant: float) -> float:
    """Share of the step under way that lies after an instant."""
    return (
        float(np.clip((now.time + now.size - instant) / now.size, 0.0, 1.0)) if now.size else float(now.time >= instant)
    )


class _OfStrings(Effect):
    """An effect in the leads of strings: knows which."""

    unit = "electrical"

    def amount_of_strings(self, network: Branches) -> Array:
        """Factor on the strength at every string, shape (strings,)."""
        return np.asarray(self.place.amount[network.first])


class ContactResistance(_OfStrings):
    identifier = "contact_resistance"
    law = "R_string = R_string_0 + R_contact"
    places = ("string",)
    same_parameters = ("R_contact",)
    strengths = {"R_contact": (0.5, 3.0)}

    def branches(self, now: Now, network: Branches) -> None:
        network.lead += self.parameters["R_contact"] * self.amount_of_strings(network)


class LooseContact(_OfStrings):
    identifier = "loose_contact"
    law = "R_string = R_string_0 + R_contact * step(t - instant)"
    places = ("string",)
    same_parameters = ("R_contact", "instant")
    strengths = {"R_contact": (0.08, 3.0)}
    is_sudden = True

    def branches(self, now: Now, network: Branches) -> None:
        if now.time >= self.parameters["instant"]:
            network.lead += self.parameters["R_contact"] * self.amount_of_strings(network)


class SupplySourceResistance(Effect):
    identifier = "supply_source_resistance"
    unit = "electrical"
    law = "V_terminal = V - R_source * I_supply"
    places = ("supply",)
    same_parameters = ("R_source",)
    strengths = {"R_source": (0.1, 0.8)}

    def branches(self, now: Now, network: Branches) -> None:
        network.source += self.parameters["R_source"]


class SupplyCurrentLimit(Effect):
    identifier = "supply_current_limit"
    unit = "electrical"
    law = "I_supply = min(I_free, limit)"
    places = ("supply",)
    same_parameters = ("limit",)
    #: Share of the current of the highest level that is let through.
    strengths = {"share": (0.95, 0.65)}

    def branches(self, now: Now, network: Branches) -> None:
        network.limit = min(network.limit, self.parameters["limit"])


class TemperatureDependentResistance(Effect):
    identifier = "temperature_dependent_resistance"
    unit = "electrical"
    law = "R = R_0 + alpha * reference_resistance * (T - reference_temperature)"
    places = ("all", "all", "string", "coil")
    same_parameters = ("alpha",)
    strengths = {"alpha": (0.0006, 0.003)}

    def resistivity(self, now: Now, factor: Array) -> None:
        factor += self.parameters["alpha"] * self.place.amount[:, None] * (now.wire - REFERENCE)


class PhaseDependentResistance(Effect):
    identifier = "phase_dependent_resistance"
    unit = "electrical"
    law = "R = R_0 + delta * reference_resistance * phase"
    places = ("all", "all", "string", "coil")
    same_parameters = ("delta",)
    strengths = {"delta": (-0.04, -0.15)}

    def resistivity(self, now: Now, factor: Array) -> None:
        factor += self.parameters["delta"] * self.place.amount[:, None] * now.phase


class OpenCoil(Effect):
    identifier = "open_coil"
    unit = "electrical"
    law = "R = R_0 / (1 - openness * step(t - instant))"
    places = ("coil",)
    same_parameters = ("openness", "instant")
    #: Above 1 it is quite open.
    strengths = {"openness": (0.1, 1.6)}
    is_sudden = True

    def branches(self, now: Now, network: Branches) -> None:
        if now.time >= self.parameters["instant"]:
            network.coil /= np.maximum(1.0 - self.parameters["openness"] * self.place.amount, 1e-12)


class ShortedCoil(Effect):
    identifier = "shorted_coil"
    unit = "electrical"
    law = "R = R_0 * (1 - bridged * step(t - instant))"
    places = ("coil",)
    same_parameters = ("bridged", "instant")
    #: Above 1 all of it is bridged.
    strengths = {"bridged": (0.06, 1.6)}
    is_sudden = True

    def branches(self, now: Now, network: Branches) -> None:
        if now.time >= self.parameters["instant"]:
            network.coil *= 1.0 - self.parameters["bridged"] * self.place.amount


class SelfHeatingLead(_OfStrings):
    identifier = "self_heating_lead"
    law = "R_string = R_string_0 + rise * I**2"
    places = ("string",)
    same_parameters = ("rise",)
    strengths = {"rise": (1.0, 15.0)}

    def branches(self, now: Now, network: Branches) -> None:
        current = now.current[network.first]  # of the evaluation before: lags by less than a step
        network.lead += self.parameters["rise"] * self.amount_of_strings(network) * current**2


EFFECTS: tuple[type[Effect], ...] = (
    ContactResistance,
    LooseContact,
    SupplySourceResistance,
    SupplyCurrentLimit,
    TemperatureDependentResistance,
    PhaseDependentResistance,
    OpenCoil,
    ShortedCoil,
    SelfHeatingLead,
)
