"""What the sizes of effects are compared with on a rig: its own h A, capacity, load, and what follows from them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm, Parameter
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, Array
from diagnosis.models.coil_network.runs import LONGEST_LAG, Series

#: Temperature above the surroundings at which the heat that a coil loses is a measure of heat [K].
EXCESS = 30.0


def rig_scales(base: Mapping[str, float | Array]) -> dict[str, float]:
    """Scales of `diagnosis.candidates.sizes.SCALES` for a rig: medians over its coils, not finite or 0 where unknown.

    Args:
        base: Parameters of the network, as a scenario states them; what is missing is the default.
    """

    def median(name: str) -> float:
        return float(np.median(np.asarray(base.get(name, COIL_FIELDS[name][0]))))

    def ratio(top: float, bottom: float) -> float:
        return top / bottom if bottom > 0.0 else 0.0

    conductance, capacity = median("conductance"), median("capacity")
    load, stiffness = median("load"), median("heating_d")
    return {
        "conductance": conductance,
        "capacity": capacity,
        "time": ratio(capacity, conductance),
        "rate": ratio(conductance * EXCESS, capacity),
        "heat": conductance * EXCESS,
        "resistance": median("reference_resistance"),
        "load": load,
        "per_load": ratio(1.0, load),
        "stiffness": stiffness,
        "compliance": ratio(1.0, stiffness),
        "stretch": ratio(load, stiffness),
    }


def believed(
    candidate: CandidateTerm, parameter: Parameter, own: Sequence[Series], scales: Mapping[str, float]
) -> tuple[float, str]:
    """Largest size that is believed of a parameter on this rig, and why.

    A stated bound of a lag stands above what is believed of sensors at large. (Bounds of clocks and of lags up to
    `LONGEST_LAG` are parameters of the model already; what goes beyond them is a fault, up to what is believed.)

    Args:
        candidate: The effect.
        parameter: One of its parameters.
        own: Series of the channels that it acts on.
        scales: Of the rig.
    """
    stated = max((s.channel.lag_bound for s in own), default=0.0)
    if candidate.identifier == "sensor_lag" and stated > LONGEST_LAG:
        return stated, "the recording states no more for this sensor"
    return parameter.limit(scales), parameter.plausible_reason
