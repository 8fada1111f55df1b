"""What an effect may do to the truth, and what is written down about it."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from evaluation.proving.network import Branches
from evaluation.proving.rig import Array, DataSheet

Unit = Literal["electrical", "thermal", "stiffness", "mechanical", "measurement"]
Strength = Literal["weak", "medium", "strong"]
STRENGTHS: tuple[Strength, ...] = ("weak", "medium", "strong")


@dataclass
class Now:
    """The truth at one instant; arrays have shape (coils,) or (coils, cells).

    Args:
        weight: Share of every piece in its wire, shape (cells,).
        time: Begin of the step under way [s].
        moment: Time within it that voltages and currents are asked for [s].
        size: Of the step under way [s].
        voltage: Of the supply [V], or of every string's, shape (strings,).
        wire: Temperature of every piece [K].
        temperature: Mean of every wire [K].
        ambient: Around every coil [K].
        current: [A]
        power: [W]
        stiffness: Of every coil [N/m].
        phase: Share of austenite in every piece [1].
        extension: [m]
        speed: Of the extension [m/s].
        rate: Of the mean temperature [K/s].
        tension: [N]
    """

    weight: Array
    time: float
    moment: float
    size: float
    voltage: float | Array
    wire: Array
    temperature: Array
    ambient: Array
    current: Array
    power: Array
    stiffness: Array
    phase: Array
    extension: Array
    speed: Array
    rate: Array
    tension: Array


@dataclass
class LoopChange:
    """Changes of the loop: shape (coils,) each.

    Args:
        shift: Of all transformation temperatures [K].
        fraction: Of the rise from soft to stiff that is left [1].
    """

    shift: Array
    fraction: Array


@dataclass(frozen=True)
class Place:
    """Where an effect acts.

    Args:
        kind: `coil`, `string`, `all`, `row_gradient`, `column_gradient`, `supply`, `channel`, `quantity` or `swap`.
        numbers: Of coils or strings, from 1: a coil as (string, place in it), a string as (string,).
        amount: Factor on the strength at every coil, shape (coils,).
        channels: Names, for faults of sensors.
    """

    kind: str
    numbers: tuple[tuple[int, ...], ...] = ()
    amount: Array = field(default_factory=lambda: np.zeros(0))
    channels: tuple[str, ...] = ()


class Effect:
    """An effect at a place; what it does not override it leaves alone.

    Args:
        place: Where.
        parameters: Values, SI.

    Class attributes:
        identifier: Name in the answer; that of the catalogue's entry where there is one.
        unit: Where it belongs.
        is_named: Whether physics books and the catalogue have a name for it; False: it is in no catalogue.
        law: Formula with the parameters' names.
        places: Kinds of place.
        same_parameters: Parameters that mean the same in the catalogue's entry.
    """

    identifier: ClassVar[str]
    unit: Unit
    is_named: ClassVar[bool] = True
    law: str
    places: ClassVar[tuple[str, ...]] = ("all",)
    same_parameters: ClassVar[tuple[str, ...]] = ()
    #: Parameter to its range, from weak to strong: a strength is a third of it on a logarithmic scale.
    strengths: ClassVar[Mapping[str, tuple[float, float]]]
    #: Parameter to its range, where it says nothing about the strength.
    ranges: ClassVar[Mapping[str, tuple[float, float]]] = {}
    #: Parameter whose sign may be drawn.
    signed: ClassVar[str] = ""
    #: Whether it sets in at an instant, a parameter `instant`, of one recording.
    is_sudden: ClassVar[bool] = False
    #: Whether it is gone in the recordings after that one (a window that was open) and does not last (a break).
    is_of_a_day: ClassVar[bool] = False
    #: Whether a load must hang from the coils to show it.
    needs_load: ClassVar[bool] = False

    def __init__(self, place: Place, parameters: Mapping[str, float]) -> None:
        self.place = place
        self.parameters = dict(parameters)
        #: Of a sudden effect: the recording that it sets in, from 1.
        self.recording = 1

    def in_recording(self, number: int) -> Effect:
        """The effect as it is in a recording, counted from 1.

        What is sudden is not there before its recording, sets in at its instant in that one, and after it is there from
        the start, or not at all if it is of a day.
        """
        if not self.is_sudden or number == self.recording:
            return self
        never = number < self.recording or self.is_of_a_day
        found = copy(self)
        found.parameters = self.parameters | {"instant": np.inf if never else -np.inf}
        return found

    def begin(self, now: Now) -> None:
        """Before the first step: states of its own start here."""

    def voltage(self, now: Now, voltage: float | Array) -> float | Array:
        """Voltage of the supply [V] where `voltage` was asked for."""
        return voltage

    def resistivity(self, now: Now, factor: Array) -> None:
        """Change the resistance of every piece, as a factor (coils, cells) on its share of the coil's."""

    def branches(self, now: Now, network: Branches) -> None:
        """Change resistances of coils and leads, or the supply."""

    def heat(self, now: Now, wire: Array) -> tuple[Array, Array] | None:
        """Heat per share of wire into every piece [W], and its derivative [W/K]; shape (coils, cells), or None."""
        return None

    def surroundings(self, now: Now, ambient: Array) -> None:
        """Change the temperature around the coils."""

    def convection(self, now: Now, factor: Array) -> None:
        """Change h A of every coil, as a factor (coils,), which is held over a step."""

    def latent(self) -> Array | None:
        """Heat of the whole transformation [J], shape (coils,)."""
        return None

    def duhem(self) -> Array | None:
        """Share of the loop that answers a reversal at once, shape (coils,)."""
        return None

    def loop(self, now: Now, change: LoopChange) -> None:
        """Change the loop; held over a step."""

    def curve(self, now: Now, celsius: Array, stiffness: Array) -> Array:
        """Stiffness of every piece [N/m] at its temperature, where the loop gives `stiffness`; shape (coils, cells)."""
        return stiffness

    def load(self, now: Now, tension: Array) -> None:
        """Change the load of every coil [N]."""

    def length(self, now: Now, extension: Array, before: Array) -> None:
        """Change the extension [m] that the load would give; `before` is that of the step before."""

    def advance(self, now: Now) -> None:
        """After a step of `now.size`: states of its own move on."""

    def is_known_by_catalogue(self) -> bool:
        """Whether the catalogue has an entry for it."""
        return self.is_named


