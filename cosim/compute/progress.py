"""How far a batch is: simulations made, simulations expected, and the time that the rest will take."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

#: Share of a new simulation's time in the running mean: later ones resemble the next ones most.
_SHARE = 0.2


class Progress:
    """Counts simulations and says what is left.

    How many a search needs is not known at its begin; it says what it expects at the begin of every stage, and the
    estimate follows.

    Args:
        tell: Told one line at every change.
    """

    def __init__(self, tell: Callable[[str], None] = lambda text: None) -> None:
        self._tell = tell
        self.stage, self.done, self.cached, self.expected = "", 0, 0, 0
        self.parallel = 1
        self._mean: float | None = None
        self._begin = clock.perf_counter()

    def enter(self, stage: str, expected: int = 0) -> None:
        """A new stage begins.

        Args:
            stage: What is being done.
            expected: Simulations that are still to be made, in this stage and all later ones; 0: not known.
        """
        self.stage = stage
        self.expected = self.done + expected
        self.say()

    def finished(self, seconds: float, was_kept: bool) -> None:
        """A simulation is there.

        Args:
            seconds: Wall time that it took.
            was_kept: Whether it came from the disk.
        """
        self.done += 1
        if was_kept:
            self.cached += 1
        self._mean = seconds if self._mean is None else (1 - _SHARE) * self._mean + _SHARE * seconds
        self.say()

    @property
    def remaining(self) -> float | None:
        """Estimated wall time left [s]; None while nothing is known."""
        if self._mean is None or self.expected <= self.done:
            return None
        return (self.expected - self.done) * self._mean / self.parallel

    def text(self) -> str:
        """One line."""
        kept = f" ({self.cached} from the disk)" if self.cached else ""
        if self.expected > self.done:
            left = "" if self.remaining is None else f", {duration(self.remaining)} left"
            return f"{self.stage}: {self.done} of about {self.expected} simulations{kept}{left}"
        return f"{self.stage}: {self.done} simulations{kept}"

    def say(self) -> None:
        """Tell the present line."""
        self._tell(self.text())

    @property
    def elapsed(self) -> float:
        """Wall time since the begin [s]."""
        return clock.perf_counter() - self._begin


def duration(seconds: float) -> str:
    """A time for people.

    >>> duration(3.2), duration(200.0), duration(4000.0)
    ('4 s', '3.3 min', '1.1 h')
    """
    if seconds < 60:
        return f"{int(seconds) + 1} s"
    return f"{seconds / 60:.1f} min" if seconds < 3600 else f"{seconds / 3600:.1f} h"
