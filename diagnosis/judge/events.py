"""When something set in: in which recording, and when on its own clock."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnosis.judge.diagnosis import Estimate
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.report.user_units import IN_SI, Units
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Term
from diagnosis.search.switches import costs_at

#: 95 % point of chi-square with one degree of freedom.
RISE = 3.841458820694124
#: Nearest instant that is tried [s], and how much farther each one lies than the one before.
NEAREST, FARTHER = 0.01, 1.15


@dataclass(frozen=True)
class Event:
    """Something that sets in.

    Args:
        number: Of the recording in which it does, from 0, as they were given.
        recording: Its title.
        seconds: When, on its own clock [s].
        end: Its last instant [s].
        joint: The instant on the axis of all recordings that are fitted [s].
    """

    number: int
    recording: str
    seconds: float
    end: float
    joint: float

    @property
    def statement(self) -> str:
        """For people: `8.0 s of recording ramps`."""
        return f"{self.seconds:.1f} s of recording {self.recording}"


def event_of(term: Term, values: Sequence[float], model: DiagnosisModel) -> Event | None:
    """When a fitted term sets in; None for one without an instant.

    Args:
        term: The term.
        values: Of its parameters, as fitted: the instant on the joint axis.
        model: Model of the recordings that were fitted, wrapped or not.
    """
    timeline = None if term.recording is not None else model.timeline  # a fault has begin and end instead
    joint = next((v for p, v in zip(term.parameters, values) if p.is_instant), None)
    if timeline is None or joint is None:
        return None
    number, seconds = timeline.place(joint)
    return Event(number, timeline.recordings[number].title, seconds, timeline.seats[number].end, joint)


def local_instant(term: Term, values: Sequence[float], model: DiagnosisModel) -> tuple[int, float] | None:
    """Number of the recording in which a fitted term sets in, from 0, and when on its own clock [s]."""
    event = event_of(term, values, model)
    return None if event is None else (event.number, event.seconds)


def event_interval(term: Term, values: Sequence[float], model: DiagnosisModel) -> tuple[float, float] | None:
    """Time in which a fitted term acts in the recording in which it sets in: from its instant to the end [s]."""
    event = event_of(term, values, model)
    return None if event is None else (event.seconds, event.end)


def instant_interval(term: Term, fit: Fit, model: DiagnosisModel, doubt: float = 1.0) -> tuple[float, float] | None:
    """Instants around the fitted one that explain the recordings as well (95 %), on the joint axis [s].

    While nothing is driven a break at one instant is as good as at any other, and the curvature there says nothing. So
    instants farther and farther away are tried, everything else as fitted: the interval ends at the first that raises
    -2 log posterior by more than the 95 % point of chi-square with one degree of freedom (likelihood ratio; S. S.
    Wilks, Ann. Math. Statist. 9 (1938) 60-62). It is wider than that by at most the distance of two instants that are
    tried.

    Args:
        term: A term of the fit.
        fit: Of the recordings.
        model: Their model.
        doubt: Factor on the errors: where more than noise is left, so much larger is the rise that is no surprise.
    """
    number = next((i for i, p in enumerate(term.parameters) if p.is_instant), None)
    if number is None or term.recording is not None:
        return None
    return _as_good(term, number, fit, model, doubt)


def _as_good(term: Term, number: int, fit: Fit, model: DiagnosisModel, doubt: float) -> tuple[float, float]:
    """See `instant_interval`; of any instant of a term by its number."""
    values = fit.point.terms[term]
    parameter, now = term.parameters[number], values[number]
    most = RISE * doubt**2
    ends = []
    for bound in (parameter.lower, parameter.upper):
        width = abs(bound - now)
        count = int(np.ceil(np.log(max(width / NEAREST, 1.0)) / np.log(FARTHER))) + 1
        there = now + np.sign(bound - now) * np.minimum(NEAREST * FARTHER ** np.arange(count), width)
        points = [fit.point.plus(term, (*values[:number], float(v), *values[number + 1 :])) for v in there]
        rise = np.array(costs_at(model, fit, points)) - fit.cost
        beyond = np.flatnonzero(rise > most)
        ends.append(float(there[beyond[0]]) if beyond.size else bound)
    return ends[0], ends[1]


def since(term: Term, fit: Fit, model: DiagnosisModel, doubt: float = 1.0, units: Units = IN_SI) -> str:
    """When a fitted term sets in, for people, as sharply as the recordings tell it; empty for one without an instant.

    `at 8.0 s of recording stairs`, `between 7.6 and 8.4 s of recording stairs`, or
    `between 43.8 s of recording levels and 3.2 s of recording stairs`.

    Args:
        term: A term of the fit.
        fit: Of the recordings.
        model: Their model.
        doubt: As in `instant_interval`.
        units: In which instants are shown.
    """
    timeline, interval = model.timeline, instant_interval(term, fit, model, doubt)
    if timeline is None or interval is None:
        return ""
    (first, begin), (last, end) = (timeline.place(joint) for joint in interval)
    titles = [f"recording {timeline.recordings[n].title}" for n in (first, last)]
    scale = units.scale(end, "s")
    decimals = 1 + max(round(-math.log10(scale.factor)), 0)  # a tenth of a second, in any unit
    texts = [f"{scale(instant):.{decimals}f}" for instant in (begin, end)]
    if first != last:
        return f"between {texts[0]} {scale.unit} of {titles[0]} and {texts[1]} {scale.unit} of {titles[1]}"
    if texts[0] == texts[1]:
        return f"at {texts[0]} {scale.unit} of {titles[0]}"
    return f"between {texts[0]} and {texts[1]} {scale.unit} of {titles[0]}"


def between_samples(estimates: Sequence[Estimate], term: Term, model: DiagnosisModel) -> tuple[Estimate, ...]:
    """Estimates of a fault of a sensor, with begin and end known to half a sampling interval at best.

    A reading says how the sensor is at its instant; when it changed before that, no reading says. In the fit a sample
    stands for the time to halfway to its neighbours, so the curvature alone would tell begin and end more sharply than
    the sensor was read. What acts on the rig itself shows in the course afterwards and needs no such width.

    Args:
        estimates: One for each parameter of the term, in order.
        term: Any term.
        model: Model of the recordings that were fitted, wrapped or not.
    """
    channels = model.where(term)[1].channels if term.recording is not None else None
    if not channels or len(channels) != 1:
        return tuple(estimates)
    layout = model.layout
    times = np.unique(np.asarray(layout.time)[np.asarray(layout.channel) == channels[0]])
    if len(times) < 2:
        return tuple(estimates)
    found = []
    for e, p in zip(estimates, term.parameters):
        after = int(np.clip(np.searchsorted(times, e.value), 1, len(times) - 1))
        half = 0.5 * float(times[after] - times[after - 1]) if p.is_instant else 0.0
        found.append(replace(e, lower=e.lower - half, upper=e.upper + half))
    return tuple(found)


def ends_by_likelihood(
    estimates: Sequence[Estimate], term: Term, fit: Fit, model: DiagnosisModel, doubt: float = 1.0
) -> tuple[Estimate, ...]:
    """Estimates of a fault whose begin and end may be anywhere while that would have changed nothing.

    While an input that stayed is stated not to move, one that is a share off is stated as zero, or a sensor that stands
    still would have read the same, the curvature says nothing, see `instant_interval`: it holds whatever the bounds
    allow, and the likelihood alone tells. Begin and end of a sensor's fault are asked for there alone; estimates of
    other terms are as they were.

    Args:
        estimates: One for each parameter of the term, in order.
        term: Any term.
        fit: Of the recordings; the term is one of its.
        model: Model of the recordings that were fitted, wrapped or not.
        doubt: As in `instant_interval`.
    """
    if term.recording is None:
        return tuple(estimates)
    is_of_input = model.where(term)[1].channels is None
    found = []
    for number, (e, p) in enumerate(zip(estimates, term.parameters)):
        is_told = e.lower > p.lower or e.upper < p.upper  # by the curvature
        if not p.is_instant or (is_told and not is_of_input):
            found.append(e)
            continue
        lower, upper = _as_good(term, number, fit, model, doubt)
        if is_told:
            lower, upper = min(e.lower, lower), max(e.upper, upper)
        found.append(replace(e, lower=lower, upper=upper))
    return tuple(found)


def local_estimates(
    estimates: Sequence[Estimate], term: Term, fit: Fit, model: DiagnosisModel, doubt: float = 1.0
) -> tuple[Estimate, ...]:
    """Estimates of a term with its instant and the interval of that on the clock of the recording in which it sets in.

    The interval is the wider one of what the curvature says and of `instant_interval`. One that reaches into the
    recording before begins before this one does, and says so by its numbers.

    Args:
        estimates: One for each parameter of the term, in order; instants on the joint axis.
        term: The term.
        fit: Of the recordings; the term is one of its.
        model: Model of the recordings that were fitted, wrapped or not.
        doubt: As in `instant_interval`.
    """
    event = event_of(term, fit.point.terms[term], model)
    seen = instant_interval(term, fit, model, doubt)
    if event is None or seen is None:
        return tuple(estimates)
    late = event.joint - event.seconds
    return tuple(
        replace(e, value=e.value - late, lower=min(e.lower, seen[0]) - late, upper=max(e.upper, seen[1]) - late)
        if p.is_instant
        else e
        for e, p in zip(estimates, term.parameters)
    )
