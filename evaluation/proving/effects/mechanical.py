"""Mechanical effects on coils with a hanging load."""

from __future__ import annotations

import numpy as np

from evaluation.proving.effects.effect import Effect, Now
from evaluation.proving.effects.electrical import REFERENCE
from evaluation.proving.rig import Array


class _OfLoad(Effect):
    unit = "mechanical"
    needs_load = True


class SlideFriction(_OfLoad):
    identifier = "slide_friction"
    law = "abs(tension - stiffness * extension) <= friction"
    places = ("coil", "all", "string")
    same_parameters = ("friction",)
    strengths = {"friction": (0.03, 0.2)}

    def length(self, now: Now, extension: Array, before: Array) -> None:
        room = self.parameters["friction"] * self.place.amount / now.stiffness
        np.clip(before, extension - room, extension + room, out=extension)


class ViscousDamping(_OfLoad):
    identifier = "viscous_damping"
    law = "damping * d(extension) = tension - stiffness * extension"
    places = ("coil", "all", "string")
    same_parameters = ("damping",)
    strengths = {"damping": (250.0, 1500.0)}

    def length(self, now: Now, extension: Array, before: Array) -> None:
        damping = self.parameters["damping"] * self.place.amount
        decay = np.where(damping > 0.0, np.exp(-now.stiffness * now.size / np.maximum(damping, 1e-9)), 0.0)
        extension += (before - extension) * decay


class SupplyWireStiffness(_OfLoad):
    identifier = "supply_wire_stiffness"
    law = "tension = stiffness * extension + wire * (extension - reach)"
    places = ("coil", "all", "string")
    same_parameters = ("wire", "reach")
    strengths = {"wire": (10.0, 60.0)}
    ranges = {"reach": (0.0008, 0.0028)}

    def length(self, now: Now, extension: Array, before: Array) -> None:
        wire = self.parameters["wire"] * self.place.amount
        extension -= wire * (extension - self.parameters["reach"]) / (now.stiffness + wire)


class Backlash(_OfLoad):
    identifier = "backlash"
    law = "abs(extension_marker - extension) <= 0.5 * gap"
    places = ("coil", "all", "string")
    same_parameters = ("gap",)
    strengths = {"gap": (0.0003, 0.0015)}

    def length(self, now: Now, extension: Array, before: Array) -> None:
        half = 0.5 * self.parameters["gap"] * self.place.amount
        np.clip(before, extension - half, extension + half, out=extension)


class Tilt(_OfLoad):
    identifier = "tilt"
    law = "tension = load * (1 - loss)"
    places = ("coil", "string")
    same_parameters = ("loss",)
    strengths = {"loss": (0.05, 0.2)}

    def load(self, now: Now, tension: Array) -> None:
        tension *= 1.0 - self.parameters["loss"] * self.place.amount


class ThermalContraction(_OfLoad):
    identifier = "thermal_contraction"
    law = "extension = extension_0 - contraction * (T - reference_temperature)"
    places = ("all", "all", "coil", "string")
    same_parameters = ("contraction",)
    strengths = {"contraction": (6e-6, 4e-5)}
    signed = "contraction"

    def length(self, now: Now, extension: Array, before: Array) -> None:
        extension -= self.parameters["contraction"] * self.place.amount * (now.temperature - REFERENCE)


class Creep(_OfLoad):
    identifier = "creep"
    law = "extension = extension_0 + crept; tau * d(crept) = compliance * tension - crept"
    places = ("all", "coil")
    same_parameters = ("compliance", "tau")
    strengths = {"compliance": (0.0003, 0.0012)}
    ranges = {"tau": (13.0, 75.0)}

    def begin(self, now: Now) -> None:
        self._crept = np.zeros_like(now.tension)

    def advance(self, now: Now) -> None:
        rest = self.parameters["compliance"] * self.place.amount * now.tension
        self._crept = rest + (self._crept - rest) * np.exp(-now.size / self.parameters["tau"])

    def length(self, now: Now, extension: Array, before: Array) -> None:
        extension += self._crept


#: Effects whose order matters: what moves freely first, what holds it back last.
EFFECTS: tuple[type[Effect], ...] = (
    SupplyWireStiffness,
    Tilt,
    ThermalContraction,
    Creep,
    ViscousDamping,
    SlideFriction,
    Backlash,
)
