"""What each fault with begin and end says of itself, and how the search sees it at a place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.search.problem import Term, TermParameter

#: Intervals of fewer samples than this are wild readings, which Huber's function deals with.
FEWEST = 3
#: Time constants and offsets of a clock that are tried, each twice the one before.
LAGS = 10
#: Share of a recording beyond which a sensor is not slower, nor its clock off.
LONGEST_LAG = 0.1
#: Readings of a drift: of fewer it is an offset by another name.
FEWEST_OF_DRIFT = 8
#: Times that one sensor may be off in one way within one recording.
OCCASIONS = 2
#: End of the place of a second fault of one kind.
AGAIN = ", again"
#: Strength of a fault that is there or not.
WHOLLY = TermParameter(
    "share", "1", 0.0, 1.0, (1.0,), is_switch=True, meaning="factor 0 or 1: whether it holds one reading"
)
#: What the name of a fault says of one that has begin and end, and may have lasted for its whole recording.
FOR_A_WHILE = " for a while"
_INTERVAL = "box(t) = 1 from begin to end, else 0"


@dataclass(frozen=True)
class FaultLaw:
    """A kind of fault; see `diagnosis.models.protocol.Effect`.

    Args:
        identifier: Stable name.
        name: In plain words.
        law: Formula.
        strength: Name of its strength.
        confused_with: Identifiers that data often cannot tell from it, with what decides.
    """

    identifier: str
    name: str
    law: str
    strength: str
    confused_with: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_of_a_day(self) -> bool:
        """Always: a fault belongs to one recording."""
        return True

    @property
    def is_of_either(self) -> bool:
        """Never: a rig that is otherwise for a while shows it in its states."""
        return False


OFFSET = FaultLaw(
    "sensor_offset_in_interval",
    "sensor that was off for a while",
    f"reading = truth + offset * box(t); {_INTERVAL}",
    "offset",
    {
        "sensor_bias": "readings before and after the interval decide",
        "sensor_drift": "readings within the interval decide: a drift grows",
        "sensor_drift_in_interval": "readings within the interval decide: a drift grows",
    },
)
DRIFT = FaultLaw(
    "sensor_drift_in_interval",
    "sensor that drifted for a while",
    "reading = truth + offset * ramp(t); ramp(t) rises from 0 at begin to 1 at end, else 0",
    "offset",
    {
        "sensor_drift": "other recordings decide: a sensor that drifts in all of them is no fault of one",
        "sensor_offset_in_interval": "readings within the interval decide: an offset stays",
        "ambient_step": "a second sensor beside it decides",
    },
)
SLOWER = FaultLaw(
    "sensor_lag_in_interval",
    "sensor that was slower for a while",
    "lag_time * d(reading) = truth - reading from begin to end, else reading = truth",
    "lag_time",
    {
        "sensor_lag": "other recordings decide: a sensor that is slow in all of them is no fault of one",
        "sensor_clock_in_interval": "slow and fast courses decide: a clock moves both as much",
    },
)
LATE = FaultLaw(
    "sensor_clock_in_interval",
    "sensor whose clock was off for a while",
    "reading = truth(t - offset) from begin to end, else truth(t)",
    "offset",
    {
        "sensor_clock_offset": "other recordings decide: a clock that is off in all of them is no fault of one",
        "sensor_lag_in_interval": "slow and fast courses decide: a lag rounds fast ones",
    },
)
_GAIN_CONFUSED = {
    "sensor_gain": "readings before and after the interval decide",
    "sensor_offset_in_interval": "readings of other sizes within the interval decide",
}
SCALED = FaultLaw(
    "sensor_gain_in_interval",
    "sensor whose gain was off for a while",
    f"reading = truth * (1 + gain * box(t)); {_INTERVAL}",
    "gain",
    _GAIN_CONFUSED,
)
RISE = FaultLaw(
    "sensor_rise_in_interval",
    "sensor that showed another share of the rise for a while",
    f"reading = first + (truth - first) * (1 + gain * box(t)); {_INTERVAL}; first: first reading of the recording",
    "gain",
    _GAIN_CONFUSED,
)
STUCK = FaultLaw(
    "sensor_stuck_in_interval",
    "sensor that was stuck for a while",
    f"reading = truth + share * box(t) * (held - truth); {_INTERVAL}; held: mean of its readings there",
    "share",
    {"sensor_clipping": "other intervals in which the truth goes beyond the value that it held decide"},
)
INPUT = FaultLaw(
    "input_gain_in_interval",
    "input that was another than stated for a while",
    f"input = stated * (1 + gain * box(t)); {_INTERVAL}",
    "gain",
    {
        "draught": "a record of the input itself decides",
        "sensor_offset_in_interval": "another sensor of the same part decides",
    },
)
UNSTATED = FaultLaw(
    "unstated_input_in_interval",
    "input that acted for a while although it was stated as zero",
    f"input = stated + offset * box(t) where stated = 0; {_INTERVAL}",
    "offset",
    {
        "ambient_step": "a record of the input itself decides",
        "sensor_offset_in_interval": "another sensor of the same part decides",
    },
)
HELD = FaultLaw(
    "input_held_in_interval",
    "input that stayed where it was for a while",
    f"input = stated + share * box(t) * (held - stated); {_INTERVAL}; held: what is stated at its begin",
    "share",
    {
        "input_gain_in_interval": "a record of the input itself decides",
        "sensor_offset_in_interval": "another sensor of the same part decides",
    },
)
LEVEL = FaultLaw(
    "input_level_in_interval",
    "input that stood at another value for a while",
    f"input = stated + share * box(t) * (level - stated); {_INTERVAL}",
    "share",
    {
        "input_held_in_interval": "whether what is stated at its begin is that value decides",
        "input_gain_in_interval": "a record of the input itself decides",
        "sensor_offset_in_interval": "another sensor of the same part decides",
    },
)
PARAMETER = FaultLaw(
    "parameter_in_interval",
    "parameter of the rig that was another for a while",
    f"parameter = stated * (1 + share * box(t)); {_INTERVAL}",
    "share",
    {
        "input_gain_in_interval": "a record of the input itself decides",
        "sensor_offset_in_interval": "another sensor of the same part decides",
    },
)
RATE = FaultLaw(
    "rate_in_interval",
    "something that acted on the rig for a while",
    f"derivative = that of the model + rate * box(t); {_INTERVAL}",
    "rate",
    {
        "unstated_input_in_interval": "a record of the input itself decides",
        "sensor_drift_in_interval": "another sensor of the same part decides",
    },
)
#: What of the rig was another in one recording.
OF_THE_RIG = (PARAMETER, RATE)
#: Faults of inputs: what is stated was another, acted where nothing was stated, or stayed.
OF_INPUTS = (INPUT, UNSTATED, HELD, LEVEL)
#: Faults whose course a law of the rig may have as well: what an input does, what comes slowly, and what comes late.
AS_A_LAW = (*OF_INPUTS, *OF_THE_RIG, DRIFT, SLOWER, LATE)
#: Faults that may last for a whole recording: what they do there is no bias, and other recordings are without it.
LASTING = (DRIFT, SLOWER, LATE)
#: Faults that change when something is read, and not what.
OF_TIME = (SLOWER, LATE)
#: Strength of an input that stayed.
STAYED = TermParameter("share", "1", 0.0, 1.0, (1.0,), is_switch=True, meaning="factor 0 or 1: whether it stayed")
#: Strength of an input that stood at another value.
STOOD = replace(STAYED, meaning="factor 0 or 1: whether it stood there")
#: Values at which an input may have stood that are told apart: -2 log of the prior odds of one against all is the price
#: of the best of them.
LEVELS = 20
#: How far beyond what is stated it may have stood, as a share of the range of that.
BEYOND = 1.0
#: Stretches in which an input is stated as zero of which each may be wrong; of more the longest.
STRETCHES = 4
#: Share by which an input is off that is no finding: laboratory supplies hold what is set on them to about 1 %. What is
#: smaller than that of the largest value of an input is stated as zero.
ACCURACY = 0.01
#: Shares by which a parameter may have been another: an equation may not bear that it changes its sign.
LEAST_SHARE, MOST_SHARE = -0.95, 4.0
#: Largest rate that is tried, in rates at which a state moves by a fifth of its range in the recording.
MOST_RATES = 100.0
#: Share by which the gain of a sensor is off that is no finding.
SENSOR_ACCURACY = 0.01
#: Width of a channel's readings, as a share of the largest, below which a gain is an offset by another name.
WIDE = 0.5


def gain(
    meaning: str = "change of the input in the interval, as a share of what was stated", negligible: float = ACCURACY
) -> TermParameter:
    """Strength of a wrong input, or of a wrong gain of a sensor: nothing at -1, twice as much at 1."""
    return TermParameter("gain", "1", -1.0, 1.0, (0.02,), negligible=negligible, meaning=meaning)


def parameter_share() -> TermParameter:
    """Strength of a parameter that was another: from a twentieth of what is stated to five times it."""
    what = "change of the parameter in the interval, as a share of what is stated"
    return TermParameter("share", "1", LEAST_SHARE, MOST_SHARE, (0.02,), negligible=ACCURACY, meaning=what)


def added_rate(unit: str, usual: float) -> TermParameter:
    """Strength of what was added to a derivative.

    Args:
        unit: SI unit of the derivative.
        usual: Rate at which the state moves by a good part of its range in the recording.
    """
    most = MOST_RATES * usual
    what = "what was added to the derivative in the interval"
    return TermParameter("rate", unit, -most, most, (0.1 * usual,), negligible=ACCURACY * usual, meaning=what)


def level_of(unit: str, least: float, most: float) -> TermParameter:
    """The value at which an input stood.

    Args:
        unit: SI unit of the input.
        least: Smallest stated value.
        most: Largest stated value.
    """
    wide = BEYOND * (most - least)
    lower, upper = least - wide, most + wide
    if least >= 0.0:
        lower = max(lower, 0.0)
    what = "value at which the input stood"
    return TermParameter("level", unit, lower, upper, (0.5 * (least + most),), meaning=what, is_reading=True)


def level_term(label: str, level: TermParameter, span: Span, recording: int) -> Term:
    """An input that stood at another value, as the search sees it; see `fault_term`."""
    term = fault_term(LEVEL, label, STOOD, span, recording)
    price = term.price + 2.0 * float(np.log(LEVELS))
    return replace(term, parameters=(*term.parameters, level), price=price)


def lag_time(step: float, longest: float) -> TermParameter:
    """Time constant of a sensor that was slower: from half the time between two readings, by factors of two.

    Args:
        step: Time between two readings [s].
        longest: Longest time constant [s].
    """
    starts = tuple(0.5 * step * 2.0**n for n in range(LAGS) if 0.5 * step * 2.0**n < longest) or (0.5 * step,)
    what = "time constant of the sensor in the interval"
    return TermParameter("lag_time", "s", 0.0, max(longest, step), starts, negligible=0.1 * step, meaning=what)


def clock_offset(step: float, longest: float) -> TermParameter:
    """Offset of a sensor's clock, either way: from half the time between two readings, by factors of two.

    Args:
        step: Time between two readings [s].
        longest: Longest offset [s].
    """
    lags = lag_time(step, longest).starts
    what = "how late the readings of the interval are"
    most = max(longest, step)
    starts = (*lags, *(-s for s in lags))
    return TermParameter("offset", "s", -most, most, starts, negligible=0.1 * step, meaning=what)


def sensor_gain(of: str = "the reading") -> TermParameter:
    """Strength of a wrong gain of a sensor, of its reading or of the departure from its first one."""
    return gain(f"change of the gain in the interval, as a share of {of}", SENSOR_ACCURACY)


def added(unit: str, largest: float) -> TermParameter:
    """Strength of an input that acts while it is stated as zero: no more than its largest value elsewhere.

    Args:
        unit: SI unit of the input.
        largest: Largest stated value, without its sign.
    """
    return TermParameter(
        "offset",
        unit,
        -largest,
        largest,
        (0.02 * largest,),
        negligible=ACCURACY * largest,
        meaning="the input in the interval, where it was stated as zero",
    )


def is_zero(values: Array, size: Array | None = None) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Where an input is stated as zero, same shape; all false where it is never anything else.

    Args:
        values: Over time along the first axis.
        size: Largest value without its sign, where `values` are a part of the course.
    """
    largest = np.abs(values).max(axis=0, keepdims=True) if size is None else size
    return np.asarray(np.abs(values) < ACCURACY * largest)


