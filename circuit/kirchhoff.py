"""Kirchhoff's and Ohm's laws, held against what ngspice returned: a lost alteration or a bad solution shows here.

The checks use quantities that ngspice solves separately: the current of each string and of each source are unknowns
of its equations (modified nodal analysis: Ho, Ruehli and Brennan, IEEE Trans. Circuits Syst. 22 (1975) 504-509), as
are the node voltages; the given resistances are ours, not those that ngspice holds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from circuit.netlist import Network
from cosim.unit.protocol import Array

#: Relative tolerance of every law. None of some 9000 solutions of random networks (0.001 to 8e5 ohm in one string, open
#: and shorted coils) broke a law by 1e-15; four orders above that still find 0.12 nV at a coil of the paper's network.
#: Voltages count relative to the greatest source, currents to what it would drive through a string's least resistance.
TOLERANCE = 1e-11


@dataclass(frozen=True)
class Solution:
    """One operating point.

    Args:
        source_voltage: Of every source [V], shape (sources,).
        resistance: Of every coil [ohm], as given, shape (coils,).
        node_voltage: Of the supply side of every coil, against ground [V], shape (coils,).
        string_current: [A], shape (strings,).
        source_current: Out of the positive terminal [A], shape (sources,).
        contacts: Resistance of contacts and leads in series with every string [ohm], shape (strings,).
    """

    source_voltage: Array
    resistance: Array
    node_voltage: Array
    string_current: Array
    source_current: Array
    contacts: Array


class Laws:
    """The laws of one network.

    Args:
        network: What is connected to what.
    """

    def __init__(self, network: Network) -> None:
        self._network = network
        self._first = np.array([c[0] - 1 for c in network.coils_of_strings()])
        self._last = np.append(self._first[1:], network.coils) - 1
        self._string = np.repeat(np.arange(len(network.strings)), network.strings)
        fixed = {**network.open_resistances(), **dict.fromkeys(network.shorted_coils, 0.0)}
        self._fixed_coils = np.array([c - 1 for c in fixed], dtype=np.intp)
        self._fixed_values = np.array(list(fixed.values()))
        self._supply_resistance = np.array(network.supply_resistances())
        series = [r for r in (*network.supply_resistances(), network.string_resistance) if r > 0.0]
        self._least_series = min(series, default=np.inf)

    def coil_voltage(self, node_voltage: Array) -> Array:
        """Voltage across every coil [V] from that of the nodes on its supply side; a string's last coil ends at ground.

        Args:
            node_voltage: [V], shape (coils,).
        """
        after = np.empty_like(node_voltage)
        after[:-1] = node_voltage[1:]
        after[self._last] = 0.0
        return node_voltage - after

    def coil_current(self, string_current: Array) -> Array:
        """Current of every coil [A]: that of its string."""
        return string_current[self._string]

    def supply_drop(self, solution: Solution) -> Array:
        """Voltage over the series resistance of every source [V], shape (sources,)."""
        return self._supply_resistance * solution.source_current

    def violation(self, solution: Solution) -> str:
        """The law that a solution breaks, in a sentence with place and amount; empty if it keeps them all."""
        resistance = solution.resistance.copy()
        resistance[self._fixed_coils] = self._fixed_values
        # Rounding of a string's equations is relative to its largest conductance times the largest voltage.
        volts = float(np.abs(solution.source_voltage).max())
        least = np.minimum.reduceat(np.where(resistance > 0.0, resistance, np.inf), self._first)
        amperes = volts / np.minimum(least, self._least_series)
        voltage, current = self.coil_voltage(solution.node_voltage), self.coil_current(solution.string_current)
        heat = float(voltage @ current)
        return (
            self._ohm(resistance, voltage, current, volts + resistance * amperes[self._string])
            or self._loops(solution, volts, amperes)
            or self._sources(solution, amperes)
            or self._power(solution, heat, volts, amperes)
        )

    def _ohm(self, resistance: Array, voltage: Array, current: Array, scale: Array) -> str:
        excess = ~(np.abs(voltage - resistance * current) <= TOLERANCE * scale)  # NaN is an excess too
        if not excess.any():
            return ""
        coil = int(excess.argmax())
        return (
            f"{self._network.place(coil + 1)} breaks Ohm's law: {voltage[coil]:.9g} V across {resistance[coil]:.9g} "
            f"ohm at {current[coil]:.9g} A"
        )

    def _drops(self, solution: Solution) -> tuple[Array, Array]:
        """Voltage over the series resistance of every source and of every string [V]."""
        string_resistance = self._network.string_resistance + solution.contacts
        return self.supply_drop(solution), string_resistance * solution.string_current

    def _loops(self, solution: Solution, volts: float, amperes: Array) -> str:
        supply_drop, string_drop = self._drops(solution)
        rest = solution.source_voltage - supply_drop - string_drop - solution.node_voltage[self._first]
        string_resistance = self._network.string_resistance + solution.contacts
        scale = volts + self._supply_resistance * amperes.sum() + string_resistance * amperes
        excess = ~(np.abs(rest) <= TOLERANCE * scale)
        if not excess.any():
            return ""
        string = int(excess.argmax())
        return f"string {string + 1} breaks Kirchhoff's voltage law: {rest[string]:.9g} V are left over its loop"

    def _sources(self, solution: Solution, amperes: Array) -> str:
        strings = solution.string_current
        if self._network.supply == "common":
            strings, amperes = strings.sum(keepdims=True), amperes.sum(keepdims=True)
        rest = solution.source_current - strings
        excess = ~(np.abs(rest) <= TOLERANCE * amperes)
        if not excess.any():
            return ""
        source = int(excess.argmax())
        return f"source {source + 1} breaks Kirchhoff's current law: {rest[source]:.9g} A more than its strings take"

    def _power(self, solution: Solution, heat: float, volts: float, amperes: Array) -> str:
        supply_drop, string_drop = self._drops(solution)
        heat += float(supply_drop @ solution.source_current + string_drop @ solution.string_current)
        power = float(solution.source_voltage @ solution.source_current)
        if abs(power - heat) <= TOLERANCE * volts * float(amperes.sum()):
            return ""
        return f"the power balance does not close: {power:.9g} W from the sources, {heat:.9g} W of heat"
