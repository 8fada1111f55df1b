"""What does not hold of a law although it fits: why it has no name, or what may shift its numbers."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.constancy import Constancy
from diagnosis.judge.diagnosis import Estimate
from diagnosis.models.protocol import Effect, Spot
from diagnosis.report.display import listed, parameter_words
from diagnosis.report.user_units import Units
from diagnosis.search.problem import Parameter, Term
from diagnosis.search.shares import titled

#: Why a law has no name beside one that has none.
BESIDE = "a law without a name acts at the same place: both may be parts of one law that is in no library"

#: What is not known of a law without a name beside another one elsewhere in the same FMU.
PARTS = "other laws without a name act elsewhere in the same FMU: together they may describe one law, at another place"

#: What is not known of a law without a name at an FMU that hides its states.
INSIDE = "the FMU hides its states: a law inside it, at another place, may show like this at its inputs and outputs"

#: What is not known of an input of which two faults at the same time are found.
ONE_COURSE = (
    "another finding is of the same input at the same time: both together describe a course of its own that it had, "
    "and their begins, ends and sizes are those of this description"
)


def elsewhere(accepted: Accepted) -> str:
    """Why a fault whose course a law may have has no name while readings that judge the whole model reject it.

    What it does in its interval a law of the rig does too, where the rig is in a state that the law needs, and readings
    of its own recording cannot tell them apart. A fault leaves nothing in other recordings, a law leaves as much there
    wherever that state comes again.
    """
    return f"the {accepted.basis} reject the model with it: a law that acts there may be what it stands for"


def limits(accepted: Accepted, term: Term) -> tuple[str, ...]:
    """What does not hold of an accepted law although it is accepted."""
    rising = accepted.gains[term].rising if term in accepted.gains else ()
    told = (f"with it more is left of {listed(rising, 3)}, by no more than chance",) if rising else ()
    return (*told, *_beyond(accepted))


def _beyond(accepted: Accepted) -> tuple[str, ...]:
    """Why an interval may miss the true number: it is that of the fit, and takes the rest of the model for granted."""
    if not accepted.agreement.is_rejected or accepted.agreement.is_irregular:
        return ()
    return (f"the {accepted.basis} reject the model with it, so what is still missing may shift its numbers",)


def inconstant(found: Constancy, strength: Estimate, basis: str, units: Units) -> str:
    """Why a law has no name that would have to have another strength in the readings that judge."""
    here, there = units.like(strength, found.fitted), units.like(strength, found.there)
    return (
        f"{strength.name} is {here} in the training recordings and would have to be {there} in the {basis}: "
        "a parameter of the rig is the same in all"
    )


def other_form(share: float) -> str:
    """Why a law has no name that leaves what other laws at its place explain."""
    return (
        f"other laws at the same place would explain {100.0 * share:.0f} % of what it leaves in training beyond the "
        "noise: what acts there has another form"
    )


def cancelled(other: tuple[Effect, Spot]) -> str:
    """Why a law has no name that another one mostly cancels."""
    law, place = other
    return (
        f"it and {law.name}, {place.label}, act against each other: both together change the readings far less than "
        "each alone, which one law of another form may do as well"
    )


def dragged(far: tuple[Parameter, float], titles: Sequence[str]) -> str:
    """Why a law has no name with which a parameter of the model has to be far from what is stated."""
    parameter, z = far
    side = "above" if z > 0.0 else "below"
    return (
        f"with it {parameter_words(titled(parameter, titles))} is {abs(z):.1f} prior deviations {side} the stated "
        "value, farther than recalibration alone brings it: another law that leaves it alone may be what acts"
    )


def much_left(accepted: Accepted) -> str:
    """Why a law has no name that leaves much of the squared mismatch, or makes it larger."""
    left, recalibrated = accepted.agreement, accepted.agreement_recalibrated
    share = 100.0 * left.excess / recalibrated.excess if recalibrated.excess > 0.0 else 100.0
    if share >= 100.5:  # it would round to more than all of it
        return (
            f"the squared mismatch in the {accepted.basis} is {share / 100.0:.2g} times what recalibration leaves of "
            "it, so no name is certain"
        )
    return (
        f"{share:.0f} % of the squared mismatch that recalibration leaves in the {accepted.basis} is still "
        "unexplained, so no name is certain"
    )
