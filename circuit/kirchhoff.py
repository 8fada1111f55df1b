"""Kirchhoff's and Ohm's laws, held against what ngspice returned: a lost alteration or a bad solution shows here.

The checks use quantities that ngspice solves separately: the current of each string and of each source are unknowns
of its equations (modified nodal analysis: Ho, Ruehli and Brennan, IEEE Trans. Circuits Syst. 22 (1975) 504-509), as
are the node voltages; the given resistances are ours, not those that ngspice holds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from circuit.netlist import OPEN_RESISTANCE, Network
from cosim.unit import Array

#: Relative tolerance of every law: worst measured 2e-12 (decision 0005), times fifty. Voltages count relative to the
#: greatest source, currents to what that source would drive through the least resistance of the string.
TOLERANCE = 1e-10


@dataclass(frozen=True)
class Solution:
    """One operating point.

    Args:
        source_voltage: Of every source [V], shape (sources,).
        resistance: Of every coil [ohm], as given, shape (coils,).
        node_voltage: Of the supply side of every coil, against ground [V], shape (coils,).
        string_current: [A], shape (strings,).
        source_current: Out of the positive terminal [A], shape (sources,).
    """

    source_voltage: Array
    resistance: Array
    node_voltage: Array
    string_current: Array
    source_current: Array


class Laws:
    """The laws of one network.

    Args:
        network: What is connected to what.
    """

    def __init__(self, network: Network) -> None:
        self._network = network
        coils = np.arange(1, network.coils + 1)
        self._first = np.array([c[0] - 1 for c in network.coils_of_strings()])
        self._last = np.append(self._first[1:], network.coils) - 1
        self._string = np.repeat(np.arange(len(network.strings)), network.strings)
        self._open = np.isin(coils, network.open_coils)
        self._shorted = np.isin(coils, network.shorted_coils)
        fixed = [r for r in (network.supply_resistance, network.string_resistance) if r > 0.0]
        self._least_fixed = min(fixed, default=np.inf)

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

    def violation(self, solution: Solution) -> str:
        """The law that a solution breaks, in a sentence with place and amount; empty if it keeps them all."""
        network, source_current = self._network, solution.source_current
        resistance = np.where(self._open, OPEN_RESISTANCE, solution.resistance)
        resistance[self._shorted] = 0.0
        least = np.minimum.reduceat(np.where(self._shorted, np.inf, resistance), self._first)
        volts = float(np.abs(solution.source_voltage).max())
        amperes = volts / np.minimum(least, self._least_fixed)
        voltage, current = self.coil_voltage(solution.node_voltage), self.coil_current(solution.string_current)

        ohm = voltage - resistance * current
        excess = np.abs(ohm) > TOLERANCE * (volts + resistance * amperes[self._string])
        if excess.any():
            coil = int(excess.argmax())
            return (
                f"{network.place(coil + 1)} breaks Ohm's law: {voltage[coil]:.9g} V across {resistance[coil]:.9g} ohm "
                f"at {current[coil]:.9g} A"
            )
        supply_drop = network.supply_resistance * source_current
        string_drop = network.string_resistance * solution.string_current
        loop = solution.source_voltage - supply_drop - string_drop - solution.node_voltage[self._first]
        drop_scale = network.supply_resistance * amperes.sum() + network.string_resistance * amperes
        excess = np.abs(loop) > TOLERANCE * (volts + drop_scale)
        if excess.any():
            string = int(excess.argmax())
            return f"string {string + 1} breaks Kirchhoff's voltage law: {loop[string]:.9g} V are left over its loop"
        common = network.supply == "common"
        into = solution.string_current.sum(keepdims=True) if common else solution.string_current
        rest = source_current - into
        if (np.abs(rest) > TOLERANCE * (amperes.sum() if common else amperes)).any():
            worst = int(np.abs(rest).argmax())
            return f"source {worst + 1} breaks Kirchhoff's current law: {rest[worst]:.9g} A more than its strings take"
        heat = voltage @ current + supply_drop @ source_current + string_drop @ solution.string_current
        power = solution.source_voltage @ source_current
        if abs(power - heat) > TOLERANCE * (volts + float(drop_scale.max())) * amperes.sum():
            return f"the power balance does not close: {power:.9g} W from the sources, {heat:.9g} W of heat"
        return ""
