"""How far the present stage of a diagnosis is, and how long it will still take, for whoever watches.

The loops in which a stage spends its time lie deep in the search, below functions that know nothing of a terminal. They
say what they count with `counted` or `share`; where nobody watches, that does nothing.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TypeVar

from cosim.compute.progress import duration

T = TypeVar("T")

#: Least time between two lines [s]: as often as a line can be read.
PAUSE = 0.5
#: Time that a count must have run before the time left is shown [s].
SETTLED = 2.0
#: A stage that was so far and is at less than half of that has begun another part: how many follow is not known.
FINISHED = 0.95


class TimeIsOver(Exception):
    """The time that was given is over, within what may be left out; see `may_be_left`."""


@dataclass(eq=False)
class Count:
    """A loop that counts what it has done.

    Args:
        what: What it counts.
        total: How many there are.
        begin: When it began [s].
        done: How many are done.
        within: How far the present one is, from 0 to 1.
    """

    what: str
    total: int
    begin: float
    done: int = 0
    within: float = 0.0

    @property
    def share(self) -> float:
        """How far the whole loop is."""
        return (self.done + self.within) / max(self.total, 1)


class Steps:
    """Told stages, as `on_progress` is, and counts within them; tells a line of both.

    Counts may lie within each other: the outermost is shown, and how far it is takes the inner ones into account.

    Args:
        tell: Told a line.
        now: Time [s]; for tests.
        most: Time after which what may be left out is left out [s].
        is_usual: Whether nobody asked for that time: what cannot end then goes on; see `without_usual_time`.
    """

    def __init__(
        self,
        tell: Callable[[str], None],
        now: Callable[[], float] = clock.monotonic,
        most: float = math.inf,
        is_usual: bool = False,
    ) -> None:
        self._tell, self._now = tell, now
        self._end, self._is_usual = now() + most, is_usual
        self.optional = 0
        self.has_left = False
        self._stage = ""
        self._counts: list[Count] = []
        self._begin = self._last = now()
        self._alone = 0.0  # share of a stage that counts nothing
        self._has_parts = False  # whether such a stage was at its end and went on

    @property
    def has_end(self) -> bool:
        """Whether a time was asked for after which what may be left out is left out."""
        return self._end < math.inf and not self._is_usual

    def without_usual_time(self) -> None:
        """Go on for as long as it takes, unless somebody asked for a time."""
        if self._is_usual:
            self._end = math.inf

    def stop(self) -> bool:
        """Leave out what may be left out from now on.

        Returns:
            Whether something is being done that may be left out; else nothing is changed.
        """
        if self.optional:
            self._end = -math.inf
        return self.optional > 0

    def __call__(self, stage: str) -> None:
        """Another stage begins; within a count it stays what it is."""
        self._check()
        if self._counts:
            return
        self._stage, self._alone, self._has_parts, self._begin = stage, 0.0, False, self._now()
        self._last = self._begin
        self._tell(stage)

    def begin(self, what: str, total: int) -> Count:
        """A loop over `total` items begins."""
        self._counts.append(Count(what, total, self._now()))
        if len(self._counts) == 1:
            self._say()
        return self._counts[-1]

    def done(self, count: Count, number: int = 1) -> None:
        """So many items more are done, and with them all loops within."""
        self._check()
        if count in self._counts:
            del self._counts[self._counts.index(count) + 1 :]
            count.done += number
            count.within = 0.0
            self._told()

    def _check(self) -> None:
        """Leave what may be left out, if the time is over.

        Raises:
            TimeIsOver: It is.
        """
        if self.optional and self._now() >= self._end:
            self.has_left = True
            raise TimeIsOver

    def end(self, count: Count) -> None:
        """A loop is over, and with it all loops within."""
        if count in self._counts:
            del self._counts[self._counts.index(count) :]

    def share(self, value: float) -> None:
        """How far the present item is, or the stage where nothing is counted, from 0 to 1."""
        if self._counts:
            self._counts[-1].within = max(self._counts[-1].within, min(value, 1.0))
        else:
            self._has_parts |= self._alone >= FINISHED and value < 0.5 * self._alone
            self._alone = max(self._alone, min(value, 1.0))
        self._told()

    def _told(self) -> None:
        """What inner loops have done is a part of the outer ones' present items."""
        for outer, inner in zip(self._counts[-2::-1], self._counts[:0:-1]):
            outer.within = max(outer.within, min(inner.share, 1.0))
        self._say()

    def _say(self) -> None:
        now = self._now()
        if now - self._last >= PAUSE:
            self._last = now
            self._tell(self.text())

    def text(self) -> str:
        """The present line."""
        now = self._now()
        if self._has_parts and not self._counts:
            return f"{self._stage}: {duration(now - self._begin)} so far"
        if not self._counts:
            share, begin, what = self._alone, self._begin, ""
        else:
            first = self._counts[0]
            share, begin = first.share, first.begin
            what = f": {first.done} of {first.total} {first.what}"
        if share <= 0.0:
            return f"{self._stage}{what}"
        spent = now - begin
        rest = spent * (1.0 - share) / share
        left = f", about {duration(rest)} left in this step" if spent >= SETTLED and share < 1.0 else ""
        return f"{self._stage}{what}{',' if what else ':'} {100.0 * share:.0f} %{left}"


_WATCHED: ContextVar[Steps | None] = ContextVar("watched", default=None)


@contextmanager
def watched(steps: Steps) -> Iterator[Steps]:
    """Counts are reported to these steps until the end."""
    token = _WATCHED.set(steps)
    try:
        yield steps
    finally:
        _WATCHED.reset(token)


@contextmanager
def may_be_left(is_so: bool = True) -> Iterator[None]:
    """What is done within may be left out once the time is over: `TimeIsOver` is raised where an item ends.

    Args:
        is_so: Whether it may; else as it was around it.
    """
    steps = _WATCHED.get()
    if steps is None or not is_so:
        yield
        return
    steps.optional += 1
    try:
        yield
    finally:
        steps.optional -= 1


def is_limited() -> bool:
    """Whether a time was asked for after which what may be left out is left out."""
    steps = _WATCHED.get()
    return steps is not None and steps.has_end


def without_usual_time() -> None:
    """See `Steps.without_usual_time`."""
    steps = _WATCHED.get()
    if steps is not None:
        steps.without_usual_time()


def was_left() -> bool:
    """Whether anything was left out, as the time was over."""
    steps = _WATCHED.get()
    return steps is not None and steps.has_left


def counted(items: Sequence[T], what: str, sizes: Sequence[int] | None = None) -> Iterator[T]:
    """The items one after the other, each told as done once the next is asked for.

    Args:
        items: What is worked through.
        what: What they are and what is done to them: `laws scored`.
        sizes: How many each item stands for; None: one.
    """
    steps = _WATCHED.get()
    if steps is None or not items:
        yield from items
        return
    count = steps.begin(what, len(items) if sizes is None else sum(sizes))
    try:
        for number, item in enumerate(items):
            yield item
            steps.done(count, 1 if sizes is None else sizes[number])
    finally:
        steps.end(count)


def share(value: float) -> None:
    """How far the present item of a count is, or the stage where nothing is counted, from 0 to 1."""
    steps = _WATCHED.get()
    if steps is not None:
        steps.share(value)
