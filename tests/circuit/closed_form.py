"""Closed form of the network: the oracle of the circuit tests, from its description and not its netlist."""

from __future__ import annotations

import numpy as np

from circuit.netlist import Network


def string_currents(network: Network, voltage: np.ndarray, resistance: np.ndarray) -> np.ndarray:
    """Current of every string [A]: series resistances add, parallel conductances add, one divider at each supply."""
    coil = resistance.copy()
    coil[[c - 1 for c in network.shorted_coils]] = 0.0
    for number, value in network.open_resistances().items():
        coil[number - 1] = value
    string = np.array([network.string_resistance + coil[[c - 1 for c in m]].sum() for m in network.coils_of_strings()])
    if network.supply == "per_string":
        return voltage / (string + network.supply_resistance)
    terminal = voltage / (1 + network.supply_resistance * (1 / string).sum())
    return terminal / string
