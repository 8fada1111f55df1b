"""Models that are wrong in a way for which no catalogue has a law."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from evaluation.proving.effects.effect import Effect, Now, everywhere
from evaluation.proving.hysteresis import lower, upper
from evaluation.proving.network import OPEN, Branches
from evaluation.proving.rig import Array
from evaluation.proving.sabotage.sabotage import OF_STRUCTURE, Bench, Sabotage


class _OfRig(Sabotage):
    """A sabotage that is an effect on the rig."""

    verdicts = OF_STRUCTURE

    def __init__(self, made: Effect, recordings: tuple[int, ...], parameters: Mapping[str, float]) -> None:
        super().__init__(recordings, parameters)
        self._made = made

    def effects(self) -> list[Effect]:
        return [self._made]


class OneCurve(Effect):
    """Coils of another alloy: their stiffness is one curve over temperature, without a loop."""

    identifier = "one_curve"
    unit = "stiffness"
    is_named = False
    law = "stiffness = (1 - side) * heating(T) + side * cooling(T), whatever came before"

    def curve(self, now: Now, celsius: Array, stiffness: Array) -> Array:
        side = self.parameters["side"]
        return (1.0 - side) * lower(celsius) + side * upper(celsius)


class SingleBranch(_OfRig):
    """The coils have no hysteresis."""

    kind = "single_branch"
    units = ("stiffness", "mechanical")
    law = OneCurve.law
    setups = ("network", "small", "zones", "bath")

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        parameters = {"side": float(rng.uniform(0.3, 0.9))}
        return cls(OneCurve(everywhere(bench.setup.sheet), parameters), bench.all, parameters)


class Thermostat(Effect):
    """A bimetal in a string opens it when its first coil is hot, and closes it again when it has cooled."""

    identifier = "thermostat"
    unit = "electrical"
    is_named = False
    law = "I_string = 0 from T > T_open until T < T_close, T of its first coil"

    def begin(self, now: Now) -> None:
        self._is_open = np.zeros(now.temperature.size, dtype=np.bool_)

    def advance(self, now: Now) -> None:
        opens, closes = self.parameters["T_open"], self.parameters["T_close"]
        self._is_open = np.where(self._is_open, now.temperature > closes, now.temperature > opens)

    def branches(self, now: Now, network: Branches) -> None:
        has = (self.place.amount[network.first] > 0.0) & self._is_open[network.first]
        network.lead += np.where(has, OPEN, 0.0)


class HiddenThermostat(_OfRig):
    """Strings have thermostats of which the model knows nothing."""

    kind = "thermostat"
    units = ("electrical",)
    law = Thermostat.law
    setups = ("network", "small", "zones")

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        opens = float(rng.uniform(318.0, 325.0))
        parameters = {"T_open": opens, "T_close": opens - float(rng.uniform(4.0, 12.0))}
        return cls(Thermostat(everywhere(bench.setup.sheet), parameters), bench.all, parameters)


SABOTAGES: tuple[type[Sabotage], ...] = (SingleBranch, HiddenThermostat)
