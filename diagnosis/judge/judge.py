"""Findings and verdict of a search."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cosim.unit import Array
from diagnosis.judge.diagnosis import Alternative, Estimate, Finding, Verdict
from diagnosis.judge.events import event_of, local_estimates, since
from diagnosis.search.fit import Fit
from diagnosis.search.posterior import HUBER, cost
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Explanation, Outcome
from diagnosis.simulator.models import DiagnosisModel

#: Half width of a 95 % interval in standard deviations.
NORMAL_95 = 1.959963984540054
#: Explanations whose -2 log posterior is within this of the best cannot be told from it (odds of 20 to 1).
UNSEPARATED = 6.0
#: Probability beyond which another explanation is open.
OPEN = 0.05
#: Structure beyond so many times its limit is more than the small errors that every model of a rig has.
EVIDENT = 1.2
#: Structure beyond so many times its limit, and a share of the misfit beyond this, make a name doubtful.
DOUBTFUL, UNEXPLAINED = 1.5, 0.03
#: Share of its range within which a parameter lies at its bound (bounds hold exactly; this is rounding).
AT_BOUND = 1e-12
#: A parameter that moved by more prior deviations than this is told.
MOVED = 2.0
#: Fall of -2 log posterior per parameter by which a recalibration counts as needed.
NEEDED = 4.0


def verdict(outcome: Outcome, nominal_cost: float) -> Verdict:
    """One word for a search.

    Args:
        outcome: What the search found.
        nominal_cost: -2 log posterior of the model as it was.
    """
    terms = outcome.best.terms
    if not terms:
        if abs(outcome.base_structure.z) > EVIDENT * outcome.base_structure.limit:
            return Verdict.CANNOT_TELL
        moved = int(np.sum(np.abs(outcome.base.point.base) > MOVED))
        fell = nominal_cost - outcome.base.cost
        return Verdict.RECALIBRATED if moved or fell > NEEDED * len(outcome.base.point.base) else Verdict.CONSISTENT
    if all(t.unit == "measurement" for t in terms) and is_trusted(outcome):
        return Verdict.MEASUREMENT_FAULT
    if not is_trusted(outcome) or any(not t.is_named or is_limiting_case(outcome.best.fit, t) for t in terms):
        return Verdict.UNNAMED_PHYSICS
    return Verdict.MISSING_PHYSICS


def is_trusted(outcome: Outcome) -> bool:
    """Whether the effects found may be called by their names: no name is forced on what still shows structure.

    A name stands where noise is left, or so small a share of the misfit that errors of the model itself explain it.
    """
    if abs(outcome.left.z) <= DOUBTFUL * outcome.left.limit:
        return True
    used = np.count_nonzero(outcome.base.residuals)
    before = cost(outcome.base.residuals, np.zeros(0)) - used
    after = cost(outcome.best.fit.residuals, np.zeros(0)) - used
    return bool(after < UNEXPLAINED * before)


def is_limiting_case(fit: Fit, term: Term) -> bool:
    """Whether a law is found at a bound of what shapes it, where it is another law than its name says.

    A stiffness at the far end of what a wire can reach is a constant force. Instants may lie anywhere, a strength at
    its bound is only strong, and a bound of 0 leaves away a part of a law.
    """
    values = fit.point.terms[term]
    shaped = [(p, v) for p, v in zip(term.parameters[1:], values[1:]) if not p.is_instant]
    bounds = [(v, b, p.upper - p.lower) for p, v in shaped for b in (p.lower, p.upper) if b != 0.0]
    return any(abs(v - b) <= AT_BOUND * width for v, b, width in bounds)


def probabilities(rivals: tuple[Explanation, ...]) -> Array:
    """Posterior probabilities of explanations with equally many terms, by `Explanation.demerit`."""
    costs = np.array([e.demerit for e in rivals])
    weights = np.exp(-0.5 * (costs - costs.min()))
    return np.asarray(weights / weights.sum())


def bends_into(rival: Explanation, best: Explanation) -> bool:
    """Whether a rival is a law without a name and with a free shape where the best has names: it can bend into those.

    That it then explains as much is no ambiguity, and no experiment would part the two.
    """
    return all(t.is_named for t in best.terms) and not all(t.is_named for t in rival.terms)


def findings(model: DiagnosisModel, outcome: Outcome) -> tuple[Finding, ...]:
    """Effects of the accepted explanation, the largest gain first."""
    best = outcome.best
    ordered = sorted(best.terms, key=lambda t: -best.gains.get(t, 0.0))
    return tuple(_finding(model, outcome, term) for term in ordered)


def _finding(model: DiagnosisModel, outcome: Outcome, term: Term) -> Finding:
    candidate, place = model.where(term)
    fit = outcome.best.fit
    alternatives, probability = _alternatives(outcome, term)
    own = max((a.gain for a in alternatives if a.effect == term.identifier), default=0.0)
    bends = {t.identifier for e in outcome.rivals if bends_into(e, outcome.best) for t in e.terms if not t.is_named}
    near = [a for a in alternatives if a.probability > OPEN or (a.gain > own - UNSEPARATED and a.effect not in bends)]
    effect = model.residuals([fit.point.without(term)])[0] - fit.residuals
    doubt, event = _doubt(outcome), event_of(term, fit.point.terms[term], model)
    when = since(term, fit, model, doubt)
    found = estimates(fit, term, doubt, model.unseen(term))
    return Finding(
        unit=term.unit,
        place=place.label,
        elements=_elements(model, term),
        intervals=_intervals(model, effect) if event is None else ((event.seconds, event.end),),
        channels=_channels(model, effect),
        effect=term.identifier,
        is_named=term.is_named and is_trusted(outcome) and not is_limiting_case(fit, term),
        statement=f"{candidate.name}, {place.label}" + (f", {when}" if when else ""),
        law=candidate.law,
        parameters=local_estimates(found, term, fit, model, doubt),
        gain=outcome.best.gains.get(term, 0.0),
        probability=probability,
        ambiguous_with=tuple(sorted({a.effect for a in near if a.effect != term.identifier})),
        alternatives=tuple(alternatives[:8]),
        confused_with=dict(candidate.confused_with),
    )


def _alternatives(outcome: Outcome, term: Term) -> tuple[list[Alternative], float]:
    """Explanations that have another term in the place of this one, and the probability of this one."""
    others = set(outcome.best.terms) - {term}
    rivals = tuple(e for e in outcome.rivals if others <= set(e.terms) and len(e.terms) == len(others) + 1)
    if not rivals:
        return [], 1.0
    chances = probabilities(rivals)
    worst = max(e.fit.cost for e in rivals)
    found, own = [], 0.0
    for explanation, chance in sorted(zip(rivals, chances), key=lambda pair: pair[0].fit.cost):
        other = next(t for t in explanation.terms if t not in others)
        gain = outcome.base.cost - explanation.fit.cost if not others else worst - explanation.fit.cost
        found.append(Alternative(other.identifier, other.place, float(gain), float(chance)))
        if other.identifier == term.identifier:
            own += float(chance)
    return found, own


def _doubt(outcome: Outcome) -> float:
    """Factor on intervals where more than noise is left: errors of the model count as those of the sensors do."""
    residuals = outcome.best.fit.residuals
    used = max(int(np.count_nonzero(residuals)), 1)
    spread = np.sqrt(float(np.sum(np.clip(residuals, -HUBER, HUBER) ** 2)) / used)
    return max(1.0, float(spread), abs(outcome.left.z) / outcome.left.limit)


def estimates(fit: Fit, term: Term, doubt: float = 1.0, unseen: Sequence[float] = ()) -> tuple[Estimate, ...]:
    """Parameters of a term with 95 % intervals, cut at their bounds.

    Args:
        fit: The fit; the curvature of its posterior gives the intervals.
        term: One of its terms.
        doubt: Factor on the intervals.
        unseen: Relative deviation of each parameter that the recordings cannot show; empty: none.
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
        half = NORMAL_95 * float(np.hypot(seen, value * unseen[i] if unseen else 0.0))
        found.append(Estimate(p.name, p.unit, value, max(value - half, p.lower), min(value + half, p.upper)))
    return tuple(found)


