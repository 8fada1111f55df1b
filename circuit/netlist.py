"""The coil network as a netlist: coils in series make a string, strings are in parallel. No simulator here."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Literal

#: Resistance of an open coil [Ohm]: 6 V leave 6 pA.
OPEN_RESISTANCE = 1e12


@dataclass(frozen=True)
class Network:
    """Strings of coils.

    Args:
        strings: Number of coils of every string.
        supply: "common": one voltage source for all strings; "per_string": one for each.
        supply_resistance: Internal resistance of every source [Ohm].
        string_resistance: Resistance of the leads of every string [Ohm].
        open_coils: Coils that are open, counted from 1, string by string.
        shorted_coils: Coils that are shorted.

    Raises:
        ValueError: No strings, an empty string, a resistance that is negative or not finite, or a coil that does not
            exist or is both open and shorted.
    """

    strings: tuple[int, ...]
    supply: Literal["common", "per_string"] = "common"
    supply_resistance: float = 0.0
    string_resistance: float = 0.0
    open_coils: tuple[int, ...] = ()
    shorted_coils: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if not self.strings or any(not isinstance(n, int) or isinstance(n, bool) or n < 1 for n in self.strings):
            raise ValueError(f"strings is {list(self.strings)}: give at least one string of at least one coil")
        if self.supply not in ("common", "per_string"):
            raise ValueError(f"supply is {self.supply!r}: give 'common' or 'per_string'")
        for name in ("supply_resistance", "string_resistance"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise ValueError(f"{name} is {value} Ohm: give zero or a positive number")
        for name in ("open_coils", "shorted_coils"):
            wrong = [c for c in getattr(self, name) if not 1 <= c <= self.coils]
            if wrong:
                raise ValueError(f"{name} names coil {wrong[0]}: there are coils 1 to {self.coils}")
        both = sorted(set(self.open_coils) & set(self.shorted_coils))
        if both:
            raise ValueError(f"coil {both[0]} is both in open_coils and in shorted_coils: it can be only one")
        if self.supply_resistance == 0 and self.string_resistance == 0:
            for string, coils in enumerate(self.members()):
                if all(c + 1 in self.shorted_coils for c in coils):
                    raise ValueError(
                        f"all coils of string {string + 1} are in shorted_coils, which shorts the supply: give a "
                        "supply_resistance or a string_resistance"
                    )

    @property
    def coils(self) -> int:
        """Number of coils."""
        return sum(self.strings)

    @property
    def supplies(self) -> int:
        """Number of voltage sources."""
        return 1 if self.supply == "common" else len(self.strings)

    def members(self) -> list[range]:
        """Indices of the coils of every string, from 0."""
        ends = list(itertools.accumulate(self.strings))
        return [range(end - n, end) for n, end in zip(self.strings, ends, strict=True)]


@dataclass(frozen=True)
class Netlist:
    """Text for ngspice and the names in it.

    Args:
        text: Netlist, one element per line.
        sources: Voltage source of every supply.
        ammeters: Zero-volt source that measures the current of every string.
        resistors: Element of every coil; empty where the coil is open or shorted and has no settable resistance.
        coil_nodes: (positive, negative) node of every coil; "0" is ground.
        supply_nodes: Node at which every string takes its current, behind the source's internal resistance.
    """

    text: str
    sources: tuple[str, ...]
    ammeters: tuple[str, ...]
    resistors: tuple[str, ...]
    coil_nodes: tuple[tuple[str, str], ...]
    supply_nodes: tuple[str, ...]


def netlist(network: Network) -> Netlist:
    """Netlist of a network; voltages and resistances are set later.

    Every string begins with a zero-volt source as ammeter and ends at ground. An open coil is a resistor of
    `OPEN_RESISTANCE`; a shorted one is a zero-volt source, because ngspice turns a resistance of 0 into 1 mOhm.
    """
    lines: list[str] = []
    sources, feeds = _sources(network, lines)
    ammeters: list[str] = []
    resistors: list[str] = []
    nodes: list[tuple[str, str]] = []
    for s, coils in enumerate(network.members()):
        node = f"b{s + 1}"
        ammeters.append(f"vm{s + 1}")
        lines.append(f"vm{s + 1} {feeds[s]} {node} dc 0")
        if network.string_resistance > 0:
            lines.append(f"rw{s + 1} {node} c{s + 1} {network.string_resistance!r}")
            node = f"c{s + 1}"
        for coil in coils:
            following = "0" if coil == coils[-1] else f"n{coil + 1}"
            nodes.append((node, following))
            resistors.append(_coil(network, coil + 1, node, following, lines))
            node = following
    text = "\n".join(["* coil network", *lines, ".end"])
    return Netlist(text, tuple(sources), tuple(ammeters), tuple(resistors), tuple(nodes), tuple(feeds))


def _sources(network: Network, lines: list[str]) -> tuple[list[str], list[str]]:
    """Voltage sources, and the node that feeds each string."""
    sources, outlets = [], []
    for i in range(network.supplies):
        outlet = f"s{i + 1}"
        lines.append(f"vs{i + 1} {outlet} 0 dc 0")
        sources.append(f"vs{i + 1}")
        if network.supply_resistance > 0:
            lines.append(f"rs{i + 1} {outlet} t{i + 1} {network.supply_resistance!r}")
            outlet = f"t{i + 1}"
        outlets.append(outlet)
    return sources, outlets * len(network.strings) if network.supply == "common" else outlets


def _coil(network: Network, number: int, node: str, following: str, lines: list[str]) -> str:
    if number in network.shorted_coils:
        lines.append(f"vc{number} {node} {following} dc 0")
        return ""
    if number in network.open_coils:
        lines.append(f"rc{number} {node} {following} {OPEN_RESISTANCE!r}")
        return ""
    lines.append(f"rc{number} {node} {following} 1")
    return f"rc{number}"
