"""Quantities of the FMUs of a system: what laws may use, with the sizes that they have in the recordings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion, parse_unit


@dataclass(frozen=True)
class Quantity:
    """A variable of an FMU that laws may use.

    Args:
        name: Its name.
        unit: Its unit; of a temperature K.
        size: How far it moves in the recordings as the model has them, in that unit.
        middle: Value about which it moves.
        rate: How fast it changes, per second.
        stated: Middle and size in the unit that the FMU states, where that is another one.
        least: Smallest value that it takes in the recordings, in `unit`.
        most: Largest one; not above the smallest: not known, or it does not move.
    """

    name: str
    unit: str
    size: float
    middle: float
    rate: float
    stated: tuple[float, float] | None = None
    least: float = 0.0
    most: float = 0.0

    @property
    def peak(self) -> float:
        """Farthest that it goes from its middle in the recordings; 0: not known."""
        return max(self.most - self.middle, self.middle - self.least) if self.least < self.most else 0.0

    def value_at(self, share: float) -> float:
        """Value at a share of the way from the least to the largest one, of a sine where these are not known."""
        least, most = self.least, self.most
        if not least < most:
            least, most = self.middle - math.sqrt(2.0) * self.size, self.middle + math.sqrt(2.0) * self.size
        return least + share * (most - least)

    @property
    def in_fmu(self) -> tuple[float, float]:
        """Middle and size in the unit of the FMU."""
        return self.stated or (self.middle, self.size)


@dataclass(frozen=True)
class Changeable:
    """A parameter that may change with a quantity.

    Args:
        quantity: The parameter; its size is its value.
        moves: States whose derivatives hold it.
        alike: Other parameters that only act as a product with it.
    """

    quantity: Quantity
    moves: tuple[str, ...]
    alike: tuple[str, ...] = ()


@dataclass
class Places:
    """Quantities of the FMUs of a system.

    Args:
        component: Name of the FMU.
        states: Continuous states by name, in order.
        inputs: Inputs that are connected.
        outputs: Outputs of a Co-Simulation FMU.
        readings: Outputs of a Model Exchange FMU that are recorded or connected, and neither a state nor a derivative.
        velocity_of: Position to its velocity.
        apart: Two states of one unit to what they are apart by, whose name is that difference as a formula.
        derivatives_read: State to the outputs that are its derivative, times a factor in their units, plus a constant.
        parts_read: State to outputs that are a part of its derivative, with the factor of that in their units, and the
            states over which that part acts.
        states_read: States, and outputs that are a straight line in one of them alone.
        output_units: Unit of each of these outputs.
        twist_of: State whose derivative is the difference of two others, to these two.
        acted_on_by: State to the other states that its derivative depends on.
        parameters: Parameters that its derivatives hold.
        far: Quantities of other components that move and that nothing connects to this one, by the names of inputs for
            them; and what these get.
        room: Temperature of the surroundings [K], where no input has it and the equations tell it.
        untried: Where no law can be tried, and why.
        is_hidden: Whether the FMU is used by Co-Simulation, which hides its states.
    """

    component: str
    states: dict[str, Quantity] = field(default_factory=dict)
    inputs: dict[str, Quantity] = field(default_factory=dict)
    outputs: dict[str, Quantity] = field(default_factory=dict)
    readings: dict[str, Quantity] = field(default_factory=dict)
    velocity_of: dict[str, str] = field(default_factory=dict)
    apart: dict[tuple[str, str], Quantity] = field(default_factory=dict)
    twist_of: dict[str, tuple[str, str]] = field(default_factory=dict)
    derivatives_read: dict[str, dict[str, float]] = field(default_factory=dict)
    parts_read: dict[str, dict[str, tuple[float, frozenset[str]]]] = field(default_factory=dict)
    states_read: frozenset[str] = frozenset()
    output_units: dict[str, str] = field(default_factory=dict)
    acted_on_by: dict[str, frozenset[str]] = field(default_factory=dict)
    parameters: dict[str, Changeable] = field(default_factory=dict)
    far: dict[str, tuple[Quantity, str]] = field(default_factory=dict)
    room: float | None = None
    untried: list[str] = field(default_factory=list)
    is_hidden: bool = False


def quantity_of(name: str, unit: str, courses: Sequence[Array], step: float, is_difference: bool = False) -> Quantity:
    """A quantity with the sizes that it has; a temperature, and what two of them are apart by, in kelvin.

    Args:
        name: Its name.
        unit: Of the courses.
        courses: Its values in each recording.
        step: Time between two of them [s].
        is_difference: Whether it is what two quantities are apart by.
    """
    middle = float(np.median(np.concatenate([v[:1] for v in courses])))
    size = float(np.sqrt(np.mean([np.mean((v - middle) ** 2) for v in courses])))
    slopes = [np.gradient(v, step) for v in courses if len(v) > 1]
    rate = float(np.sqrt(np.mean([np.mean(s**2) for s in slopes]))) if slopes else 0.0
    size = size or max(abs(middle), 1.0)
    least, most = min(float(np.min(v)) for v in courses), max(float(np.max(v)) for v in courses)
    stated = None
    if parse_unit(unit).dimensionality == parse_unit("K").dimensionality:
        stated = middle, size
        factor, offset = conversion(unit, "K")
        unit, size, rate = "K", factor * size, factor * rate
        middle, least, most = (factor * v + (0.0 if is_difference else offset) for v in (middle, least, most))
    rate = rate or size / max(step * 100, 1e-9)
    return Quantity(name, unit, size, middle, rate, stated, least, most)
