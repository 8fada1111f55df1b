"""What the search needs of a model: parameters with priors, terms that can be added, residuals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from cosim.unit.protocol import AnyArray, Array

#: Logarithm of the largest factor that a value is changed by: 1e43 is beyond any rig, and far from the largest number.
MOST_FOLD = 100.0


@dataclass(frozen=True)
class Own:
    """Whose a parameter is that not all recordings share.

    Args:
        number: Name of what all recordings share of the same number; that may be no parameter.
        recording: Number of the recording, from 0.
        day: Name of the day that it belongs to; recordings held out may be of the same day. Empty: the recording alone.
    """

    number: str
    recording: int
    day: str = ""


@dataclass(frozen=True)
class Alike:
    """What parameters of equal elements are compared by, to tell how far such elements really are apart.

    Args:
        kind: What the elements have each, for example `heat_transfer_coefficient`.
        group: Those of one group (the coils of a string) are compared with each other.
    """

    kind: str
    group: str


@dataclass(frozen=True)
class Parameter:
    """A number that the model already has, and how far it may be off.

    The fit works in z, the distance from the nominal value in prior deviations: value = nominal * exp(deviation * z)
    where `is_relative`, else nominal + deviation * z.

    Args:
        name: For example `coil[2,5].heat_transfer_coefficient`.
        unit: SI unit.
        nominal: Value in the scenario.
        deviation: Prior standard deviation, of ln(value) or of the value.
        is_relative: See above.
        bounds: Largest departure from the nominal value in deviations.
        own: Whose it is, where it belongs to some recordings alone.
        alike: Which others it is compared with, where it belongs to one of many equal elements.
        is_clock: Whether it is a delay or a lag of readings.
        is_within_row: Whether it is the instant of a change of a recorded input, which lies between two rows of its
            table: it says nothing of the rig, and wherever it ends it is what the table allows.
    """

    name: str
    unit: str
    nominal: float
    deviation: float
    is_relative: bool = True
    bounds: float = 6.0
    own: Own | None = None
    alike: Alike | None = None
    is_clock: bool = False
    is_within_row: bool = False

    @property
    def is_carried(self) -> bool:
        """Whether it means the same in another model of the rig: it is shared, or belongs to a day with a name."""
        return self.own is None or bool(self.own.day)

    def value(self, z: float) -> float:
        """Value at a distance of z deviations."""
        if self.is_relative:
            return self.nominal * math.exp(max(-MOST_FOLD, min(MOST_FOLD, self.deviation * z)))
        return self.nominal + self.deviation * z


@dataclass(frozen=True)
class TermParameter:
    """A free number of a term.

    Args:
        name: Symbol in the term's law.
        unit: SI unit.
        lower: Smallest value (sign or passivity).
        upper: Largest value.
        starts: Values that the search tries first; of the first parameter, the strength, sizes worth trying.
        is_switch: A strength that is wholly there or not at all: fitted at its upper bound, though the search may look
            along it.
        is_instant: An instant of the recordings laid end to end (`diagnosis.models.timeline`).
        negligible: Size of a strength below which it is no finding.
        plausible: Largest size that is believed of a real rig; beyond it a finding stands in for something else.
        plausible_reason: Why.
        scan: Instants from which a fit may begin; empty: evenly spread within the bounds.
        meaning: What it is, in words: a share, a factor or a change of what, or which physical quantity.
        physical: Factor, offset and SI unit of the physical quantity that it stands for, where that is another: the
            bias of a sensor is counted in what its channel typically reads.
        is_reading: Whether it is a reading and no change: 300 K are 27 degC then.
        resolution: Standard deviation that no recording lowers: an error of solving.
    """

    name: str
    unit: str
    lower: float
    upper: float
    starts: tuple[float, ...]
    is_switch: bool = False
    is_instant: bool = False
    negligible: float = 0.0
    plausible: float = math.inf
    plausible_reason: str = ""
    scan: tuple[float, ...] = ()
    meaning: str = ""
    physical: tuple[float, float, str] | None = None
    is_reading: bool = False
    resolution: float = 0.0


@dataclass(frozen=True)
class Term:
    """A law that may be missing, at a place.

    Args:
        identifier: Name in the catalogue; unnamed laws have one too.
        place: For example `string[3]`, `coil[2,5]`, `all coils`, `supply`.
        unit: electrical, thermal, stiffness, mechanical, measurement or other.
        parameters: The first is the strength: at 0 the term is absent.
        is_named: Whether it is an effect with a name.
        law: Formula.
        recording: Number of the recording that it belongs to alone (a fault of a day); None: it holds on any.
        price: -2 log of its prior odds against a law: it was chosen from so many intervals of time.
        is_completing: Whether it is tried only where all others leave more than noise.
    """

    identifier: str
    place: str
    unit: str
    parameters: tuple[TermParameter, ...]
    is_named: bool = True
    law: str = ""
    recording: int | None = None
    price: float = 0.0
    is_completing: bool = False

    def __str__(self) -> str:
        return f"{self.identifier} at {self.place}"


@dataclass(frozen=True)
class Point:
    """Values at which a model is evaluated.

    Args:
        base: z of every parameter, shape (parameters,).
        terms: Terms that are present, with the values of their parameters.
    """

    base: Array
    terms: Mapping[Term, tuple[float, ...]] = field(default_factory=dict)

    def plus(self, term: Term, values: Sequence[float]) -> Point:
        """The same with one term more, or with other values of one."""
        return Point(self.base, {**self.terms, term: tuple(values)})

    def without(self, term: Term) -> Point:
        """The same with one term less."""
        return Point(self.base, {t: v for t, v in self.terms.items() if t != term})

    @property
    def lasting(self) -> Point:
        """The same without what belongs to one recording alone: the faults of a day."""
        return Point(self.base, {t: v for t, v in self.terms.items() if t.recording is None})


@dataclass(frozen=True)
class Layout:
    """What each residual belongs to.

    Args:
        channel: Number of its channel, shape (residuals,).
        time: Its time [s], shape (residuals,).
        names: Names of the channels.
        units: Unit (electrical, ...) whose output each channel measures.
        of_many: Whether each residual is that of a mean of many readings, shape (residuals,); None: none is.
    """

    channel: Array
    time: Array
    names: tuple[str, ...]
    units: tuple[str, ...]
    of_many: AnyArray | None = None


class Model(Protocol):
    """A simulator with the recordings that it is compared with."""

    parameters: Sequence[Parameter]
    layout: Layout

    def residuals(self, points: Sequence[Point]) -> Array:
        """(measured - simulated) / deviation at each point, shape (points, residuals).

        Samples that are not to be used have weight 0. What cannot be simulated is infinite.
        """
        ...

    def base_jacobian(self, point: Point) -> Array:
        """Derivative of the residuals by the z of every parameter, shape (residuals, parameters)."""
        ...


def has_ridges(model: Model) -> bool:
    """Whether its laws leave ridges that bend, and it simulates fast enough to go down them.

    A single arm in Bullet says so of itself; fits of coil networks ended where they began, and took 2 s more.
    """
    return bool(getattr(model, "has_ridges", False))


def refined(model: Model, point: Point) -> bool:
    """Whether a model simulates a point more exactly from now on than it did: what is known of it is out of date.

    A law may be quicker than anything that the model without it does (friction that sets in within millimetres a
    second), and steps of an integration that gave the one do not give the other.
    """
    refine = getattr(model, "refine", None)
    return refine is not None and bool(refine(point))


def limits_of(model: Model, parameter: TermParameter) -> tuple[float, float]:
    """Smallest and largest value that a fit may give a parameter of a term.

    Where the model errs by more than noise, any law that is stretched far enough fills a gap: there, no size is
    taken that no real rig has. Else the readings decide, and a size beyond belief is a reason against the name.
    """
    lower, upper = parameter.lower, parameter.upper
    if not getattr(model, "sizes_are_believed", False) or parameter.is_switch or parameter.is_instant:
        return lower, upper
    most = max(parameter.plausible, parameter.negligible)
    return (max(lower, -most), min(upper, most)) if lower < min(upper, most) else (lower, upper)


def strength_slopes(
    model: Model, point: Point, here: Array | None, tasks: Sequence[tuple[Term, tuple[float, ...]]]
) -> Array:
    """Derivative of the residuals by the strength of terms, shape (tasks, residuals); not finite where it failed.

    Args:
        model: The model; one that has a method `slopes` knows a faster way than a simulation for each.
        point: Where; the terms are absent there.
        here: Residuals at that point; None where they are not at hand.
        tasks: Terms with the values of their parameters; the strength is the step of the difference.
    """
    own = getattr(model, "slopes", None)
    if own is not None:
        return np.asarray(own(point, tasks))
    start = model.residuals([point])[0] if here is None else here
    points = [point.plus(term, values) for term, values in tasks]
    strengths = np.array([values[0] for _, values in tasks])
    with np.errstate(over="ignore", invalid="ignore"):  # what runs away is not finite, as the result may be
        return np.asarray((model.residuals(points) - start) / strengths[:, None])
