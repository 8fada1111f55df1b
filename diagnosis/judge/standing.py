"""Whether a finding has a name, is one of a class, or has none.

A name needs odds of 20 to 1 over every rival, parameters that the readings identify (an interval inside the bounds,
away from the value at which the law vanishes), and a size that a real rig can have.
"""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.judge.diagnosis import Estimate, Standing
from diagnosis.report.user_units import IN_SI, Units
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Term, TermParameter

#: Share of its range within which a parameter lies at its bound (bounds hold exactly; this is rounding).
AT_BOUND = 1e-9
#: An interval that covers this share of what the bounds allow says nothing.
UNKNOWN_SHARE = 0.9


def standing_of(
    term: Term, doubts: Sequence[str], rivals: Sequence[str], is_trusted: bool, has_named_twin: bool = False
) -> Standing:
    """How far a finding may be called by its name.

    Args:
        term: The term.
        doubts: Why its parameters are not identified, or its size is not believed.
        rivals: Other effects that explain the readings with odds of more than 1 to 20.
        is_trusted: Whether what is left is small enough for any name.
        has_named_twin: Whether a law with a name predicts the same: then a law without one is of a class with it.
    """
    if not (term.is_named or has_named_twin) or doubts or not is_trusted:
        return Standing.UNNAMED
    return Standing.CLASS if rivals else Standing.NAMED


def unidentified(term: Term, fit: Fit, estimates: Sequence[Estimate], units: Units = IN_SI) -> tuple[str, ...]:
    """Why the readings do not identify the parameters of a term; empty if they do.

    Instants may lie anywhere; a switch is wholly there or not; a bound of 0 leaves away a part of a law.

    Args:
        term: The term.
        fit: With its values.
        estimates: Of its parameters, in order.
        units: In which quantities are shown.
    """
    found = []
    for number, (p, value, estimate) in enumerate(zip(term.parameters, fit.point.terms[term], estimates)):
        if p.is_instant or p.is_switch:
            continue
        width = p.upper - p.lower
        told = f"{p.name} = {units.estimate(estimate)}"
        at = [b for b in (p.lower, p.upper) if abs(value - b) <= AT_BOUND * width and _is_doubtful(p, b, number == 0)]
        if at:
            found.append(f"{told} lies at its bound, {units.like(estimate, at[0])}")
        elif number == 0 and estimate.lower <= 0.0 <= estimate.upper:
            found.append(f"{told}: the interval holds 0, where the law vanishes")
        elif estimate.upper - estimate.lower >= UNKNOWN_SHARE * width:
            found.append(f"{told}: the interval is as wide as the bounds")
    return tuple(found)


def _is_doubtful(parameter: TermParameter, bound: float, is_strength: bool) -> bool:
    """Whether a value at a bound is no value.

    Of a share, 1 is all of it (a clean break), and a rig can have that; of a change of a gain, -1 leaves nothing.
    """
    if bound == 0.0:
        return is_strength
    whole = -1.0 if parameter.lower == -1.0 else 1.0
    return not (is_strength and parameter.unit == "1" and bound == whole and parameter.plausible >= 1.0)
