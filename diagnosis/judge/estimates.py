"""Numbers of a law with their intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from diagnosis.judge.diagnosis import Estimate, Physical
from diagnosis.judge.events import between_samples, ends_by_likelihood, local_estimates
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import HUBER
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.search import Outcome

#: Half width of a 95 % interval in standard deviations.
NORMAL_95 = 1.959963984540054


def estimated(model: DiagnosisModel, fit: Fit, term: Term, doubt: float) -> tuple[Estimate, ...]:
    """Parameters of a term with intervals by all that is known of them: instants on the clock of their recording."""
    found = estimates(fit, term, doubt, model.scale_uncertainty(term))
    told = between_samples(local_estimates(found, term, fit, model, doubt), term, model)
    told = ends_by_likelihood(told, term, fit, model, doubt)
    simulated = model.simulated_interval(term)
    if simulated is None:
        return told
    return holding_both(told[0], _estimate(term.parameters[0], told[0].value, *simulated)), *told[1:]


def holding_both(one: Estimate, other: Estimate) -> Estimate:
    """The estimate with an interval that holds that of another too."""
    physical = one.physical
    if physical is not None and other.physical is not None:
        physical = replace(
            physical, lower=min(physical.lower, other.physical.lower), upper=max(physical.upper, other.physical.upper)
        )
    return replace(one, lower=min(one.lower, other.lower), upper=max(one.upper, other.upper), physical=physical)


def widening(outcome: Outcome) -> float:
    """Factor on intervals where more than noise is left: errors of the model count as those of the sensors do."""
    residuals = outcome.best.fit.residuals
    used = max(int(np.count_nonzero(residuals)), 1)
    spread = np.sqrt(float(np.sum(np.clip(residuals, -HUBER, HUBER) ** 2)) / used)
    return max(1.0, float(spread), abs(outcome.left.z) / outcome.left.limit)


def estimates(
    fit: Fit, term: Term, doubt: float = 1.0, scale_uncertainty: Sequence[float] = ()
) -> tuple[Estimate, ...]:
    """Parameters of a term with 95 % intervals, cut at their bounds.

    Args:
        fit: The fit; the curvature of its posterior gives the intervals.
        term: One of its terms.
        doubt: Factor on the intervals.
        scale_uncertainty: Relative deviation of each parameter that the recordings cannot show; empty: none.
    """
    covariance = fit.covariance
    begin = len(fit.point.base)
    for other, values in fit.point.terms.items():
        if other == term:
            break
        begin += len(values)
    found = []
    for i, (p, value) in enumerate(zip(term.parameters, fit.point.terms[term])):
        seen = doubt * float(np.sqrt(max(covariance[begin + i, begin + i], 0.0)))
        unseen = np.hypot(value * scale_uncertainty[i] if scale_uncertainty else 0.0, p.resolution)
        half = NORMAL_95 * float(np.hypot(seen, unseen))
        lower, upper = max(value - half, p.lower), min(value + half, p.upper)
        found.append(_estimate(p, value, lower, upper))
    return tuple(found)


def _estimate(parameter: TermParameter, value: float, lower: float, upper: float) -> Estimate:
    """A parameter with its interval, and the physical quantity that it stands for."""
    p, physical = parameter, None
    if p.physical is not None:
        factor, offset, unit = p.physical
        physical = Physical(unit, *(factor * v + offset for v in (value, lower, upper)))
    return Estimate(p.name, p.unit, value, lower, upper, p.meaning, physical, p.is_reading)
