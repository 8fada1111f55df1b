"""Cases whose law was composed at random; the law is looked for when the case is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from evaluation.proving.case import Case
from evaluation.proving.composed.effect import TARGETS, Composed, ComposedReading, Distortion
from evaluation.proving.composed.law import Law, drawn_law
from evaluation.proving.composed.search import NoLaw, Wanted, amount_of, strength_of
from evaluation.proving.composed.strength import FINE, LEAST_IN_TRAINING, LEFT, Gauge, Left
from evaluation.proving.draw import drawn_place_on
from evaluation.proving.effects.effect import Place
from evaluation.proving.programme import Programme
from evaluation.proving.rig import Rig
from evaluation.proving.sensors import Sensors
from evaluation.proving.setups import Setup
from evaluation.proving.wire import WireError

#: Compositions that are tried on a rig, and amounts of each.
_TRIES, _AMOUNTS = 40, 12
#: Heat, and its amplitudes, are given for a coil of the paper; a larger body needs as much more.
_COIL_CONDUCTANCE = 90.0 * 97.85e-6
#: Variables of what a sensor reads.
_OF_READING = ("own", "warmth", "current", "power", "time")


@dataclass
class ComposedCase:
    """A case before its law is found.

    Args:
        identifier: Says nothing about the answer.
        setup: The kind of rig.
        rig: The rig.
        sensors: By kind.
        programmes: Two to learn from and one to judge by.
        target: Equation that the law acts on, of `TARGETS`, or `reading`.
        kind: `composed`.
        engine: Of the loads.
    """

    identifier: str
    setup: Setup
    rig: Rig
    sensors: dict[str, Sensors]
    programmes: list[Programme]
    target: str
    kind: str = "composed"
    engine: str = "own"
    hidden: tuple[str, ...] = field(default=())

    def write(self, cases: Path, answers: Path, rng: np.random.Generator) -> None:
        """Finds the law, runs the case and writes recordings and answer; see `evaluation.proving.case.Case.write`.

        Raises:
            WireError: A truth does not converge.
            NoLaw: None of many compositions can be made strong enough.
        """
        self.found(rng).write(cases, answers, rng)

    def found(self, rng: np.random.Generator) -> Case:
        """The case with its law."""
        gauge = Gauge(self.setup, self.rig, self.sensors, self.programmes)
        for _ in range(_TRIES):
            made = self._reading(gauge, rng) if self.target == "reading" else self._effect(gauge, rng)
            if made is not None:
                effect, left = made
                effect.parameters |= {"left_held_out": left.held_out, "left_training": left.training}
                is_fault = isinstance(effect, ComposedReading)
                return Case(
                    self.identifier,
                    self.kind,
                    self.setup,
                    self.rig,
                    [] if is_fault else [effect],  # type: ignore[list-item]
                    [effect] if is_fault else [],  # type: ignore[list-item]
                    {effect.identifier: strength_of(left)},
                    self.programmes[:-1],
                    self.programmes[-1:],
                    (),
                    self.sensors,
                    self.engine,
                )
        raise NoLaw(f"{self.identifier}: no composed law of {self.target} is strong enough on {self.setup.name}")

    def _effect(self, gauge: Gauge, rng: np.random.Generator) -> tuple[Composed, Left] | None:
        target = TARGETS[self.target]
        kinds = [k for k in target.places if k != "coil" or self.setup.sheet.coils < 10]
        place = drawn_place_on(kinds, self.setup, rng)
        names = [n for n in target.variables if not self.setup.sheet.is_driven_by_power or n not in _OF_COILS_ALONE]
        law = drawn_law(gauge.scales(names), self.setup.stop, rng)
        wanted = Wanted.drawn(rng)
        larger = self.setup.sheet.conductance / _COIL_CONDUCTANCE if self.target == "heat" else 1.0
        amounts = (larger * np.geomspace(*target.amplitudes, _AMOUNTS)).tolist()
        left = _tried(gauge, Composed(place, self.target, law), amounts)
        amount = amount_of(amounts[: len(left)], left, wanted)
        for _ in range(2):
            if amount is None:
                return None
            effect = Composed(place, self.target, Law(law.terms, law.amplitude * amount))
            try:
                (here,) = gauge.left([effect], [1.0], FINE)
            except WireError:
                return None
            if LEFT[0] * 1.05 <= here.held_out <= LEFT[1] * 0.95 and here.training >= LEAST_IN_TRAINING:
                return effect, here
            amount = wanted.corrected(amount, here)
        return None

    def _reading(self, gauge: Gauge, rng: np.random.Generator) -> tuple[ComposedReading, Left] | None:
        kinds = [k for k in ("temperature", "extension") if k in self.sensors]
        kind = str(rng.choice(kinds))
        names = self.sensors[kind].names
        is_one = bool(rng.random() < 0.5) and len(names) < 10
        channels = (str(rng.choice(list(names))),) if is_one else names
        law = drawn_law(gauge.scales_of_reading(kind, _OF_READING), self.setup.stop, rng)
        wanted = Wanted.drawn(rng)
        share = np.array([float(n in channels) for n in names])
        law.amplitude *= self.sensors[kind].noise
        here = gauge.left_of_reading(kind, Distortion(law, share))
        if here.held_out - 1.0 < 1e-6:
            return None
        # The rest is proportional to the amplitude.
        factor = float(np.sqrt((wanted.held_out - 1.0) / (here.held_out - 1.0)))
        law.amplitude *= factor
        left = Left(1.0 + factor**2 * (here.training - 1.0), wanted.held_out)
        # A thermometer that is off by tens of kelvins, or a marker by centimetres, is no distortion any more.
        if left.training < LEAST_IN_TRAINING or factor > _MOST_OF_NOISE:
            return None
        place = Place("channel" if is_one else "quantity", (), np.zeros(0), channels)
        return ComposedReading(place, law), left


#: Variables that bodies without wire and load do not have.
_OF_COILS_ALONE = ("current", "phase", "extension", "speed")
#: Largest amplitude of a distortion, in deviations of the noise.
_MOST_OF_NOISE = 100.0


def _tried(gauge: Gauge, effect: Composed, amounts: list[float]) -> list[Left]:
    """What is left with each amount; the largest ones are left out where the truth does not converge with them."""
    for count in (len(amounts), len(amounts) - 3, len(amounts) - 6):
        try:
            return gauge.left([effect], amounts[:count])
        except WireError:
            continue
    return []