def zero_stretches(edges: Array, zero: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> list[tuple[float, float]]:
    """Stretches in which an input is stated as zero [s], the longest `STRETCHES` of them, in order of time.

    Args:
        edges: Between pieces of the recording [s], shape (pieces + 1,), rising.
        zero: Whether the input is zero in a piece, shape (pieces,).
    """
    change = np.diff(np.concatenate([[False], zero, [False]]).astype(int))
    found = zip(edges[np.flatnonzero(change > 0)].tolist(), edges[np.flatnonzero(change < 0)].tolist())
    longest = sorted(found, key=lambda s: s[0] - s[1])[:STRETCHES]
    return sorted(s for s in longest if s[0] < s[1])


def is_one_of(identifier: str, laws: Sequence[FaultLaw]) -> bool:
    """Whether an identifier is that of one of some faults."""
    return any(law.identifier == identifier for law in laws)


@dataclass(frozen=True)
class Span:
    """When a fault may be.

    Args:
        begin: First instant [s].
        end: Last instant [s].
        instants: Distinct samples, of which any may be the first and the last that is wrong.
    """

    begin: float
    end: float
    instants: int

    @property
    def price(self) -> float:
        """-2 log of the prior odds of one interval against all, by which the best of them is compared with laws.

        Bonferroni's inequality: the best of N gains exceeds 2 log(N) + x no more often than N times as often as one
        exceeds that, which for one degree of freedom is less often than one alone exceeds x.
        """
        count = max(self.instants, 2)
        return 2.0 * float(np.log(0.5 * count * (count - 1)))


def occasion(label: str, titles: Sequence[str], number: int) -> str:
    """A place with its recording, where there are several: by its title, or by its number where titles are alike."""
    if len(titles) == 1:
        return label
    named = titles[number] if len(set(titles)) == len(titles) else f"recording {number + 1}"
    return f"{label} ({named})"


def unstated_terms(
    label: str, strength: TermParameter, stretches: Sequence[tuple[float, float]], span: Span, recording: int
) -> list[Term]:
    """An input that acts while it is stated as zero, as the search sees it: one term for each such stretch.

    Args:
        label: Its place.
        strength: Its first parameter.
        stretches: See `zero_stretches`.
        span: When a fault may be; its instants are the price of each stretch too.
        recording: Number of the recording.
    """
    found = []
    for begin, end in stretches:
        own = label if len(stretches) == 1 else f"{label}, stated as zero from {begin:.6g} to {end:.6g} s"
        found.append(fault_term(UNSTATED, own, strength, Span(begin, end, span.instants), recording))
    return found


def fault_term(law: FaultLaw, label: str, strength: TermParameter, span: Span, recording: int) -> Term:
    """A fault as the search sees it.

    Args:
        law: Its kind.
        label: Its place.
        strength: Its first parameter.
        span: When it may be.
        recording: Number of the recording that it belongs to.
    """
    edges = tuple(
        TermParameter(n, "s", span.begin, span.end, (), is_instant=True, meaning=f"{n} of the interval")
        for n in ("begin", "end")
    )
    return Term(
        law.identifier, label, "measurement", (strength, *edges), law=law.law, recording=recording, price=span.price
    )
