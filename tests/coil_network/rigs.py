"""Small networks that several tests drive."""

import functools

import numpy as np

from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters

ROOM = 295.15
#: Two pulses, a partial reversal and a level that is held.
VOLTAGE = Programme(np.array([0.0, 1.0, 15.0, 22.0, 27.0, 31.0, 45.0]), np.array([0.0, 6.5, 0.0, 8.0, 3.0, 6.5, 0.0]))
STOP = 60.0
NETWORK = CoilNetworkLayout(12, (6, 6))
LOADED = CoilNetworkParameters({"load": 0.981})


@functools.cache
def full_network(layout, is_midpoint=True):
    """A network with the whole catalogue compiled in."""
    return CoilNetwork(layout, catalogue(), is_midpoint)


def network_inputs(step=0.1, voltage=VOLTAGE):
    return Drive(Programme.constant(ROOM), voltage).on_grid(grid(0.0, STOP, step, voltage.times))


def heater(power, stop, step=0.05, coils=1, temperature=None):
    """Inputs of lumped heaters under a constant power [W]; or of coils at given temperatures over time."""
    drive = Drive(
        Programme.constant(ROOM), power=Programme.constant(np.broadcast_to(power, coils)), temperature=temperature
    )
    return drive.on_grid(grid(0.0, stop, step))