def _elements(model: DiagnosisModel, term: Term) -> tuple[str, ...]:
    local = model.shows_in(term)
    if local is None:
        return (term.place,)
    return tuple(dict.fromkeys(model.layout.names[c].split(".")[0] for c in local[0])) or (term.place,)


def _intervals(model: DiagnosisModel, effect: Array) -> tuple[tuple[float, float], ...]:
    """Times in which nine tenths of the effect lie, as few pieces as there are gaps of a tenth of the recording."""
    layout = model.layout
    times = np.unique(layout.time)
    strength = np.bincount(np.searchsorted(times, layout.time), effect**2, minlength=len(times))
    order = np.argsort(-strength)
    share = np.cumsum(strength[order]) / max(float(strength.sum()), 1e-300)
    kept = np.sort(times[order[: int(np.searchsorted(share, 0.9)) + 1]])
    gap = 0.1 * (times[-1] - times[0])
    cuts = np.flatnonzero(np.diff(kept) > gap)
    begins = np.concatenate([[0], cuts + 1])
    ends = np.concatenate([cuts, [len(kept) - 1]])
    return tuple((float(kept[a]), float(kept[b])) for a, b in zip(begins, ends))


def _channels(model: DiagnosisModel, effect: Array) -> tuple[str, ...]:
    """Channels in which the effect is largest, down to a tenth of the largest, at most twelve."""
    strength = np.bincount(np.asarray(model.layout.channel, dtype=int), effect**2, minlength=len(model.layout.names))
    order = np.argsort(-strength)
    return tuple(model.layout.names[i] for i in order[:12] if strength[i] > 0.1 * strength[order[0]])


def recalibration(model: DiagnosisModel, fit: Fit) -> dict[str, float]:
    """Parameters that moved by more than `MOVED` prior deviations: factor where relative, change where not."""
    moved = {}
    for parameter, z in zip(model.parameters, fit.point.base):
        if abs(z) > MOVED:
            amount = parameter.deviation * float(z)
            moved[parameter.name] = float(np.exp(amount)) if parameter.is_relative else amount
    return moved


def nominal_cost(model: DiagnosisModel) -> float:
    """-2 log posterior of the model as the scenario has it."""
    base = np.zeros(len(model.parameters))
    return cost(model.residuals([Point(base)])[0], base)
