"""Recordings laid end to end: one axis of time on which an event happens once.

A coil that breaks at 8 s of the third recording is broken in all later ones. So an instant is counted on a joint axis:
the recordings that are fitted follow each other in the order in which they were made, without gaps. Recordings held out
take no room on it: each lies between two that are fitted, and what has happened by then is there from its start.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from cosim.unit.errors import InputError
from diagnosis.recording.recording import Recording

#: How long before a recording begins what was there from the start is said to have set in, and how long after its end
#: what never does [s]: any positive time says the same.
ASIDE = 1.0


@dataclass(frozen=True)
class Day:
    """A day: equal to itself alone, or to all of the same name.

    Args:
        name: As the recordings give it; empty: a day of its own.
        recording: Number of the only recording of a day without a name, from 0; -1 else.
    """

    name: str
    recording: int = -1

    @property
    def label(self) -> str:
        """Where something acts that belongs to this day alone, for people."""
        return f"on day {self.name}" if self.name else f"in recording {self.recording + 1}"


@dataclass(frozen=True)
class Seat:
    """Where a recording lies on the joint axis.

    Args:
        begin: First instant that is simulated, on the recording's own clock [s].
        end: Last instant, on the same clock [s].
        position: Where it begins on the joint axis [s].
        day: The day that it belongs to; None: one that no fitted recording has.
        is_fitted: Whether it takes room on the axis.
        cycles_before: Full cycles that the rig had made before it.
    """

    begin: float
    end: float
    position: float
    day: Day | None
    is_fitted: bool = True
    cycles_before: float = 0.0

    def local(self, instant: float) -> float | None:
        """An instant of the joint axis on the recording's own clock [s].

        Before `begin`, by at most `ASIDE`: it is there from the start. None: it has not set in by the end.
        """
        if not self.is_fitted:
            return self.begin - ASIDE if instant < self.position else None
        own = instant - self.position + self.begin
        return max(own, self.begin - ASIDE) if own < self.end else None


@dataclass(frozen=True)
class Timeline:
    """The joint axis of the recordings that are fitted.

    Args:
        recordings: These, as they were given.
        seats: Where each of them lies.
        order: Their numbers, the first that was made first.
    """

    recordings: tuple[Recording, ...]
    seats: tuple[Seat, ...]
    order: tuple[int, ...]

    @staticmethod
    def of(recordings: Sequence[Recording], spans: Sequence[tuple[float, float]]) -> Timeline:
        """Lay recordings end to end.

        Args:
            recordings: At least one, as they were given.
            spans: First and last instant of each that is simulated, on its own clock [s].

        Raises:
            InputError: Some say their `order` and some do not, or two say the same.
        """
        order = _ordered(recordings)
        seats: dict[int, Seat] = {}
        position = spans[order[0]][0]  # of one recording alone both clocks are the same
        for number in order:
            begin, end = spans[number]
            name = recordings[number].day
            day = Day(name) if name else Day("", number)
            seats[number] = Seat(begin, end, position, day, cycles_before=recordings[number].cycles_before)
            position += end - begin
        return Timeline(tuple(recordings), tuple(seats[n] for n in range(len(recordings))), order)

    @property
    def begin(self) -> float:
        """Begin of the axis [s]."""
        return self.seats[self.order[0]].position

    @property
    def end(self) -> float:
        """End of the axis [s]."""
        last = self.seats[self.order[-1]]
        return last.position + last.end - last.begin

    @property
    def days(self) -> tuple[Day, ...]:
        """Days of the recordings, in their order."""
        found = (self.seats[n].day for n in self.order)
        return tuple(dict.fromkeys(d for d in found if d is not None))

    def place(self, instant: float) -> tuple[int, float]:
        """Number of the recording in which an instant of the joint axis lies, from 0, and its local time [s].

        The end of a recording is the begin of the next one.
        """
        number = next((n for n in reversed(self.order) if self.seats[n].position <= instant), self.order[0])
        seat = self.seats[number]
        return number, instant - seat.position + seat.begin

    def joint(self, number: int, instant: float) -> float:
        """Instant on the joint axis of a local time of a recording [s].

        Args:
            number: Of the recording, from 0.
            instant: On its own clock [s].
        """
        seat = self.seats[number]
        return instant - seat.begin + seat.position

    def local(self, instant: float, seat: Seat, lasts: bool) -> float | None:
        """An instant of the joint axis on the clock of a recording [s]; see `Seat.local`.

        Args:
            instant: On the joint axis [s].
            seat: Of the recording, one of this axis or of `others`.
            lasts: Whether what sets in lasts on later days too.

        Returns:
            None where it is not there: not yet, or on another day only.
        """
        if not lasts and self.seats[self.place(instant)[0]].day != seat.day:
            return None
        return seat.local(instant)

    def others(self, recordings: Sequence[Recording], spans: Sequence[tuple[float, float]]) -> tuple[Seat, ...]:
        """Seats of recordings that are not fitted.

        Args:
            recordings: As they were given; without an `order` they come after those that are fitted.
            spans: As in `of`.

        Raises:
            InputError: Those that are fitted do not say their `order` and these do, or two say the same.
        """
        taken = {r.order: r for r in self.recordings}
        found = []
        for recording, (begin, end) in zip(recordings, spans):
            position = self.end
            if recording.order is not None:
                if None in taken:
                    raise _wrong(recording, "is given here and not in the recordings that are fitted")
                if recording.order in taken:
                    raise _wrong(recording, f"is {recording.order}, as in {taken[recording.order].path}")
                taken[recording.order] = recording
                later = [s.position for r, s in zip(self.recordings, self.seats) if _place(r) > recording.order]
                position = min(later, default=self.end)
            day = Day(recording.day) if recording.day else None
            found.append(
                Seat(begin, end, position + ASIDE * (position == self.end), day, False, recording.cycles_before)
            )
        return tuple(found)

    def seat_of(self, recording: Recording, span: tuple[float, float]) -> Seat:
        """Seat of a recording that is fitted, known by its folder and title, or of another one."""
        for known, seat in zip(self.recordings, self.seats):
            if (known.path, known.title) == (recording.path, recording.title):
                return seat
        return self.others([recording], [span])[0]

    @property
    def afterwards(self) -> Seat:
        """Seat of a run after the last recording, on a day of its own: the rig as it is now."""
        last = self.seats[self.order[-1]]
        return replace(last, position=self.end + ASIDE, day=None, is_fitted=False)


def _place(recording: Recording) -> int:
    assert recording.order is not None
    return recording.order


def _ordered(recordings: Sequence[Recording]) -> tuple[int, ...]:
    given = [r.order for r in recordings]
    if all(order is None for order in given):
        return tuple(range(len(recordings)))
    known: dict[int, Recording] = {}
    for recording in recordings:
        if recording.order is None:
            raise _wrong(recording, "is missing here and given in others")
        if recording.order in known:
            raise _wrong(recording, f"is {recording.order}, as in {known[recording.order].path}")
        known[recording.order] = recording
    return tuple(sorted(range(len(recordings)), key=lambda n: _place(recordings[n])))


def _wrong(recording: Recording, problem: str) -> InputError:
    return InputError(
        recording.path / "recording.yaml",
        "order",
        f"the place among the recordings {problem}",
        "number all recordings in the order in which they were made, each once, from 1",
    )
