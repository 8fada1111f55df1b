"""The temperature that a shape asks for: hotter while the fabric bends too much, slowly cooler while it bends less.

Where the fabric is stiffer than it must be the temperature falls, until it bends as much as is wanted again.
"""

import numpy as np


def begin(strings):
    return {"temperature": np.full(strings, np.nan)}


def command(sample, memory, rise, lowest, highest):
    """Temperature [K]: an integral of what the curvature [1/m] is too much, with `rise` in K m/s."""
    before = np.where(np.isnan(memory["temperature"]), lowest, memory["temperature"])
    moved = before + rise * (sample.measured - sample.setpoint) * sample.step
    memory["temperature"] = np.clip(moved, lowest, highest)
    return memory["temperature"]
