"""A line with bends as a whole diagnosis model: readings, runs and laws known in closed form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.protocol import Labelled, ModelBase
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel
from diagnosis.search.problem import Own, Point, Term
from tests.search.line_model import TERMS, TIME, LineModel

#: Noise of the line's readings.
NOISE = 0.1


@dataclass(frozen=True)
class Law:
    name: str
    law: str
    confused_with: Mapping[str, str]
    is_of_a_day: bool = False
    is_of_either: bool = False


@dataclass(frozen=True)
class Series:
    channel: Channel
    samples: AnyArray
    used: AnyArray


@dataclass(frozen=True)
class Run:
    series: tuple[Series, ...]

    @property
    def shares(self) -> Array:
        return np.zeros(len(self.series))


class Lines(LineModel, ModelBase):
    """See `diagnosis.models.protocol.DiagnosisModel`; one recording with one channel.

    Args:
        truth: Signal without noise, shape (samples,).
        seed: Of the noise.
        noise: That the channel states.
        is_given: Whether it is stated.
    """

    def __init__(self, truth: Array, seed: int = 0, noise: float = NOISE, is_given: bool = True) -> None:
        super().__init__(truth, seed)
        self.noise, self.is_given = noise, is_given
        self.simulations = 0

    @property
    def runs(self) -> Sequence[Run]:
        channel = Channel("signal", Target("line", (), "signal"), TIME, self.measured, self.noise, self.is_given)
        used = np.ones(len(TIME), dtype=bool)
        return (Run((Series(replace(channel, is_clipped=~used), np.arange(len(TIME)), used),)),)

    def residuals(self, points: Sequence[Point]) -> Array:
        return np.array([(self.measured - self.signal(p)) / self.noise for p in points])

    def base_jacobian(self, point: Point) -> Array:
        return super().base_jacobian(point) * (NOISE / self.noise)

    def predict(self, point: Point, run: int) -> list[Array]:
        assert run == 0
        return [self.signal(point)]

    def terms(self) -> list[Term]:
        return list(TERMS)

    def where(self, term: Term) -> tuple[Law, Labelled]:
        return Law(term.identifier, "y = y_0 + a * f", {}), Labelled(term.place)

    def shows_in(self, term: Term) -> None:
        return None

    def scale_uncertainty(self, term: Term) -> tuple[float, ...]:
        return (0.0,) * len(term.parameters)

    def groups(self) -> dict[str, AnyArray]:
        return {}


def renamed(model: Lines, name: str) -> Lines:
    """The same whose offset belongs to its day alone."""
    model.parameters[0] = replace(model.parameters[0], name=name, own=Own(model.parameters[0].name, 0))
    return model
