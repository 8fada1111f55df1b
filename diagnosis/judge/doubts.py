"""What doubts about recordings mean for a diagnosis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from diagnosis.faults.law import AGAIN, OF_INPUTS, OF_THE_RIG, is_one_of
from diagnosis.judge.diagnosis import ChannelFit, Doubt, Finding, Standing

#: Units of findings that are no physics of the rig.
MEASURED = ("measurement", "input")
#: Sensors and inputs of one recording that are hardly at fault at the same time without a common cause, and faults of
#: one sensor in one recording that are pieces of one course; suggested ones count.
MANY = 3
#: End of the identifiers of faults with begin and end.
_IN_INTERVAL = "_in_interval"
_HARDLY = (
    "so many sensors and inputs are hardly at fault at once: look at the programme, the columns and the clock of this "
    "recording first"
)
#: Share of the shorter of two faults of one sensor in which both act, from which they are pieces of one course:
#: two that follow each other touch by the error of their ends.
OVERLAP = 0.5
_PIECES = (
    "so many faults of it, or several at the same time, are pieces of one course, which it took or what it measures: "
    "when it was otherwise is not known, and a law or a number that is of this recording alone may look alike"
)
#: Kind of doubt to what has to be done about it before physics can be told; all others are faults.
_FIRST = {"start": "the start has to be stated", "dead time": "the times have to be checked"}
_CLEARED = "the fault has to be cleared"
#: Begin of the reason why a finding is suggested that waits for such a doubt.
_WAITS = "first"
#: Kinds of doubts that are about a stretch of one sensor or input and not about the whole recording.
OF_A_STRETCH = ("sensor", "input", "range")
#: Chi-square per reading of every channel up to which a model meets a recording: its clock is not another one then.
MET = 1.5
#: Kind of doubt about a recording that the scenario misses while it meets the others, and kinds about its times.
ODD, OF_TIMES = "odd one out", ("clock", "dead time")
#: Kinds of doubts that a model which meets the recording in the end takes away.
_OF_FIT = (*OF_TIMES, ODD)


def is_of_another_experiment(doubt: Doubt) -> bool:
    """Whether a doubt says that recording and scenario are not of the same experiment: nothing is searched then."""
    return doubt.is_serious and doubt.kind not in OF_A_STRETCH


def of_another_experiment(doubts: Sequence[Doubt]) -> list[Doubt]:
    """Doubts by which recordings and scenario are not of the same experiment."""
    return [d for d in doubts if is_of_another_experiment(d)]


def without_consequences(doubts: Sequence[Doubt]) -> list[Doubt]:
    """Doubts without those that a serious one about the same recording explains.

    A sensor that stands still and catches up moves when no programme does: where a serious fault of a sensor was seen
    in a recording, that its readings change beside the programme says nothing more. Nor does the clock by which
    readings follow a simulation best that explains next to nothing of them.

    Args:
        doubts: About all recordings.
    """
    faulty = {d.recording for d in faults(doubts)}
    apart = {d.recording for d in doubts if d.is_serious and d.kind == ODD}
    return [
        d
        for d in doubts
        if not (d.kind == "programme" and d.recording in faulty)
        and not (d.kind in OF_TIMES and not d.is_serious and d.recording in apart)
    ]


def is_physics(finding: Finding) -> bool:
    """Whether a finding is of the rig, and no law of its class of a sensor or an input."""
    return finding.unit not in MEASURED and not finding.is_of_either


def accuses(finding: Finding) -> bool:
    """Whether a finding, of a sensor or an input, blames it: it has a name, and no law of the rig does the same."""
    return finding.standing is not Standing.UNNAMED and not finding.is_of_either


def is_of_an_interval(finding: Finding) -> bool:
    """Whether a finding is a fault with begin and end, of one recording alone."""
    return finding.effect.endswith(_IN_INTERVAL)


def faults(doubts: Sequence[Doubt]) -> list[Doubt]:
    """Serious doubts about a stretch of a sensor or of an input, or about the range of a sensor."""
    return [d for d in doubts if d.is_serious and d.kind in OF_A_STRETCH]


def far_starts(doubts: Sequence[Doubt]) -> list[Doubt]:
    """Doubts about recordings that begin far from where they are said to begin."""
    return [d for d in doubts if d.kind == "start" and d.is_far]


def late_responses(doubts: Sequence[Doubt]) -> list[Doubt]:
    """Doubts about recordings whose response comes later than their programme, by a clock or by the rig itself."""
    return [d for d in doubts if d.kind == "dead time" and d.is_far]


def doubted(findings: Sequence[Finding], doubts: Sequence[Doubt]) -> tuple[Finding, ...]:
    """Findings, some as suggestions: physics beside a fault or start that no finding explains, too many faults at once.

    A rig that begins elsewhere than its recording says answers with its own time constants, as missing physics does,
    and as a sensor does that is off at first; a clock that is late looks like a lag.

    Args:
        findings: Of a search.
        doubts: About its recordings.
    """
    told = _one_cause(findings)
    doubts = [d for d in doubts if d.kind != "range"]  # nothing waits for it: such readings are left out
    accepted = [f for f in told if f.is_accepted and f.unit in MEASURED]
    open_ones = (*faults(doubts), *far_starts(doubts), *late_responses(doubts))
    left = [d for d in open_ones if not any(is_explained(d, f) for f in accepted)]
    if not left:
        return told
    what = _FIRST.get(left[0].kind, _CLEARED)
    why = f"{_WAITS} {what}: {left[0].recording}, {left[0].subject}: {left[0].statement.rstrip('.')}"
    waiting = [f for f in told if f.is_accepted and (f.unit not in MEASURED or _is_at_start(f, left))]
    return tuple(_suggested(f, why) if f in waiting else f for f in told)


def _is_at_start(finding: Finding, doubts: Sequence[Doubt]) -> bool:
    """Whether it is a fault of a sensor from the begin of a recording of which the start is in doubt."""
    return is_of_an_interval(finding) and any(
        d.kind == "start"
        and d.recording == finding.recording
        and _is_of_channel(d, finding)
        and any(begin <= d.end for begin, _ in finding.intervals)
        for d in doubts
    )


def without_explained_starts(doubts: Sequence[Doubt], findings: Sequence[Finding]) -> tuple[Doubt, ...]:
    """Doubts without starts that an accepted law of their sensor explains: there is nothing to state then."""
    sensors = [f for f in findings if f.is_accepted and f.unit in MEASURED]
    return tuple(d for d in doubts if d.kind != "start" or not any(is_explained(d, f) for f in sensors))


def without_what_fits(
    doubts: Sequence[Doubt], fits: Sequence[ChannelFit], findings: Sequence[Finding]
) -> tuple[Doubt, ...]:
    """Doubts without those about times, and that a recording stands out, where the final model meets it within noise.

    The check compares with the scenario as it is, or with numbers that the other recordings determine: numbers that are
    off turn the phase of what swings, as a clock does, and what the others do not determine shows in one of them alone.
    Where a finding acts, it may be what comes late or stands out.

    Args:
        doubts: About all recordings.
        fits: How well every channel of every recording is met.
        findings: Of the search.
    """
    accepted = [f for f in findings if f.is_accepted]
    acting = {r for r in (f.recording for f in fits) if any(_acts_in(r, f) for f in accepted)}
    missed = {f.recording for f in fits if not f.chi_square["after"] <= MET}
    met = {f.recording for f in fits} - missed - acting
    return tuple(d for d in doubts if d.is_serious or d.is_far or d.kind not in _OF_FIT or d.recording not in met)


def _acts_in(recording: str, finding: Finding) -> bool:
    """Whether a finding does anything in a recording: a fault with begin and end does in its own alone."""
    return not is_of_an_interval(finding) or finding.recording == recording


def is_explained(doubt: Doubt, finding: Finding) -> bool:
    """Whether a finding is what a doubt is about: the same channel and, of a fault of a stretch, the same recording.

    A start is not explained by a sensor that is off for a while only: what is stated wrongly does the same.
    """
    if is_of_an_interval(finding) and (doubt.kind == "start" or finding.recording not in ("", doubt.recording)):
        return False
    return _is_of_channel(doubt, finding)


def _is_of_channel(doubt: Doubt, finding: Finding) -> bool:
    return any(c == doubt.subject or c.startswith(f"{doubt.subject} (") for c in finding.channels)


def waits(finding: Finding) -> bool:
    """Whether a finding is not accepted because a doubt about a recording has to be cleared first."""
    return any(d.startswith(f"{_WAITS} {what}:") for d in finding.doubts for what in (*_FIRST.values(), _CLEARED))


def _one_cause(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """Findings, faults of many sensors and inputs of one recording as suggestions: one cause is more probable.

    Suggested ones count: a pump that ran dry was a balance and a heater that were off, and a pressure that was so too.
    So are many of one sensor, and those that act at the same time: ramps and steps describe any course, whatever it
    comes from. Of an input they are told as another course that it had.
    """
    places: dict[str, set[str]] = {}
    for finding in filter(is_of_an_interval, findings):
        places.setdefault(finding.recording, set()).add(finding.place.removesuffix(AGAIN))
    many = {recording for recording, own in places.items() if len(own) >= MANY}
    told = [
        _suggested(f, _HARDLY) if f.is_accepted and is_of_an_interval(f) and f.recording in many else f
        for f in findings
    ]
    of_each: dict[tuple[str, str], list[Finding]] = {}
    for finding in (f for f in told if is_of_an_interval(f) and not is_one_of(f.effect, (*OF_INPUTS, *OF_THE_RIG))):
        of_each.setdefault((finding.recording, finding.place.removesuffix(AGAIN)), []).append(finding)
    pieces = [f for own in of_each.values() for f in own if f.is_accepted and _is_piece(f, own)]
    return tuple(_suggested(f, _PIECES) if any(f is p for p in pieces) else f for f in told)


def _is_piece(finding: Finding, own: Sequence[Finding]) -> bool:
    """Whether an accepted fault is one of many of its sensor, or acts at the same time as another one."""
    return len(own) >= MANY or any(_are_together(finding, f) for f in own if f is not finding and f.is_accepted)


def _are_together(one: Finding, other: Finding) -> bool:
    """Whether two faults act at the same time."""
    lengths = [sum(end - begin for begin, end in f.intervals) for f in (one, other)]
    both = sum(max(0.0, min(b, d) - max(a, c)) for a, b in one.intervals for c, d in other.intervals)
    return both > OVERLAP * min(lengths)


def _suggested(finding: Finding, why: str) -> Finding:
    return replace(finding, is_accepted=False, doubts=(why, *finding.doubts))
