"""A located equation looked into: the unknown input there, what it goes with, and a law for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.judge.location import Dependence, Location, Proposal, Waveform
from diagnosis.locate.course import Course
from diagnosis.locate.equation import Equation, Products
from diagnosis.locate.regression import folds, formula, responses, select
from diagnosis.locate.replay import Replay
from diagnosis.locate.statistic import Tested
from diagnosis.locate.terms import Feature, features, multiplier
from diagnosis.locate.waveform import NORMAL_95, Estimates, estimate

#: Unit of the model to the equations of the catalogue that act on it.
TARGETS = {
    "electrical": ("resistance",),
    "thermal": ("heat",),
    "stiffness": ("stiffness",),
    "mechanical": ("length",),
    "stiffness or mechanical": ("stiffness", "length"),
}
#: Unit that an equation of the catalogue belongs to.
UNIT_OF_TARGET = {
    "resistance": "electrical",
    "heat": "thermal",
    "stiffness": "stiffness",
    "length": "mechanical",
}
#: Variables that are named, at most, and the least correlation.
MOST, LEAST = 4, 0.3


@dataclass(frozen=True)
class Investigated:
    """What was found at one equation.

    Args:
        location: With what the input goes with.
        waveforms: The input in every recording.
        proposals: Laws, the best first.
    """

    location: Location
    waveforms: tuple[Waveform, ...]
    proposals: tuple[Proposal, ...]


def investigate(
    replay: Replay, tested: Tested, location: Location, courses: Sequence[Course], titles: Sequence[str]
) -> Investigated:
    """Estimate the unknown input at the place where a unit departs most, and look for a law.

    Args:
        replay: The unit.
        tested: Its test.
        location: Where it departs most.
        courses: Of every recording.
        titles: Of the recordings.
    """
    place = _place(tested)
    equation = Equation(tested, *place)
    if not equation.members:
        return Investigated(location, (), ())
    found = estimate(equation, courses)
    proposals, dependences = [], []
    for target in TARGETS[replay.unit]:
        laws = _Laws(tested, place, courses, target, replay.unit == "electrical")
        dependences += laws.dependences(found.gain)
        proposals += laws.proposal(location, found.gain)
    depends_on = tuple(sorted(dependences, key=lambda d: -abs(d.correlation))[:MOST])
    ordered = tuple(sorted(proposals, key=lambda p: -p.gain))
    return Investigated(
        replace(location, depends_on=depends_on), tuple(_waveforms(replay, location, found, titles)), ordered
    )


def _place(tested: Tested) -> tuple[AnyArray | None, tuple[str, ...]]:
    """Elements and quantities of the strongest departure; all strings are seen through the supply's current too."""
    panel = tested.panels[tested.peak.panel]
    is_current = panel.quantity in ("current", "supply_current")
    if is_current and (panel.quantity == "supply_current" or len(tested.peak.members) > 1):
        return None, ("current", "supply_current")
    return panel.elements[tested.peak.members], (panel.quantity,)


def _waveforms(replay: Replay, location: Location, found: Estimates, titles: Sequence[str]) -> list[Waveform]:
    made = []
    for course in found.courses:
        half = NORMAL_95 * course.deviation
        made.append(
            Waveform(
                unit=replay.input_unit,
                equation=replay.equation,
                element=location.element,
                times=_numbers(course.times),
                values=_numbers(course.values),
                lower=_numbers(course.values - half),
                upper=_numbers(course.values + half),
                recording=titles[course.recording],
            )
        )
    return made


def _numbers(values: Array) -> tuple[float, ...]:
    return tuple(float(f"{v:.5g}") for v in values)


class _Laws:
    """Terms of one equation of the catalogue at a place."""

    def __init__(
        self,
        tested: Tested,
        place: tuple[AnyArray | None, tuple[str, ...]],
        courses: Sequence[Course],
        target: str,
        by_string: bool,
    ) -> None:
        self._target = target
        equation = Equation(tested, *place)
        values = responses(equation, courses, target, by_string)
        self._whole = equation.products(values)
        self._parts = [Equation(tested, *place, masks).products(values) for masks in folds(tested)]
        course = courses[0]
        self._features: list[Feature] = features(course, target)
        self._law = multiplier(course, target)

    def dependences(self, gain: float) -> list[Dependence]:
        """Terms that the unknown input goes with; the correlation of what both do in the channels."""
        found = []
        for n, feature in enumerate(self._features):
            size = float(self._whole.gram[n, n])
            if size > 1e-12 and gain > 0.0:
                found.append(Dependence(feature.words, float(np.clip(_cosine(self._whole, n, gain), -1.0, 1.0))))
        return [d for d in found if abs(d.correlation) > LEAST]

    def proposal(self, location: Location, gain: float) -> list[Proposal]:
        """A law for the input, or none where no term is confirmed."""
        chosen, amounts = select(self._whole, self._parts)
        if not chosen:
            return []
        _, unit, law = self._law
        own = [self._features[n] for n in chosen]
        explained = self._whole.only(chosen).gain(amounts)
        return [
            Proposal(
                formula=formula(law, own, amounts),
                unit=unit,
                equation_unit=UNIT_OF_TARGET[self._target],
                place=location.element,
                terms=tuple(f.identifier for f in own),
                amplitudes=tuple(float(a) for a in amounts),
                depends_on=tuple(f.words for f in own),
                gain=explained,
                share=float(np.clip(explained / max(gain, 1e-300), 0.0, 1.0)),
            )
        ]


def _cosine(products: Products, n: int, gain: float) -> float:
    return float(products.along[n] / np.sqrt(products.gram[n, n] * gain))
