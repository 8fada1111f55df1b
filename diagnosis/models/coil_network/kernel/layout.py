"""What a network consists of, its parameters with their defaults, and the quantities that it can record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Literal

import numpy as np
import numpy.typing as npt

from diagnosis.candidates.candidate import Axis

Array = npt.NDArray[np.float64]

#: Parameters over the coils: name to (default, unit). Defaults are the paper's coil (scenarios/parameter_sets).
COIL_FIELDS: Mapping[str, tuple[float, str]] = {
    "reference_resistance": (2.2, "ohm"),
    "resistance_temperature_coefficient": (0.0, "1/K"),
    "reference_temperature": (295.15, "K"),
    "power_gain": (1.0, "1"),
    "conductance": (90.0 * 97.85e-6, "W/K"),
    "capacity": (6450.0 * 7.328e-9 * 837.0, "J/K"),
    "ambient_offset": (0.0, "K"),
    "cooling_rate": (0.14, "1/s"),
    "off_power": (1e-9, "W"),
    "use_regressed_cooling_rate": (1.0, "1"),
    "initial_temperature": (295.15, "K"),
    "initial_loop_position": (0.0, "1"),
    # These eight must follow each other: record.c reads them as two branches.
    "heating_a": (230.5, "N/m"),
    "heating_b": (17443.0, "1"),
    "heating_c": (0.1669, "1/K"),
    "heating_d": (157.1, "N/m"),
    "cooling_a": (199.6, "N/m"),
    "cooling_b": (696.0, "1"),
    "cooling_c": (0.1549, "1/K"),
    "cooling_d": (157.9, "N/m"),
    "rest_length": (0.0094, "m"),
    "load": (0.0, "N"),
    "cycles_before": (0.0, "1"),
}
STRING_FIELDS: Mapping[str, tuple[float, str]] = {"string_resistance": (0.0, "ohm")}
SOURCE_FIELDS: Mapping[str, tuple[float, str]] = {"supply_resistance": (0.0, "ohm")}
#: Over the quantities: how late the clock of all channels of one quantity is, how slow and how far off their sensors.
QUANTITY_FIELDS: Mapping[str, tuple[float, str]] = {
    "clock_offset": (0.0, "s"),
    "sensor_lag": (0.0, "s"),
    "gain_error": (0.0, "1"),
}
FieldAxis = Axis | Literal["quantity"]
AXIS_OF_FIELD: Mapping[str, FieldAxis] = {
    **dict.fromkeys(COIL_FIELDS, "coil"),
    **dict.fromkeys(STRING_FIELDS, "string"),
    **dict.fromkeys(SOURCE_FIELDS, "source"),
    **dict.fromkeys(QUANTITY_FIELDS, "quantity"),
}


@dataclass(frozen=True)
class Quantity:
    """Something that a network records.

    Args:
        unit: SI unit.
        axis: Elements: coils, strings, or the supply as a whole (one element).
        is_flow: Belongs to a whole step (an electrical quantity jumps with the supply), not to its end.
        array: Field of `Step` in C.
        needs_circuit: There is none of it where power is given.
        is_derived: It follows from others at once; recorded where it is asked for by its name alone.
    """

    unit: str
    axis: Literal["coil", "string", "supply"]
    is_flow: bool
    array: str
    needs_circuit: bool = False
    is_derived: bool = False


QUANTITIES: Mapping[str, Quantity] = {
    "temperature": Quantity("K", "coil", False, "temperature"),
    "current": Quantity("A", "string", True, "string_current", needs_circuit=True),
    "supply_current": Quantity("A", "supply", True, "supply_current", needs_circuit=True),
    "extension": Quantity("m", "coil", False, "extension"),
    "stiffness": Quantity("N/m", "coil", False, "stiffness"),
    "resistance": Quantity("ohm", "coil", False, "resistance"),
    "power": Quantity("W", "coil", True, "power"),
    "length": Quantity("m", "coil", False, "length"),
    "tension": Quantity("N", "coil", False, "tension", is_derived=True),
    "voltage": Quantity("V", "coil", True, "voltage", needs_circuit=True, is_derived=True),
    # Across the coils of a string, without its wires; at the terminals of its source, behind the inner resistance.
    "string_voltage": Quantity("V", "string", True, "string_voltage", needs_circuit=True, is_derived=True),
    "terminal_voltage": Quantity("V", "string", True, "terminal_voltage", needs_circuit=True, is_derived=True),
    # Out of the terminals of all sources.
    "supply_power": Quantity("W", "supply", True, "supply_power", needs_circuit=True, is_derived=True),
    # The current of every string at the sample times of the supply's current, for its derivatives.
    "string_share": Quantity("A", "string", True, "string_current", needs_circuit=True),
}

#: Coils up to which any two of them may touch; in a larger network those that are neighbours.
ANY_TWO = 8
VECTOR = 8  # doubles in the widest vector register (AVX-512)


@dataclass(frozen=True)
class CoilNetworkLayout:
    """Which coils (or lumped heaters) there are and how they are connected.

    Coils are numbered string by string, as everywhere in the project; indices here count from 0.

    Args:
        coils: Number of coils.
        strings: Coils of every string, summing up to `coils`; empty where power is given and there is no circuit.
        supply: One source for all strings or one for each.
        neighbours: Pairs of coils that touch, for heat between neighbours; default: consecutive coils of a string and
            coils at the same place of consecutive strings.

    Raises:
        ValueError: Numbers that do not fit together.
    """

    coils: int
    strings: tuple[int, ...] = ()
    supply: Literal["common", "per_string"] = "common"
    neighbours: tuple[tuple[int, int], ...] | None = None

    def __post_init__(self) -> None:
        if self.coils < 1:
            raise ValueError(f"coils is {self.coils}: at least one is needed")
        if self.strings and (sum(self.strings) != self.coils or min(self.strings) < 1):
            raise ValueError(f"strings {self.strings} must hold at least one coil each and {self.coils} in all")
        for a, b in self.neighbours or ():
            if not (0 <= a < self.coils and 0 <= b < self.coils and a != b):
                raise ValueError(f"neighbours ({a}, {b}): give two different coils from 0 to {self.coils - 1}")

    @property
    def width(self) -> int:
        """Coils rounded up to whole vectors."""
        return -(-self.coils // VECTOR) * VECTOR

    @property
    def sources(self) -> int:
        """Voltage sources."""
        return 0 if not self.strings else 1 if self.supply == "common" else len(self.strings)

    @property
    def first(self) -> tuple[int, ...]:
        """First coil of every string, then the number of coils."""
        return tuple(int(v) for v in np.cumsum((0, *self.strings)))

    @cached_property
    def string_of_coil(self) -> npt.NDArray[np.int64]:
        """Index of each coil's string (0 for all where there is no circuit), shape (coils,); not to be written."""
        found = np.repeat(np.arange(len(self.strings) or 1), self.strings or (self.coils,)).astype(np.int64)
        found.flags.writeable = False
        return found

    @cached_property
    def place_in_string(self) -> npt.NDArray[np.int64]:
        """Index of each coil within its string, shape (coils,); not to be written."""
        found = np.concatenate([np.arange(n) for n in self.strings or (self.coils,)]).astype(np.int64)
        found.flags.writeable = False
        return found

    @cached_property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Pairs of coils that touch."""
        if self.neighbours is not None:
            return self.neighbours
        row, column = self.string_of_coil, self.place_in_string
        at = {(int(r), int(c)): i for i, (r, c) in enumerate(zip(row, column))}
        return tuple((i, at[other]) for (r, c), i in at.items() for other in ((r, c + 1), (r + 1, c)) if other in at)

    @cached_property
    def contacts(self) -> tuple[tuple[int, int], ...]:
        """Pairs of coils that may touch although the rig does not mean them to; element n of the axis `pair`."""
        if self.neighbours is not None or self.coils > ANY_TWO:
            return self.pairs
        return tuple(combinations(range(self.coils), 2))

    @cached_property
    def _elements(self) -> dict[str, int]:
        sizes = {"coil": self.coils, "string": len(self.strings), "supply": 1 if self.strings else 0}
        return {
            name: 0 if quantity.needs_circuit and not self.strings else sizes[quantity.axis]
            for name, quantity in QUANTITIES.items()
        }

    @cached_property
    def _channels(self) -> dict[str, int]:
        first = np.cumsum([0, *self._elements.values()])
        return {name: int(n) for name, n in zip(QUANTITIES, first)}

    @cached_property
    def _sizes(self) -> dict[str, int]:
        channels = sum(self._elements.values())
        sizes = {"coil": self.coils, "string": len(self.strings), "source": self.sources, "channel": channels}
        return {**sizes, "pair": len(self.contacts), "quantity": len(QUANTITIES)}

    def elements(self, quantity: str) -> int:
        """Number of elements of a quantity."""
        return self._elements[quantity]

    def channel(self, quantity: str) -> int:
        """Number of the first channel of a quantity; its elements follow in order."""
        return self._channels[quantity]

    def size(self, axis: FieldAxis) -> int:
        """Length of a parameter array over an axis."""
        return self._sizes[axis]

    def stride(self, axis: FieldAxis) -> int:
        """Room of that array in the network: coils are padded to whole vectors."""
        return self.width if axis == "coil" else self.size(axis)
