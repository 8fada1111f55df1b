"""Effects in the transformation of the coils."""

from __future__ import annotations

import numpy as np

from evaluation.proving.effects.effect import Effect, LoopChange, Now
from evaluation.proving.rig import Array


class StressDependentTransformation(Effect):
    identifier = "stress_dependent_transformation"
    unit = "stiffness"
    law = "shift = slope * tension"
    same_parameters = ("slope",)
    strengths = {"slope": (3.0, 12.0)}
    needs_load = True

    def loop(self, now: Now, change: LoopChange) -> None:
        change.shift += self.parameters["slope"] * self.place.amount * np.maximum(now.tension, 0.0)


class TransformationShift(Effect):
    identifier = "transformation_shift"
    unit = "stiffness"
    law = "shift = offset"
    places = ("coil", "string")
    same_parameters = ("offset",)
    strengths = {"offset": (3.0, 10.0)}
    signed = "offset"

    def loop(self, now: Now, change: LoopChange) -> None:
        change.shift += self.parameters["offset"] * self.place.amount


class Fatigue(Effect):
    identifier = "fatigue"
    unit = "stiffness"
    law = "fraction = 1 - loss * cycles; d(cycles) = 0.5 * abs(d(phase))"
    places = ("all", "all", "coil")
    same_parameters = ("loss",)
    strengths = {"loss": (0.04, 0.18)}

    def begin(self, now: Now) -> None:
        self._last = now.phase @ now.weight
        self._cycles = np.zeros_like(self._last)

    def advance(self, now: Now) -> None:
        phase = now.phase @ now.weight
        self._cycles = self._cycles + 0.5 * np.abs(phase - self._last)
        self._last = phase

    def loop(self, now: Now, change: LoopChange) -> None:
        change.fraction *= np.maximum(1.0 - self.parameters["loss"] * self.place.amount * self._cycles, 0.0)


class FatigueShift(Fatigue):
    identifier = "fatigue_shift"
    law = "shift = wander * cycles; d(cycles) = 0.5 * abs(d(phase))"
    same_parameters = ("wander",)
    strengths = {"wander": (0.8, 3.0)}
    signed = "wander"

    def loop(self, now: Now, change: LoopChange) -> None:
        change.shift += self.parameters["wander"] * self.place.amount * self._cycles


class MinorLoopMemory(Effect):
    identifier = "minor_loop_memory"
    unit = "stiffness"
    law = "inside the loop, the stiffness moves with the temperature in proportion to its distance from the ends"
    places = ("all", "all", "coil")
    strengths = {"duhem_share": (0.35, 1.0)}

    def duhem(self) -> Array:
        return self.parameters["duhem_share"] * self.place.amount


class IncompleteTransformation(Effect):
    identifier = "incomplete_transformation"
    unit = "stiffness"
    law = "stiffness = heating_d + (1 - retained) * (stiffness_0 - heating_d)"
    places = ("coil", "string")
    same_parameters = ("retained",)
    strengths = {"retained": (0.12, 0.5)}

    def loop(self, now: Now, change: LoopChange) -> None:
        change.fraction *= 1.0 - self.parameters["retained"] * self.place.amount


EFFECTS: tuple[type[Effect], ...] = (
    StressDependentTransformation,
    TransformationShift,
    Fatigue,
    FatigueShift,
    MinorLoopMemory,
    IncompleteTransformation,
)
