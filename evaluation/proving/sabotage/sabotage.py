"""What a sabotage may do to a case, and what is written down about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from evaluation.proving.effects.effect import Effect
from evaluation.proving.programme import Programme
from evaluation.proving.rig import Array
from evaluation.proving.sensors import Readings, Sensors
from evaluation.proving.setups import Setup

#: Sensors of one kind with what they read.
CoilNetwork = tuple[Sensors, Readings]

#: Verdicts that are right where something else was done than is stated.
OF_INPUT = ("recording fault", "cannot tell")
#: Where readings are not what they are called.
OF_READINGS = ("recording fault", "measurement fault", "cannot tell")
#: Where the model lacks something that no law of a catalogue describes.
OF_STRUCTURE = ("unnamed physics", "recording fault", "cannot tell")


@dataclass(frozen=True)
class Bench:
    """What a sabotage is drawn for.

    Args:
        setup: The kind of rig.
        sensors: By kind.
        programmes: Of all recordings, those to learn from first.
        training: How many of them are to learn from.
    """

    setup: Setup
    sensors: Mapping[str, Sensors]
    programmes: Sequence[Programme]
    training: int

    def drawn_training(self, rng: np.random.Generator) -> int:
        """A recording to learn from, counted from 1."""
        return int(rng.integers(1, self.training + 1))

    @property
    def all(self) -> tuple[int, ...]:
        """All recordings."""
        return tuple(range(1, len(self.programmes) + 1))

    def span(self, rng: np.random.Generator, longest: float = 0.4) -> tuple[float, float]:
        """A stretch within a recording [s]: begins at 15 to 45 % of it and takes 20 % to `longest` of it."""
        begin = float(rng.uniform(0.15, 0.45)) * self.setup.stop
        return round(begin, 1), round(begin + float(rng.uniform(0.2, longest)) * self.setup.stop, 1)


class Sabotage:
    """Nothing is wrong; subclasses override what they spoil.

    Args:
        recordings: That are concerned, counted from 1.
        parameters: Numbers of it, SI.
        channels: That are concerned; none: no channel in particular.
        span: Begin and end [s]; None: the whole recording.

    Class attributes:
        kind: Its name in the answer.
        law: What is done, with the parameters' names.
        verdicts: That are right.
        setups: Rigs that it can be done to.
        same_as: Effects of a catalogue that say the same in other words.
        units: To which something without a name may be put down, where the model is wrong and not the recording.
    """

    kind: ClassVar[str] = ""
    law: ClassVar[str] = ""
    verdicts: ClassVar[tuple[str, ...]] = ()
    setups: ClassVar[tuple[str, ...]] = ()
    same_as: ClassVar[tuple[str, ...]] = ()
    units: ClassVar[tuple[str, ...]] = ()

    def __init__(
        self,
        recordings: Sequence[int] = (),
        parameters: Mapping[str, float] | None = None,
        channels: Sequence[str] = (),
        span: tuple[float, float] | None = None,
    ) -> None:
        self.recordings = tuple(recordings)
        self.parameters = dict(parameters or {})
        self.channels = tuple(channels)
        self.span = span

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        """One with its numbers drawn."""
        raise NotImplementedError

    def concerns(self, number: int) -> bool:
        """Whether it acts in a recording, counted from 1."""
        return number in self.recordings

    def applied(self, number: int, programme: Programme) -> Programme:
        """What is really done in a recording of which the case says `programme`."""
        return programme

    def stated(self, number: int, programme: Programme) -> Programme:
        """What the recording says is done."""
        return programme

    def room(self, number: int) -> float:
        """How much warmer the surroundings are than the case says [K]."""
        return 0.0

    def start(self, number: int) -> float:
        """How much warmer the rig starts than its surroundings [K]."""
        return 0.0

    def effects(self) -> list[Effect]:
        """What acts on the rig besides."""
        return []

    def spoil(self, number: int, networks: Sequence[CoilNetwork]) -> list[CoilNetwork]:
        """Readings as they come to be written."""
        return list(networks)

    def tell(self, number: int, sidecar: dict[str, Any]) -> dict[str, str]:
        """Changes what recording.yaml says; returns more tables, name to content."""
        return {}

    def answer(self, names: Sequence[str], titles: Sequence[str], stop: float) -> dict[str, Any]:
        """What is written into the answer.

        Args:
            names: Of all recordings of the case.
            titles: Of these.
            stop: End of a recording [s].
        """
        begin, end = self.span or (0.0, stop)
        return {
            "kind": self.kind,
            "law": self.law,
            "recordings": [names[n - 1] for n in self.recordings],
            "titles": [titles[n - 1] for n in self.recordings],
            "channels": list(self.channels),
            "begin": begin,
            "end": end,
            "parameters": self.parameters,
            "same_as": list(self.same_as),
            "units": list(self.units),
        }


def within(stamps: Array, span: tuple[float, float]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which times lie in a stretch."""
    return np.asarray((stamps >= span[0]) & (stamps < span[1]))
