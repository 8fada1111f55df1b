"""How far a proof is, and how long it will take."""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable
from dataclasses import dataclass, field

from cosim.compute.progress import duration

#: Least time between two lines [s].
PAUSE = 10.0


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


@dataclass
class Progress:
    """Tells how many cases of a stage are done, and the time that the others will take.

    Args:
        stage: What is being done.
        total: Cases of the stage.
        kept: Cases that were done before.
        tell: Told one line now and then.
    """

    stage: str
    total: int
    kept: int = 0
    tell: Callable[[str], None] = _say
    _begin: float = field(default_factory=clock.perf_counter)
    _last: float = -PAUSE
    _made: int = 0

    def finished(self, case: str, note: str) -> None:
        """A case is done; what went wrong is printed at once."""
        self._made += 1
        now = clock.perf_counter() - self._begin
        is_last = self.kept + self._made == self.total
        if note:
            self.tell(f"{case}: {note}")
        if now - self._last >= PAUSE or is_last:
            self._last = now
            left = "" if is_last else f", about {duration(self.remaining(now))} left"
            self.tell(f"{self.stage}: {self.kept + self._made} of {self.total} cases{left}")

    def remaining(self, elapsed: float) -> float:
        """Time that is left at the pace so far [s]."""
        return elapsed / max(self._made, 1) * (self.total - self.kept - self._made)
