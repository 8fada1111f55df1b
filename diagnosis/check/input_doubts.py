"""Doubts where a recorded input and the programme differ: which of them do the readings follow?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from cosim.components import CircuitComponent, CurrentLimitElement, SlowSourceElement, SourceResistanceElement
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared, compare
from diagnosis.check.clock_shift import MOST_CHANNELS, lag_grid, timed_channel
from diagnosis.check.inputs import MOST_SWITCHES, Course, InputComparison, compare_inputs, set_beside
from diagnosis.check.timing import critical, leading, percent, within
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Channel
from diagnosis.report.display import instant

#: Elements by which the voltage of a source is not that of its programme.
_OF_A_SOURCE = (SourceResistanceElement, CurrentLimitElement, SlowSourceElement)
#: Stretches that a sentence lists.
_LISTED = 4
#: Share of the variance of the readings from which on a course is not accused: what is left, a law that the model lacks
#: leaves too.
NEARLY_ALL = 0.9
#: Share of what one course leaves of the readings that the other must stay below: no model of a rig is right to more.
LESS = 0.8


def input_doubts(compared: Compared) -> list[Doubt]:
    """A doubt for each recorded input that is not as programmed, and for a supply's voltage that is not as simulated.

    A scenario's own programme that has nothing in common with the column and is not stated by the recording is an
    example and no statement about it: that the two differ is a doubt only if the readings follow the programme.
    """
    differing = [c for c in compare_inputs(compared) if c.kind != "equal"]
    found = [_voltage(compared, c) for c in voltages(compared) if c.kind != "equal"]
    if not differing:
        return found
    evidence, shares = _followed(compared)
    mine, theirs = (1.0 - s for s in shares)
    if max(mine, theirs) * LESS < min(mine, theirs) or (evidence > 0.0) != (mine > theirs):
        evidence = 0.0  # both leave alike: what parts them is how the model errs
    for one in differing:
        # A course of its own that explains nearly all does so where a law is missing, too.
        own = 0.0 if one.kind == "other" and evidence > 0.0 and shares[0] > NEARLY_ALL else evidence
        is_wrong = own > critical(2.0)
        if is_wrong or one.is_meant:
            found.append(_doubt(compared, one, own, shares, is_wrong))
    return found


def _followed(compared: Compared) -> tuple[float, tuple[float, float]]:
    """Evidence that the readings follow the programme and not the column; shares that both explain."""
    assert compared.base is not None
    programmed = compare(compared.base, replace(compared.recording, inputs=()))
    names = {b.channel.name: b for one in (programmed, compared) for b in leading(one)}
    pairs = [(compared.channels[n], programmed.channels[n]) for n in names]
    pairs = [(a, b) for a, b in pairs if a.simulated is not None and b.simulated is not None]
    if not pairs:
        return 0.0, (0.0, 0.0)
    mine = [within(compared, a, a) for a, _ in pairs]
    theirs = [within(compared, a, b) for a, b in pairs]
    found = sum(_likelihood(compared, a, a) - _likelihood(compared, a, b) for a, b in pairs[:MOST_CHANNELS])
    return found, (float(np.median([f.share for f in mine])), float(np.median([f.share for f in theirs])))


def _likelihood(compared: Compared, beside: Beside, course: Beside) -> float:
    """-2 log likelihood of a channel by a course, behind any lag of its sensor."""
    assert course.simulated is not None
    flat = float(np.ptp(course.simulated.values)) == 0.0
    still = np.zeros((1, 2))
    least = float(np.median(np.diff(beside.channel.times)))
    lags = lag_grid(least, max(0.1 * (compared.end - compared.begin), 2.0 * least))
    one = replace(beside, simulated=course.simulated)
    return float(timed_channel(one, still, lags[:1] if flat else lags).deviance.min())


def voltages(compared: Compared) -> list[InputComparison]:
    """Measured voltages of the supply beside those of the programme, as simulated.

    None where the source gives what the coils draw: numbers of these that are off move its voltage too.
    """
    if not _is_stiff(compared.scenario):
        return []
    found = []
    for beside in compared.channels.values():
        channel = beside.channel
        series = beside.simulated
        if (channel.target.kind, channel.target.quantity) != ("supply", "voltage") or series is None:
            continue
        time = compared.scenario.time
        margin = float(np.median(np.diff(channel.times))) + channel.offset_bound + channel.lag_bound
        margin += time.output_step.to("s") + time.macro_step.to("s")
        course = _held(channel)
        found.append(
            set_beside(
                compared.recording.title,
                channel.name,
                channel.unit,
                (course, partial(_interpolated, series.times, series.values)),
                (compared.begin, compared.end),
                margin,
                True,
                "programme",
            )
        )
    return found


def _is_stiff(scenario: Scenario) -> bool:
    """Whether each circuit has the voltage of its programme at its terminals, whatever is drawn."""
    circuits = [c for c in scenario.components.values() if isinstance(c, CircuitComponent)]
    return not any(
        c.supply_resistance.to("ohm") > 0.0 or any(isinstance(e, _OF_A_SOURCE) for e in c.elements) for c in circuits
    )


def _interpolated(times: Array, values: Array, at: Array) -> Array:
    """Simulated values at some times, shape (n,)."""
    return np.asarray(np.interp(at, times, values))


def _held(channel: Channel) -> Course:
    return lambda at: channel.values[np.maximum(np.searchsorted(channel.times, at, side="right") - 1, 0)]


def how(one: InputComparison) -> str:
    """How a recorded input differs, in words.

    >>> one = InputComparison("a", "drive.power", "W", "scaled", "recorded", True, (), 1.0, 2.0, 0.0, 0.0, ((), ()))
    >>> how(one)
    'is 2 times as high'
    """
    if one.kind == "equal":
        return "agrees"
    where = _where(one)
    if one.kind == "scaled":
        return f"is {one.factor:.3g} times as high"
    if one.kind == "offset":
        return f"is {abs(one.offset):.3g} {one.unit} {'higher' if one.offset > 0 else 'lower'}"
    if one.kind == "shifted":
        return f"switches {instant(abs(one.shift), 3)} s {'later' if one.shift > 0 else 'earlier'}"
    if one.kind == "off":
        return f"is 0 {where}"
    mine, theirs = one.switches
    met = sum(any(abs(s - t) < 0.01 * max(abs(s), 1.0) + 1.0 for t in mine) for s in theirs)
    if not theirs:
        return f"has another course {where}; the programme is constant"
    if not mine:  # a column that changes at every reading has no switches
        return f"has another course {where}; the programme switches {_count(theirs)}"
    return (
        f"has another course {where}; the recorded course switches {_count(mine)}, the programme {_count(theirs)}, "
        f"{met} of them together"
    )


def _count(switches: Sequence[float]) -> str:
    """How many times; no more than so many are kept of a course."""
    if len(switches) >= MOST_SWITCHES:
        return f"at least {MOST_SWITCHES} times"
    return "once" if len(switches) == 1 else f"{len(switches)} times"


def _where(one: InputComparison) -> str:
    listed = ", ".join(f"from {instant(a)} to {instant(b)} s" for a, b in one.stretches[:_LISTED])
    more = f" and in {len(one.stretches) - _LISTED} more stretches" if len(one.stretches) > _LISTED else ""
    return listed + more


def _doubt(
    compared: Compared, one: InputComparison, evidence: float, shares: tuple[float, float], is_wrong: bool
) -> Doubt:
    whose = "this recording's `overrides`" if one.is_stated else "the scenario"
    text = (
        f"the recorded input {how(one)}, compared with the programme of {whose}; they differ in "
        f"{percent(one.share)} of the time; the simulation uses the recorded one"
    )
    explain = (
        f"the programme explains {percent(shares[1])} of the variance of the readings, the recorded input "
        f"{percent(shares[0])}"
    )
    if is_wrong:
        text += f"; but the readings follow the programme: {explain}"
        remedy = f"is the column of `inputs.{one.name}` of another run or clock? Correct it, or leave it out"
    elif evidence < -critical(2.0):
        text += f"; the readings follow the recorded one: {explain}"
        remedy = "nothing, if the programme was not carried out as stated; else correct it"
    else:
        text += "; the readings do not tell which was applied"
        remedy = f"which of them was applied? Correct `inputs.{one.name}` or the programme"
    kind = "programme" if is_wrong and one.kind == "other" else "input"
    return _told(compared, one, kind, text, remedy, is_wrong, float(np.sqrt(abs(evidence))))


def _voltage(compared: Compared, one: InputComparison) -> Doubt:
    text = (
        f"the measured voltage of the supply {how(one)}, compared with the programme; they differ in "
        f"{percent(one.share)} of the time; the simulation uses the programme"
    )
    remedy = (
        "was the supply set as the programme says? If so look at limit and source resistance; else give the column "
        "under `inputs`"
    )
    return _told(compared, one, "input", text, remedy, False, 0.0)


def _told(
    compared: Compared, one: InputComparison, kind: str, text: str, remedy: str, is_serious: bool, z: float
) -> Doubt:
    begin = one.stretches[0][0] if one.stretches else compared.begin
    end = one.stretches[-1][1] if one.stretches else compared.end
    return Doubt(one.recording, one.name, kind, text, remedy, is_serious, begin, end, z, stretches=one.stretches)
