"""What a real coil network has beside its coils: contacts, leads that warm up, sources that are not ideal.

Each element lies in series with a string or a source. A contact may come at an instant; the step in which it comes
takes the part of it that lies after the instant, so that the heat does not depend on where steps end.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array, seconds


@dataclass(frozen=True)
class Contact:
    """A contact resistance in a string (R. Holm, Electric Contacts, 4th ed., Springer 1967, chapter 1).

    Args:
        string: String, from 1.
        resistance: [ohm].
        instant: Time from which on it is there [s]; None: always.
    """

    string: int
    resistance: float
    instant: float | None = None

    def at(self, begin: int, end: int) -> float:
        """Its resistance over a step from `begin` to `end` [ns]: the share that lies after the instant."""
        if self.instant is None:
            return self.resistance
        size = max(seconds(end - begin), 1e-12)
        return self.resistance * min(max((seconds(end) - self.instant) / size, 0.0), 1.0)


@dataclass(frozen=True)
class Lead:
    """A lead that warms up with its current: R = rise I^2 in series with a string.

    Args:
        string: String, from 1.
        rise: [ohm/A^2].
    """

    string: int
    rise: float


@dataclass(frozen=True)
class Drop:
    """A voltage that a string takes whatever its current, as a film on a contact does: R = voltage / (|I| + 10 mA).

    Below some 10 mA it fades, so that the string has one solution (R. Holm, Electric Contacts, 4th ed., Springer 1967,
    chapter 27).

    Args:
        string: String, from 1.
        voltage: [V].
    """

    string: int
    voltage: float


@dataclass(frozen=True)
class SourceResistance:
    """Inner resistance of a source (Thevenin), beside `supply_resistance`.

    Args:
        supply: Source, from 1.
        resistance: [ohm].
    """

    supply: int
    resistance: float


@dataclass(frozen=True)
class CurrentLimit:
    """A source that lowers its voltage where its current would exceed a limit.

    With the current I that would flow without it: I + share (min(I, limit) - I). Source: P. Horowitz and W. Hill, The
    Art of Electronics, 3rd ed., Cambridge 2015, section 9.13.

    Args:
        supply: Source, from 1.
        limit: [A].
        share: 1: the limit holds; less: it gives way.
    """

    supply: int
    limit: float
    share: float = 1.0


@dataclass(frozen=True)
class SlowSource:
    """A source whose voltage follows what is set behind a first-order delay: tau dV/dt = V_set - V; 0 V at the start.

    A step feels the mean over it, with the exact exponential (the same in the network's term `unnamed_supply_delayed`).

    Args:
        supply: Source, from 1.
        delay: tau [s].
    """

    supply: int
    delay: float


#: Current [A] below which a `Drop` fades.
FADING = 0.01

Element = Contact | Lead | Drop | SourceResistance | CurrentLimit | SlowSource


def check(elements: Sequence[Element], strings: int, sources: int) -> None:
    """Raise ValueError for an element at a place that does not exist, or that would give energy."""
    for element in elements:
        is_in_string = isinstance(element, Contact | Lead | Drop)
        place = element.string if isinstance(element, Contact | Lead | Drop) else element.supply
        count, what = (strings, "string") if is_in_string else (sources, "supply")
        if not 1 <= place <= count:
            raise ValueError(f"elements: there is no {what} {place}; they are numbered 1 to {count}")
        numbers = {k: v for k, v in vars(element).items() if k not in ("string", "supply", "instant") and v is not None}
        for name, number in numbers.items():
            if not (math.isfinite(number) and number >= 0.0):
                raise ValueError(f"elements: {name} of {what} {place} is {number:g}; it must be 0 or positive")
        if isinstance(element, CurrentLimit) and (element.limit == 0.0 or element.share > 1.0):
            raise ValueError(f"elements: the limit of supply {place} must be above 0 A and its share at most 1")
    slow = [e.supply for e in elements if isinstance(e, SlowSource)]
    twice = sorted({n for n in slow if slow.count(n) > 1})
    if twice:
        raise ValueError(f"elements: supply {twice[0]} has more than one slow_source; give it one delay")


@dataclass(frozen=True)
class Series:
    """Elements of a network, summed up by place.

    Args:
        elements: All elements.
        strings: Number of strings.
        sources: Number of sources.
    """

    elements: Sequence[Element]
    strings: int
    sources: int

    def contacts(self, begin: int, end: int) -> Array:
        """Resistance of the contacts of each string over a step [ohm], shape (strings,)."""
        return _summed(self.strings, ((e.string, e.at(begin, end)) for e in self.elements if isinstance(e, Contact)))

    def rises(self) -> Array:
        """Sum of the rises of each string's leads [ohm/A^2], shape (strings,)."""
        return _summed(self.strings, ((e.string, e.rise) for e in self.elements if isinstance(e, Lead)))

    def drops(self) -> Array:
        """Sum of the voltages that each string takes whatever its current [V], shape (strings,)."""
        return _summed(self.strings, ((e.string, e.voltage) for e in self.elements if isinstance(e, Drop)))

    def source_resistances(self) -> Array:
        """[ohm], shape (sources,)."""
        own = ((e.supply, e.resistance) for e in self.elements if isinstance(e, SourceResistance))
        return _summed(self.sources, own)

    def delays(self) -> Array:
        """Delay of each source [s], 0 where it is ideal, shape (sources,)."""
        return _summed(self.sources, ((e.supply, e.delay) for e in self.elements if isinstance(e, SlowSource)))

    def lowered(self, voltage: Array, current: Array) -> Array:
        """Voltages with which the limits are kept, by the currents that flow without; coils are linear in the voltage.

        Args:
            voltage: [V], shape (sources,).
            current: Out of each source at that voltage [A], shape (sources,).
        """
        found = voltage.copy()
        for element in self.elements:
            if isinstance(element, CurrentLimit):
                n = element.supply - 1
                free = abs(float(current[n]))
                if free > element.limit:
                    found[n] = voltage[n] * (1.0 + element.share * (element.limit / free - 1.0))
        return found


def _summed(count: int, numbers: Iterable[tuple[int, float]]) -> Array:
    """Sum of the numbers at each place (counted from 1), shape (count,)."""
    found = np.zeros(count)
    for place, number in numbers:
        found[place - 1] += number
    return found
