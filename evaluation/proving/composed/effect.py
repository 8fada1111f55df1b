"""Composed laws that act on the equations of a bench, and on what its sensors read."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from evaluation.proving.composed.law import Law
from evaluation.proving.effects.effect import Effect, LoopChange, Now, Place
from evaluation.proving.effects.measurement import SensorFault
from evaluation.proving.network import Branches
from evaluation.proving.rig import Array
from evaluation.proving.sensors import Sensors


@dataclass(frozen=True)
class Target:
    """An equation that a composed law acts on.

    Args:
        unit: Part of the model.
        left: Formula's beginning.
        dimension: Unit of the amplitude.
        amplitudes: Between which its size is looked for.
        variables: That may enter.
        places: Kinds of place.
    """

    unit: Any
    left: str
    dimension: str
    amplitudes: tuple[float, float]
    variables: tuple[str, ...]
    places: tuple[str, ...]


_OF_COIL = ("all", "string", "coil")
#: Every one adds a quantity of the dimension of its equation: heat, a share of resistance, a voltage, a temperature ...
TARGETS: Mapping[str, Target] = {
    "heat": Target(
        "thermal",
        "heat = ",
        "W",
        (2e-4, 0.6),
        ("warmth", "power", "current", "rate", "time", "phase", "extension"),
        _OF_COIL,
    ),
    "resistance": Target(
        "electrical",
        "R = R_0 * (1 + law), law = ",
        "1",
        (1e-3, 0.7),
        ("warmth", "current", "rate", "time", "phase", "extension"),
        _OF_COIL,
    ),
    "series": Target(
        "electrical",
        "V_string = V - max(law, 0), law = ",
        "V",
        (5e-3, 3.0),
        ("current", "warmth", "time"),
        ("string", "all"),
    ),
    "shift": Target(
        "stiffness",
        "shift = ",
        "K",
        (0.05, 40.0),
        ("warmth", "rate", "current", "time", "phase", "extension"),
        _OF_COIL,
    ),
    "force": Target(
        "mechanical",
        "tension = load + law, law = ",
        "N",
        (2e-3, 0.8),
        ("extension", "speed", "warmth", "current", "time"),
        _OF_COIL,
    ),
    "length": Target(
        "mechanical",
        "extension = extension_0 + law, law = ",
        "m",
        (1e-5, 3e-3),
        ("warmth", "rate", "current", "time", "phase"),
        _OF_COIL,
    ),
}


def variables_of(now: Now) -> dict[str, Array]:
    """Variables of the coils, shape (coils,)."""
    return {
        "warmth": now.temperature,
        "power": now.power,
        "current": now.current,
        "rate": now.rate,
        "time": np.full_like(now.temperature, now.time),
        "phase": now.phase @ now.weight,
        "extension": now.extension,
        "speed": now.speed,
    }


class Composed(Effect):
    """A composed law in one equation; it acts with the values at the begin and in the middle of a step.

    Args:
        place: Where.
        target: Key of `TARGETS`.
        law: Composition; copied, since it has memories.
    """

    identifier: ClassVar[str] = "composed"
    is_named = False

    def __init__(self, place: Place, target: str, law: Law) -> None:
        super().__init__(place, {"amplitude": law.amplitude})
        self.unit = TARGETS[target].unit
        self.target, self.composition = target, deepcopy(law)
        self.law = TARGETS[target].left + law.formula()
        self._value = np.zeros_like(place.amount)
        self._moment = 0.0

    def begin(self, now: Now) -> None:
        self._moment = 0.0
        self._value = self.composition.reset(self._variables(now))

    def advance(self, now: Now) -> None:
        self._moment += now.size
        self._value = self.composition.moved(self._variables(now), now.size)

    def _variables(self, now: Now) -> dict[str, Array]:
        return variables_of(now) | {"time": np.full_like(now.temperature, self._moment)}

    @property
    def _amount(self) -> Array:
        return self._value * self.place.amount

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array] | None:
        amount = self._amount if self.target == "heat" else np.zeros_like(self._value)
        return np.broadcast_to(amount[:, None], wire.shape), np.zeros_like(wire)

    def branches(self, now: Now, network: Branches) -> None:
        if self.target == "resistance":
            network.coil *= np.maximum(1.0 + self._amount, 0.05)
        elif self.target == "series":
            network.drop += np.maximum(self._amount[network.first], 0.0)

    def loop(self, now: Now, change: LoopChange) -> None:
        if self.target == "shift":
            change.shift += self._amount

    def load(self, now: Now, tension: Array) -> None:
        if self.target == "force":
            tension += self._amount

    def length(self, now: Now, extension: Array, before: Array) -> None:
        if self.target == "length":
            extension += self._amount


class ComposedReading(SensorFault):
    """A composed law of what a sensor reads.

    Args:
        place: Its channels.
        law: Composition.
    """

    identifier: ClassVar[str] = "composed"
    is_named = False

    def __init__(self, place: Place, law: Law) -> None:
        super().__init__(place, {"amplitude": law.amplitude})
        self.composition = law
        self.law = "value = truth + law, law = " + law.formula()

    def spoil(self, sensors: Sensors) -> None:
        share = np.zeros(len(sensors.names))
        share[sensors.rows(self.place.channels)] = 1.0
        sensors.distortion = Distortion(self.composition, share)


@dataclass
class Distortion:
    """What a law adds to readings.

    Args:
        law: Composition.
        share: Of it in every channel, shape (channels,).
    """

    law: Law
    share: Array

    def along(self, times: Array, variables: Mapping[str, Array]) -> Array:
        """Added to the readings at every time, shape (times, channels); variables have that shape too."""
        rows = [{n: v[k] for n, v in variables.items()} for k in range(times.size)]
        law = deepcopy(self.law)
        found = [law.reset(rows[0])]
        found += [law.moved(row, size) for row, size in zip(rows[1:], np.diff(times).tolist())]
        return np.stack(found) * self.share
