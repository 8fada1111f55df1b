"""Sabotage of swings: what was said about a start, a clock or an encoder, and arms with more to them than an arm."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np

from evaluation.proving.pendulum.arm import Torque
from evaluation.proving.rig import Array
from evaluation.proving.sabotage.sabotage import OF_INPUT, OF_READINGS, OF_STRUCTURE, Sabotage, within

#: Angle [rad] and angular velocity [rad/s] of a start.
Start = tuple[float, float]
CHANNEL = "arm.angle"


class ArmSabotage(Sabotage):
    """Nothing is wrong with a swing; subclasses override what they spoil."""

    setups: ClassVar[tuple[str, ...]] = ("pendulum",)

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        """One with its numbers drawn.

        Args:
            training: How many recordings are to learn from; one more is held out.
            stop: End of a recording [s].
            rng: Source of draws.
        """
        raise NotImplementedError

    def stated_start(self, number: int, starts: Sequence[Start]) -> Start:
        """What a recording, counted from 1, says about its start."""
        return starts[number - 1]

    def real_start(self, number: int, start: Start) -> Start:
        """How it really starts where the case says `start`."""
        return start

    def torque(self, number: int) -> Torque | None:
        """What else acts on the arm in a recording."""
        return None

    def spoil_swing(self, number: int, stamps: Array, read: Array) -> tuple[Array, Array]:
        """Readings as they come to be written."""
        return stamps, read


def _sign(rng: np.random.Generator) -> float:
    return float(rng.choice([-1.0, 1.0]))


def _one(training: int, rng: np.random.Generator) -> tuple[int, ...]:
    return (int(rng.integers(1, training + 1)),)


def _all(training: int) -> tuple[int, ...]:
    return tuple(range(1, training + 2))


def _span(stop: float, rng: np.random.Generator, shortest: float, longest: float) -> tuple[float, float]:
    begin = float(rng.uniform(0.2, 0.5)) * stop
    return round(begin, 2), round(begin + float(rng.uniform(shortest, longest)), 2)


class OtherRun(ArmSabotage):
    """The starts of two recordings are exchanged."""

    kind = "wrong_programme"
    law = "each of two recordings states the start of the other"
    verdicts = OF_INPUT

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        return cls((1, 2))

    def stated_start(self, number: int, starts: Sequence[Start]) -> Start:
        return starts[2 - number] if self.concerns(number) else starts[number - 1]


class WrongStart(ArmSabotage):
    """The arm was let go elsewhere than it is said."""

    kind = "wrong_start"
    law = "angle(0) = stated + excess"
    verdicts = OF_INPUT

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        numbers = _all(training)[:-1] if rng.random() < 0.3 else _one(training, rng)
        return cls(numbers, {"excess": _sign(rng) * float(rng.uniform(0.12, 0.4))})

    def real_start(self, number: int, start: Start) -> Start:
        return (start[0] + self.parameters["excess"], start[1]) if self.concerns(number) else start


class WrongUnit(ArmSabotage):
    """Degrees that are called radians, or milliseconds that are called seconds."""

    kind = "wrong_unit"
    law = "number = value in `written`, read as `stated`"
    verdicts = OF_READINGS
    _mode = ""

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        mode = str(rng.choice(["deg as rad", "ms as s"]))
        made = cls(_all(training), {"factor": 1000.0 if mode == "ms as s" else 180.0 / math.pi}, (CHANNEL,))
        made._mode = mode
        return made

    def spoil_swing(self, number: int, stamps: Array, read: Array) -> tuple[Array, Array]:
        factor = self.parameters["factor"]
        return (factor * stamps, read) if self._mode == "ms as s" else (stamps, factor * read)

    def answer(self, names: Sequence[str], titles: Sequence[str], stop: float) -> dict[str, Any]:
        return super().answer(names, titles, stop) | {"mistake": self._mode}


class ShiftedClock(ArmSabotage):
    """The recorder was started late or early."""

    kind = "shifted_clock"
    law = "stamp = t + shift"
    verdicts = OF_READINGS
    same_as = ("sensor_clock_offset",)

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        numbers = _all(training) if rng.random() < 0.5 else _one(training, rng)
        return cls(numbers, {"shift": _sign(rng) * round(float(rng.uniform(0.1, 0.6)), 2)})

    def spoil_swing(self, number: int, stamps: Array, read: Array) -> tuple[Array, Array]:
        return _cut(stamps, stamps + self.parameters["shift"], read) if self.concerns(number) else (stamps, read)


class DriftingClock(ArmSabotage):
    """The recorder's clock loses or gains more and more; a constant rate would be another weight moment."""

    kind = "drifting_clock"
    law = "stamp = t + late * (t / stop)**2"
    verdicts = OF_READINGS
    same_as = ("sensor_clock_offset",)

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        numbers = _all(training) if rng.random() < 0.5 else _one(training, rng)
        return cls(numbers, {"late": _sign(rng) * float(rng.uniform(0.15, 0.5)), "stop": stop})

    def spoil_swing(self, number: int, stamps: Array, read: Array) -> tuple[Array, Array]:
        if not self.concerns(number):
            return stamps, read
        late = self.parameters["late"] * (stamps / self.parameters["stop"]) ** 2
        return _cut(stamps, stamps + late, read)


