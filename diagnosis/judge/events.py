"""When something set in: in which recording, and when on its own clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from diagnosis.judge.diagnosis import Estimate
from diagnosis.search.problem import Term
from diagnosis.simulator.models import DiagnosisModel, timeline_of


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
    timeline = timeline_of(model)
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


def with_local_instants(
    estimates: Sequence[Estimate], term: Term, values: Sequence[float], model: DiagnosisModel
) -> tuple[Estimate, ...]:  # fmt: skip
    """Estimates of a term with its instant, and the interval of that, on the clock of the recording in which it sets in.

    An interval that reaches into the recording before begins before this one does, and says so by its numbers.

    Args:
        estimates: One for each parameter of the term, in order; instants on the joint axis.
        term: The term.
        values: Of its parameters, as fitted.
        model: Model of the recordings that were fitted.
    """
    event = event_of(term, values, model)
    if event is None:
        return tuple(estimates)
    late = event.joint - event.seconds
    return tuple(
        replace(e, value=e.value - late, lower=e.lower - late, upper=e.upper - late) if p.is_instant else e
        for e, p in zip(estimates, term.parameters)
    )
