"""Whether a finding can be what its name says: sizes that a real rig can have, and quantities that tell its law."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

from diagnosis.candidates.candidate import NEEDS, CandidateTerm
from diagnosis.report.user_units import IN_SI, Units
from diagnosis.search.problem import Term, TermParameter

#: Share of the largest believed size within which a fit was held there.
HELD = 1e-6

#: Unit of a law to what was not recorded, and what it cannot be told from.
_ELSEWHERE = {
    "electrical": ("no electrical channel was recorded", "an electrical law cannot be told from heat"),
    "thermal": (
        "no temperature was recorded",
        "a thermal law cannot be told from one of the current or of the stiffness",
    ),
    "stiffness": (
        "neither stiffness nor extension was recorded",
        "a law of the stiffness cannot be told from any other",
    ),
    "mechanical": ("no extension or length was recorded", "a mechanical law cannot be told from one of the stiffness"),
}


def implausible(term: Term, values: Sequence[float], units: Units = IN_SI) -> list[str]:
    """Sentences on sizes that no real rig is believed to have; empty where all are believed.

    A finding with such a size stands in for something else: it is not to be called by its name.

    Args:
        term: The law at its place.
        values: Values of its parameters.
        units: In which quantities are shown.

    Raises:
        ValueError: The number of values is not that of the parameters.
    """
    found = []
    for parameter, value in zip(term.parameters, values, strict=True):
        most = parameter.plausible
        reason = f" ({parameter.plausible_reason})" if parameter.plausible_reason else ""
        factor, _, unit = parameter.physical or (1.0, 0.0, parameter.unit)
        if _is_held(parameter, value):
            scale = units.scale(factor * most, unit)
            at = f"{scale(factor * most):.3g} {scale.unit}".rstrip()
            found.append(f"{parameter.name} lies at {at}, the most that is believed{reason}")
        elif math.isfinite(most) and not abs(value) <= most:
            # Three digits, or as many as it takes to see that one is more than the other.
            scale = units.scale(factor * value, unit)
            size, bound = scale(factor * value), scale(factor * most)
            digits = next((d for d in range(3, 10) if f"{abs(size):.{d}g}" != f"{bound:.{d}g}"), 17)
            told = f" {scale.unit}".rstrip()
            found.append(
                f"{parameter.name} would have to be {size:.{digits}g}{told}; "
                f"{bound:.{digits}g}{told} is the most that is believed{reason}"
            )
    return found


def _is_held(parameter: TermParameter, value: float) -> bool:
    """Whether a fit was held at the largest size that is believed, though the readings ask for more.

    See `diagnosis.search.problem.limits_of`. Beyond a bound of the law itself no reading asks for more: a share of 1 is
    all of it.
    """
    bound = parameter.upper if value > 0.0 else -parameter.lower
    return bound > parameter.plausible and abs(abs(value) - parameter.plausible) <= HELD * parameter.plausible


def unidentified(candidate: CandidateTerm, measured: Collection[str]) -> str:
    """Why a law cannot be told from one of another unit by what was measured; empty where it can.

    Such a law may be a member of a class, but is not to be called by its name.

    Args:
        candidate: The law.
        measured: Quantities that were recorded, as `CoilNetworkModel.measured`; `supply_current` is a current.
    """
    needs = candidate.needs or ()
    if not needs or any(q == need or q.endswith(f"_{need}") for q in measured for need in needs):
        return ""
    if needs == NEEDS[candidate.unit]:
        missing, so = _ELSEWHERE[candidate.unit]
        return f"{missing}, so {so}"
    return f"none of {', '.join(needs)} was recorded, so {candidate.name} cannot be told from other laws"
