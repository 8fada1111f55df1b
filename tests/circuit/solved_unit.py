"""A circuit unit, solved once."""

import numpy as np

from circuit.unit import CircuitUnit


def solved(network, voltage, resistance):
    """The unit at time 0; one resistance serves all coils."""
    unit = CircuitUnit("circuit", network)
    unit.set("supply_voltage", np.asarray(voltage, dtype=float))
    unit.set("resistance", np.broadcast_to(np.asarray(resistance, dtype=float), (network.coils,)))
    unit.initialise(0)
    return unit