def _cut(stamps: Array, moved: Array, read: Array) -> tuple[Array, Array]:
    kept = (moved >= 0.0) & (moved <= stamps[-1])
    return np.round(moved[kept], 4), read[kept]


class SensorOff(ArmSabotage):
    """The encoder lost counts, and found its index again."""

    kind = "sensor_off"
    law = "value = truth + bias for begin <= t < end"
    verdicts = OF_READINGS

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        bias = _sign(rng) * float(rng.uniform(0.03, 0.15))
        return cls(_one(training, rng), {"bias": bias}, (CHANNEL,), _span(stop, rng, 1.5, 4.0))

    def spoil_swing(self, number: int, stamps: Array, read: Array) -> tuple[Array, Array]:
        if not self.concerns(number) or self.span is None:
            return stamps, read
        return stamps, read + np.where(within(stamps, self.span), self.parameters["bias"], 0.0)


class SensorStuck(ArmSabotage):
    """The encoder gives its last reading again and again for a while."""

    kind = "sensor_stuck"
    law = "value = value(begin) for begin <= t < end"
    verdicts = OF_READINGS

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        return cls(_one(training, rng), {}, (CHANNEL,), _span(stop, rng, 0.5, 2.0))

    def spoil_swing(self, number: int, stamps: Array, read: Array) -> tuple[Array, Array]:
        if not self.concerns(number) or self.span is None:
            return stamps, read
        rows = within(stamps, self.span)
        return stamps, np.where(rows, read[int(np.argmax(rows))], read)


class Push(ArmSabotage):
    """Somebody leaned on the arm for a while."""

    kind = "input_offset"
    law = "torque = push for begin <= t < end"
    verdicts = OF_INPUT

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        push = _sign(rng) * float(np.exp(rng.uniform(np.log(3e-3), np.log(1.5e-2))))
        return cls(_one(training, rng), {"push": push}, (), _span(stop, rng, 0.4, 2.0))

    def torque(self, number: int) -> Torque | None:
        if not self.concerns(number) or self.span is None:
            return None
        begin, end = self.span
        return lambda time, angle, speed: self.parameters["push"] if begin <= time < end else 0.0


class HiddenMass(ArmSabotage):
    """A mass on a spring rides on the arm: two bodies where the model has one."""

    kind = "hidden_mass"
    units = ("mechanical",)
    law = "torque = -coupling * z; d(d(z)) = d(w) - 2 * damping * rate * d(z) - rate**2 * z"
    verdicts = OF_STRUCTURE

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        numbers = {
            "coupling": float(np.exp(rng.uniform(np.log(4e-3), np.log(2e-2)))),
            "rate": float(rng.uniform(8.0, 20.0)),
            "damping": float(rng.uniform(0.01, 0.1)),
        }
        return cls(_all(training), numbers)

    def torque(self, number: int) -> Torque | None:
        return _Rider(self.parameters)


class _Rider:
    """Distance z of the rider from its place, as an angle [rad], moved along with the arm's steps."""

    def __init__(self, numbers: Mapping[str, float]) -> None:
        self._numbers = numbers
        self._z, self._speed, self._time, self._before = 0.0, 0.0, 0.0, 0.0

    def __call__(self, time: float, angle: float, speed: float) -> float:
        size = time - self._time
        if time <= 0.0 or size < 0.0:
            self._z, self._speed, self._time, self._before = 0.0, 0.0, time, speed
            return 0.0
        if size > 0.0:
            rate, damping = self._numbers["rate"], self._numbers["damping"]
            pull = -2.0 * damping * rate * self._speed - rate**2 * self._z
            self._speed += size * pull + (speed - self._before)
            self._z += size * self._speed
            self._time, self._before = time, speed
        return -self._numbers["coupling"] * self._z


class Escapement(ArmSabotage):
    """A clockwork gives the arm a kick whenever it passes its lowest point from one side."""

    kind = "escapement"
    units = ("mechanical",)
    law = "torque = kick for abs(angle - pi) < reach and w > 0"
    verdicts = OF_STRUCTURE

    @classmethod
    def drawn_for_arm(cls, training: int, stop: float, rng: np.random.Generator) -> ArmSabotage:
        numbers = {
            "kick": float(np.exp(rng.uniform(np.log(3e-3), np.log(1.5e-2)))),
            "reach": float(rng.uniform(0.05, 0.2)),
        }
        return cls(_all(training), numbers)

    def torque(self, number: int) -> Torque | None:
        kick, reach = self.parameters["kick"], self.parameters["reach"]
        return lambda time, angle, speed: kick if abs(angle - math.pi) < reach and speed > 0.0 else 0.0


SABOTAGES: tuple[type[ArmSabotage], ...] = (
    OtherRun,
    WrongStart,
    WrongUnit,
    ShiftedClock,
    DriftingClock,
    SensorOff,
    SensorStuck,
    Push,
    HiddenMass,
    Escapement,
)