def value_at(span: tuple[float, float], share: float) -> float:
    """Value at a share of the way through a range, 0 to 1, on a logarithmic scale; both ends have one sign."""
    low, high = span
    return float(low * (high / low) ** share)


def drawn_values(
    strengths: Mapping[str, tuple[float, float]],
    ranges: Mapping[str, tuple[float, float]],
    strength: Strength,
    rng: np.random.Generator,
) -> dict[str, float]:
    """Parameters of an effect, log-uniform: those of `strengths` in the third of their range, the others in all of it.

    No value is preferred: a start value of the diagnosis's library cannot be the truth but by chance.
    """
    level = STRENGTHS.index(strength)
    found = {n: value_at(span, (level + float(rng.random())) / len(STRENGTHS)) for n, span in strengths.items()}
    return found | {n: value_at(span, float(rng.random())) for n, span in ranges.items()}


def coil_place(sheet: DataSheet, coil: int) -> Place:
    """One coil, counted from 0."""
    amount = np.zeros(sheet.coils)
    amount[coil] = 1.0
    number = (int(sheet.string_of_coil[coil]) + 1, int(sheet.place_in_string[coil]) + 1)
    return Place("coil", (number,), amount)


def string_place(sheet: DataSheet, string: int) -> Place:
    """All coils of one string, counted from 0."""
    return Place("string", ((string + 1,),), (sheet.string_of_coil == string).astype(np.float64))


def everywhere(sheet: DataSheet, kind: str = "all") -> Place:
    """All coils."""
    return Place(kind, (), np.ones(sheet.coils))


def gradient(sheet: DataSheet, kind: str) -> Place:
    """From -1 at the first to 1 at the last string (`row_gradient`) or place in the strings (`column_gradient`)."""
    along = sheet.string_of_coil if kind == "row_gradient" else sheet.place_in_string
    return Place(kind, (), 2.0 * along / max(int(along.max()), 1) - 1.0)


def drawn_place(kind: str, sheet: DataSheet, rng: np.random.Generator) -> Place:
    """A place of a kind, drawn."""
    if kind == "coil":
        return coil_place(sheet, int(rng.integers(sheet.coils)))
    if kind == "string":
        return string_place(sheet, int(rng.integers(len(sheet.strings))))
    if kind.endswith("gradient"):
        return gradient(sheet, kind)
    return everywhere(sheet, kind)
