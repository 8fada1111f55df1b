"""The start: are the first readings those of the scenario's initial state?"""

from __future__ import annotations

import numpy as np
from scipy.stats import norm

from cosim.quantity import conversion
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.explain import LEVEL
from diagnosis.check.scale import first
from diagnosis.judge.diagnosis import Doubt


def start_doubts(compared: Compared) -> list[Doubt]:
    """Temperatures that begin elsewhere than simulated, beyond noise, stated uncertainty and bias.

    No such doubt is serious: a start that is stated wrongly can be stated rightly.
    """
    uncertain = compared.recording.uncertain.items()
    stated = [v.number * conversion(v.unit or "K", "K")[0] for key, v in uncertain if "temperature" in key]
    spread = max(stated, default=0.0)
    found = []
    members = [b for b in compared.channels.values() if b.channel.unit == "K" and b.simulated is not None]
    limit = float(norm.isf(LEVEL / (2.0 * max(len(members), 1))))
    for beside in members:
        off, deviation = _off(beside)
        total = float(np.sqrt(deviation**2 + spread**2))
        if abs(off) > limit * total + beside.channel.bias_bound:
            found.append(_doubt(compared, beside, off, abs(off) / total))
    return found


def _off(beside: Beside) -> tuple[float, float]:
    """First readings less the simulated ones, and the deviation of that [K]."""
    values, _ = first(beside)
    course = beside.at(beside.channel.times[: len(values)])
    return float(np.mean(values - course)), beside.floor / np.sqrt(len(values))


def _doubt(compared: Compared, beside: Beside, off: float, z: float) -> Doubt:
    values, time = first(beside)
    measured = float(np.mean(values))
    simulated = measured - off
    text = f"begins at {measured - 273.15:.4g} degC ({time:.4g} s), where {simulated - 273.15:.4g} degC is simulated"
    remedy = (
        "state this recording's initial temperature and surroundings under `overrides`, or how far they "
        "are unknown under `uncertain`"
    )
    end = float(beside.channel.times[len(values) - 1])
    return Doubt(compared.recording.title, beside.channel.name, "start", text, remedy, False, time, end, z)
