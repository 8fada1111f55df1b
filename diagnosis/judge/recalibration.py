"""Numbers of the model that recalibration moved."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnosis.judge.diagnosis import MOVED, Moved
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Parameter
from diagnosis.search.shares import departures, titled

#: Share of the bound of a parameter from which it counts as being at it.
AT_BOUND = 0.99


def _fitted_value(parameter: Parameter, amount: float) -> float:
    """The number itself; NaN of an offset from 0 and of a factor over elements, which have no other value."""
    if parameter.nominal == 0.0 or parameter.unit in ("", "1"):
        return float("nan")
    return parameter.nominal * float(np.exp(amount)) if parameter.is_relative else parameter.nominal + amount


def recalibration(model: DiagnosisModel, fit: Fit, titles: Sequence[str] = ()) -> tuple[Moved, ...]:
    """Parameters that moved by more than `MOVED` prior deviations or to their bound, the farthest first.

    Args:
        model: Model of the training recordings.
        fit: Of it.
        titles: Of the recordings: parameters of one recording are called by its title.
    """
    known = {p.name: p for p in model.parameters}
    bounds = np.array([p.bounds for p in model.parameters]) * fit.widths
    at_bound = {p.name for p, z, most in zip(model.parameters, fit.point.base, bounds) if abs(z) >= AT_BOUND * most}
    found = []
    for name, (amount, z) in departures(model.parameters, fit.point.base).items():
        p = known[name]
        is_held = name in at_bound or (p.own is not None and p.own.number in at_bound)
        if p.is_within_row or not (abs(z) > MOVED or is_held):
            continue
        found.append(
            Moved(
                titled(p, titles),
                "1" if p.is_relative else p.unit,
                float(np.exp(amount)) if p.is_relative else amount,
                p.is_relative,
                float(z),
                _fitted_value(p, amount),
                p.unit,
                is_held,
            )
        )
    return tuple(sorted(found, key=lambda m: -abs(m.deviations)))
