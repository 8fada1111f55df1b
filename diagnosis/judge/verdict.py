"""The verdict: one word for a search, and why nothing can be told where nothing can."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from diagnosis.judge.agreement import times_louder, times_white
from diagnosis.judge.diagnosis import MOVED, Adequacy, Doubt, Finding, Moved, Searched, Standing, Verdict
from diagnosis.judge.doubts import (
    MEASURED,
    ODD,
    accuses,
    far_starts,
    faults,
    is_of_an_interval,
    is_physics,
    late_responses,
)
from diagnosis.judge.headline import noise_of
from diagnosis.report.display import listed, parameter_words
from diagnosis.search.search import Outcome

#: Structure beyond so many times its limit is more than the small errors that every model of a rig has.
EVIDENT = 1.2
#: Share of what recalibration leaves that a law without a name has to explain to be of the rig.
HALF = 0.5
#: A parameter that moved by more than this is no calibration: chance does that in one of 16,000.
STRAINED = 4.0
#: Parameters that are named in one sentence.
NAMED = 6
#: Why nothing is concluded from what is suggested.
_UNCONFIRMED = "what the training recordings suggest is not confirmed by readings that it was not fitted to"
_OF_ONE_RECORDING = (
    "what the training recordings suggest is a fault of one recording, and its other readings do not make it certain"
)
_COARSE = "time.macro_step is too long to tell what the training recordings suggest from an error of solving"

_ROWS = (
    "changes of recorded inputs, which stand in the row after them, explain what the training recordings suggest as "
    "well as any law does"
)


def verdict(
    outcome: Outcome,
    found: Sequence[Finding],
    adequacy: Adequacy,
    searched: Searched,
    moved: Sequence[Moved] = (),
    doubts: Sequence[Doubt] = (),
) -> Verdict:
    """One word for a search.

    Args:
        outcome: What the search found.
        found: Findings, accepted and suggested.
        adequacy: How right the accepted model is.
        searched: What was searched.
        moved: Parameters that the recalibration moved far.
        doubts: About the recordings.
    """
    accepted = [f for f in found if f.is_accepted]
    physics = [f for f in accepted if is_physics(f)]
    if physics:
        if any(f.standing is not Standing.UNNAMED for f in physics):
            return Verdict.MISSING_PHYSICS
        if not leaves_most(adequacy) and not _has_stopgap(accepted):
            return Verdict.UNNAMED_PHYSICS
    if faults(doubts) or (accepted and not is_stopgap(accepted)):
        return Verdict.MEASUREMENT_FAULT
    if why_open(outcome, found, adequacy, searched, doubts):
        return Verdict.CANNOT_TELL
    is_moved = any(abs(m.deviations) > MOVED for m in moved)
    is_needed = is_moved or adequacy.is_nominal_rejected or adequacy.day
    return Verdict.RECALIBRATED if is_needed else Verdict.CONSISTENT


def leaves_most(adequacy: Adequacy) -> bool:
    """Whether readings reject a model and more is left than was explained of what recalibration leaves.

    A law without a name that explains less than half is bent to something else, maybe of another part of the rig or of
    a sensor.
    """
    if not adequacy.is_rejected or adequacy.is_irregular:
        return False
    return 1.0 - adequacy.explained > HALF * (1.0 - adequacy.by_recalibration)


def is_stopgap(measured: Sequence[Finding]) -> bool:
    """Whether accepted laws of sensors and inputs only fill a gap of the model: none has a name of its own.

    An offset, a gain or a box in time brings a wrong model nearer to any readings. That alone accuses no sensor; nor
    does a law that a law of the rig may replace.
    """
    return not any(accuses(f) for f in measured)


def _has_stopgap(accepted: Sequence[Finding]) -> bool:
    """Whether laws of sensors or inputs that accuse nothing are accepted: beside laws of the rig without a name, all
    of them may describe one thing, of either."""
    return any(not is_physics(f) and not accuses(f) for f in accepted)


def why_open(
    outcome: Outcome,
    found: Sequence[Finding],
    adequacy: Adequacy,
    searched: Searched,
    doubts: Sequence[Doubt] = (),
    names: Sequence[str] = (),
) -> tuple[str, ...]:
    """Why it cannot be told whether something is missing, or what; empty if the model agrees.

    It is asked where no physics is accepted, or none that has a name and could not as well be of a sensor.

    Args:
        outcome: What the search found.
        found: Findings, accepted and suggested.
        adequacy: How right the accepted model is.
        searched: What was searched.
        doubts: About the recordings.
        names: Of the parameters of the model, in their order; without them parameters are counted only.
    """
    if far_starts(doubts):
        return (_start(far_starts(doubts)[0]),)
    if late := late_responses(doubts):
        return (f"{late[0].recording}: {late[0].statement.rstrip('.')}",)
    reasons = _open_ones(found)
    reasons += [d.statement for d in doubts if d.kind == "still"]
    if any(f.is_accepted and is_physics(f) for f in found) and leaves_most(adequacy):
        reasons.append("what improves the prediction has no name and leaves most of the squared mismatch")
    if not searched.has_physics:
        reasons.append(
            "no law of physics was tried: " + "; ".join(searched.untried or ("the model offers no place for one",))
        )
    if suggested := [f for f in found if not f.is_accepted and (adequacy.is_open or not f.is_within_rows)]:
        reasons.append(_unaccepted(suggested))
    reasons += _rejections(adequacy, _unexplained(outcome, found, searched, adequacy))
    is_open, left = adequacy.is_open, outcome.base_structure
    noise = math.sqrt(times_white(adequacy.alike, (left.channels,))) * times_louder(adequacy.louder, (left.channels,))
    if not is_open and abs(left.z) / noise > EVIDENT * left.limit:
        reasons.append("residuals of the training recordings are alike for longer than noise is")
    if adequacy.is_recalibration_worse and (is_open or adequacy.needs_parameter_error):
        reasons.append("the recalibrated parameters predict worse than those of the scenario")
    strained = np.flatnonzero(np.abs(outcome.base.point.base / outcome.base.widths) > STRAINED).tolist()
    if len(strained):
        reasons.append(_strained([parameter_words(names[int(i)]) for i in strained] if names else [], len(strained)))
    if reasons and _ROWS not in reasons and any(f.is_within_rows for f in found):
        reasons.append(_ROWS)
    # Where something is open, one recording that stands out from all others is the first thing to look at.
    return (*(_apart(d) for d in doubts if d.kind == ODD and reasons), *reasons)


def _unaccepted(suggested: Sequence[Finding]) -> str:
    """Why nothing of what is suggested is accepted."""
    if all(f.is_coarse for f in suggested):
        return _COARSE
    if all(f.is_within_rows for f in suggested):
        return _ROWS
    return _OF_ONE_RECORDING if all(is_of_an_interval(f) for f in suggested) else _UNCONFIRMED


def _apart(doubt: Doubt) -> str:
    """That one recording stands out from the others, and what to look at."""
    return f"{doubt.recording} stands out: {doubt.statement}; {doubt.remedy}"


def evident(found: Sequence[Finding], adequacy: Adequacy, margin: float) -> tuple[Finding, ...]:
    """Findings without suggestions that noise gives which is alike from reading to reading.

    The search counts every reading as one of its own, and its noise as it is stated. Where no readings reject the
    model, and those of a suggestion's channels differ from their neighbours by less than the stated noise says, or all
    of them scatter by more, its gain counts for less.

    Args:
        found: Accepted and suggested.
        adequacy: How right the accepted model is.
        margin: What an effect must gain.
    """
    if adequacy.is_open:
        return tuple(found)

    def is_noise(finding: Finding) -> bool:
        louder = times_louder(adequacy.louder, finding.channels)
        times = times_white(adequacy.alike, finding.channels) * louder**2
        return not finding.is_accepted and times > 1.0 and finding.gain <= margin * times

    return tuple(f for f in found if not is_noise(f))


def _strained(names: Sequence[str], count: int) -> str:
    """That recalibration alone moved parameters far, and which; other laws in the model may leave them nearer."""
    those = "1 parameter" if count == 1 else f"{count} parameters"
    which = f": {listed(names, NAMED)}" if names else ""
    return f"recalibration alone, with no law added, moves {those} by more than {STRAINED:.0f} prior deviations{which}"


def _open_ones(found: Sequence[Finding]) -> list[str]:
    """Accepted laws that may be of the rig as well as of a sensor or an input."""
    accepted, reasons = [f for f in found if f.is_accepted], []
    if any(f.standing is Standing.UNNAMED and f.unit in MEASURED for f in accepted):
        is_part = any(f.unit not in MEASURED for f in accepted)
        what = "part of what improves the prediction" if is_part else "what improves the prediction"
        reasons.append(f"{what} is described by a law of a sensor or an input, but not identified")
    if any(f.is_of_either for f in accepted):
        reasons.append("what improves the prediction may be of the rig as well as of a sensor or an input")
    return reasons


def _unexplained(outcome: Outcome, found: Sequence[Finding], searched: Searched, adequacy: Adequacy) -> str:
    """What is known of the laws that were tried where readings reject the model; empty where one is suggested.

    Laws are fitted to the training: of what other readings alone show none was asked.
    """
    if not searched.has_physics or any(not f.is_accepted for f in found):
        return ""
    if adequacy.is_rejected and not adequacy.is_training_rejected:
        return ", and of the training readings, to which laws are fitted, no more is left than noise explains"
    if outcome.first is not None and outcome.first.best.terms:  # found by the noise of the sensors alone
        return ", and once its own error is counted no law that was tried explains more of what is left than chance may"
    return ", and no law that was tried explains what is left"


def _rejections(adequacy: Adequacy, unexplained: str) -> list[str]:
    """How the readings reject the model, if they do."""
    if not adequacy.is_open:
        return []
    which = "readings" if adequacy.is_rejected else "training readings"
    if adequacy.is_irregular:
        return [
            f"the {which} reject the model by {noise_of(adequacy)}, but what is left scatters from one reading to the "
            "next, as a larger noise or single wild readings do"
        ]
    if adequacy.by_solving:
        unexplained = (
            f"{unexplained}; but `time.macro_step` is so long that an error of solving may move a reading by "
            f"{adequacy.by_solving:.2g} times its noise, which may be what is left: shorten it first"
        )
    return [f"the {which} reject the model{unexplained}"]


def _start(doubt: Doubt) -> str:
    """Why nothing is concluded from a recording that begins elsewhere than it says."""
    return f"{doubt.recording} does not begin as it says; {doubt.subject}: {doubt.statement.rstrip('.')}"
