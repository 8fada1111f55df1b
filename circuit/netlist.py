"""Netlist of a coil network: coils in series make a string, strings in parallel hang on one supply or one each.

Pure text and numbers; nothing here calls ngspice. One string, from its supply to ground:

    supply source - [supply resistance] - ammeter - [string resistance] - [contacts] - coil 1 - coil 2 - ... - ground

Every node has a path to ground through finite resistances, also where coils are open, so no node floats and no
`.options rshunt` (which would draw current of its own) is needed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from circuit.elements import Contact, Drop, Element, Lead, Series, check

#: Resistance of the only open coil of a string [ohm]. Against a true break it lets V / 1e12 ohm pass: 6 pA at 6 V.
OPEN_RESISTANCE = 1e12

#: Resistance of each open coil where a string has several [ohm]; 6 nA at 6 V. The coils between two breaks hang on
#: these alone: beside coils of 1 ohm their potential is right to 1e-7, with 1e12 ohm only to 2e-4 (rounding of
#: 1 S + 1e-12 S), and ngspice fails beside a few microohm.
SHARED_OPEN_RESISTANCE = 1e9

#: Least resistance [ohm]: what ngspice takes silently for 0 ohm. Below it currents lose digits: the error relative to
#: 6 V / 2.2 ohm was 1e-10 beside 1 microohm and 2.5e-7 beside 1 nanoohm.
MIN_RESISTANCE = 1e-3

#: Greatest resistance [ohm].
MAX_RESISTANCE = OPEN_RESISTANCE


@dataclass(frozen=True)
class Network:
    """Strings in parallel, coils in series; coils are counted from 1, string by string, from supply to ground.

    Args:
        strings: Number of coils of every string; (6, 6, 6, 6, 6, 6) is the paper's prototype (section 2.2).
        supply: One supply for all strings, or one for each.
        supply_resistance: In series with every source [ohm]; 0 is an ideal source.
        string_resistance: In series with every string, for example its wires [ohm].
        open_coils: Broken coils, `OPEN_RESISTANCE`, or `SHARED_OPEN_RESISTANCE` each where a string has several: they
            then share its voltage equally, which is a convention, for the true potential between breaks is undefined.
        shorted_coils: Bridged coils: both ends are one node, so exactly 0 V; ngspice cannot take 0 ohm.
        elements: Contacts, leads, inner resistances and current limits (`circuit.elements`).

    Raises:
        ValueError: A string without coils, a resistance out of range, a coil that does not exist or is both open and
            shorted, or strings of shorted coils alone that nothing limits the current of.
    """

    strings: tuple[int, ...]
    supply: Literal["common", "per_string"] = "common"
    supply_resistance: float = 0.0
    string_resistance: float = 0.0
    open_coils: tuple[int, ...] = ()
    shorted_coils: tuple[int, ...] = ()
    elements: tuple[Element, ...] = ()

    def __post_init__(self) -> None:
        if not self.strings:
            raise ValueError("a network without strings; give the number of coils of each, for example [6, 6]")
        for number, coils in enumerate(self.strings, 1):
            if not isinstance(coils, int) or isinstance(coils, bool) or coils < 1:
                raise ValueError(f"string {number} has {coils!r} coils; give every string a whole number, at least one")
        if self.supply not in ("common", "per_string"):
            raise ValueError(f"supply {self.supply!r} is unknown; use `common` or `per_string`")
        for name, value in (("supply", self.supply_resistance), ("string", self.string_resistance)):
            if value != 0.0 and not MIN_RESISTANCE <= value <= MAX_RESISTANCE:
                raise ValueError(
                    f"{name}_resistance is {value:g} ohm; give 0 or {MIN_RESISTANCE:g} to {MAX_RESISTANCE:g} ohm"
                )
        self._check_faults()
        self._check_short_circuits()
        check(self.elements, len(self.strings), self.sources)

    def _check_faults(self) -> None:
        for name, coils in (("open_coils", self.open_coils), ("shorted_coils", self.shorted_coils)):
            for coil in coils:
                if not 1 <= coil <= self.coils:
                    raise ValueError(f"{name}: there is no coil {coil}; coils are numbered 1 to {self.coils}")
            if len(set(coils)) != len(coils):
                raise ValueError(f"{name} {list(coils)} names a coil twice; name each once")
        both = sorted(set(self.open_coils) & set(self.shorted_coils))
        if both:
            raise ValueError(f"coil {both[0]} is both in open_coils and in shorted_coils; leave it in one")

    def _check_short_circuits(self) -> None:
        """Zero-ohm loops have no solution, and parallel zero-ohm strings share their current arbitrarily."""
        if self.string_resistance > 0.0:
            return
        shorted = set(self.shorted_coils)
        bridged = [s for s, coils in enumerate(self.coils_of_strings(), 1) if shorted.issuperset(coils)]
        allowed = 0 if self.supply_resistance == 0.0 else 1 if self.supply == "common" else len(self.strings)
        if len(bridged) > allowed:
            raise ValueError(
                f"all coils of string {bridged[allowed]} are shorted, which leaves its current without a limit; "
                "give a string_resistance, or leave one coil whole"
            )

    @property
    def coils(self) -> int:
        """Number of coils."""
        return sum(self.strings)

    @property
    def sources(self) -> int:
        """Number of voltage sources."""
        return 1 if self.supply == "common" else len(self.strings)

    @property
    def series(self) -> Series:
        """Elements by place."""
        return Series(self.elements, len(self.strings), self.sources)

    def supply_resistances(self) -> list[float]:
        """In series with every source [ohm]: its inner resistance and those among the elements."""
        return [self.supply_resistance + float(r) for r in self.series.source_resistances()]

    def strings_with_contacts(self) -> list[int]:
        """Strings (from 1) that have a contact or a lead among the elements."""
        return sorted({e.string for e in self.elements if isinstance(e, Contact | Lead | Drop)})

    def coils_of_strings(self) -> list[range]:
        """Coil numbers (from 1) of every string."""
        ends = [sum(self.strings[: s + 1]) for s in range(len(self.strings))]
        return [range(end - count + 1, end + 1) for count, end in zip(self.strings, ends)]

    def open_resistances(self) -> dict[int, float]:
        """Coil (from 1) to resistance [ohm] of every open coil."""
        groups = [[c for c in coils if c in self.open_coils] for coils in self.coils_of_strings()]
        return {c: OPEN_RESISTANCE if len(g) == 1 else SHARED_OPEN_RESISTANCE for g in groups for c in g}

    def place(self, coil: int) -> str:
        """A coil (from 1) in words, for error texts."""
        string = next(s for s, coils in enumerate(self.coils_of_strings(), 1) if coil in coils)
        return f"coil {coil} (string {string}, position {coil - self.coils_of_strings()[string - 1].start + 1})"


def source_name(source: int) -> str:
    """Element of a voltage source (from 1)."""
    return f"vsupply{source}"


def ammeter_name(string: int) -> str:
    """Element of the 0 V source that measures the current of a string (from 1)."""
    return f"vstring{string}"


def contact_name(string: int) -> str:
    """Element of the contacts and leads of a string (from 1): a voltage of so many ohm times its current, 0 too."""
    return f"hcontact{string}"


def coil_name(coil: int) -> str:
    """Element of a coil (from 1) that is neither open nor shorted."""
    return f"rcoil{coil}"


def coil_nodes(network: Network) -> list[str]:
    """Node at the supply side of every coil. A shorted coil's is that of the next coil, or ground, `0`."""
    nodes: list[str] = []
    for coils in reversed(network.coils_of_strings()):
        node = "0"
        for coil in reversed(coils):
            node = node if coil in network.shorted_coils else f"n{coil}"
            nodes.append(node)
    return nodes[::-1]


