"""What a diagnosis is doing, in the terminal: one line that changes, or a line now and then where there is none."""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console

from cosim.compute.progress import Progress

#: Interval of lines where standard error is no terminal [s].
INTERVAL = 10.0


class Display:
    """Takes the present stage of a diagnosis and, where simulations are counted, how far they are.

    Args:
        console: Of standard error.
    """

    def __init__(self, console: Console) -> None:
        self.progress = Progress(self.show)
        self._status = console.status("reading") if console.is_terminal else None
        self._last = clock.monotonic()

    def stage(self, text: str) -> None:
        """The diagnosis does something else."""
        self.progress.stage = text
        self.show(self.progress.text() if self.progress.done else text)

    def show(self, text: str) -> None:
        """Draw a line."""
        if self._status is not None:
            self._status.update(text)
        elif clock.monotonic() - self._last >= INTERVAL:
            self._last = clock.monotonic()
            print(text, file=sys.stderr, flush=True)

    @contextmanager
    def drawn(self) -> Iterator[Display]:
        """Keeps the line on a terminal until the end."""
        if self._status is None:
            yield self
            return
        with self._status:
            yield self