def render(network: Network) -> str:
    """Netlist text without title line: 0 V at every source, 1 ohm in every coil, to be altered before each solution."""
    return "\n".join([*_sources(network), *_strings(network), ".end"])


def _sources(network: Network) -> Iterator[str]:
    for source, resistance in enumerate(network.supply_resistances(), 1):
        if resistance > 0.0:
            yield f"{source_name(source)} e{source} 0 dc 0"
            yield f"rsupply{source} e{source} s{source} {resistance!r}"
        else:
            yield f"{source_name(source)} s{source} 0 dc 0"


def _strings(network: Network) -> Iterator[str]:
    nodes, open_resistances = coil_nodes(network), network.open_resistances()
    for string, coils in enumerate(network.coils_of_strings(), 1):
        source = 1 if network.supply == "common" else string
        top = nodes[coils[0] - 1]
        if string in network.strings_with_contacts():
            yield f"{contact_name(string)} c{string} {top} {ammeter_name(string)} 0"
            top = f"c{string}"
        if network.string_resistance > 0.0:
            yield f"{ammeter_name(string)} s{source} w{string} dc 0"
            yield f"rstring{string} w{string} {top} {network.string_resistance!r}"
        else:
            yield f"{ammeter_name(string)} s{source} {top} dc 0"
        for coil in coils:
            end = "0" if coil == coils[-1] else nodes[coil]
            if coil in open_resistances:
                yield f"ropen{coil} {nodes[coil - 1]} {end} {open_resistances[coil]!r}"
            elif coil not in network.shorted_coils:
                yield f"{coil_name(coil)} {nodes[coil - 1]} {end} 1"
