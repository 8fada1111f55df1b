"""Progress of runs in the terminal: one line per run, with a bar, per cent and the time left, in 80 columns."""

from __future__ import annotations

import sys
import threading
import time as clock
from collections.abc import Callable, Iterator, MutableSequence, Sequence
from contextlib import contextmanager
from multiprocessing.context import BaseContext
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar
from rich.table import Column

from cosim.run import Progress

#: Widths of title and bar; with per cent (5), time left (15) and the gaps between them a line has 79 columns.
TITLE, BAR = 34, 22
#: Seconds between lines where there is no terminal, and between looks at other processes.
SAYING, LOOKING = 10.0, 0.25

OnProgress = Callable[[Progress], None]


def shortened(title: str, width: int = TITLE) -> str:
    """A title that fits: cut at a word where that loses little, with three dots."""
    if len(title) <= width:
        return title
    cut = title[: width - 3]
    at = cut.rfind(" ")
    return cut[: at if at > width // 2 else None].rstrip(" ,;:(") + "..."


def time_left(seconds: float) -> str:
    """`9 s left`, `2 min 5 s left`, `1 h 3 min left`; empty where it is not known."""
    if not 0.0 <= seconds < 3.6e6:
        return ""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s left"
    if whole < 600:
        return f"{whole // 60} min {whole % 60} s left"
    if whole < 3600:
        return f"{whole // 60} min left"
    if whole < 36000:
        return f"{whole // 3600} h {whole % 3600 // 60} min left"
    return f"{whole // 3600} h left"


def line(title: str, share: float, remaining: float) -> str:
    """One line of at most 79 columns for output that is no terminal."""
    filled = int(BAR * share)
    bar = "#" * filled + "-" * (BAR - filled)
    return f"{shortened(title):<{TITLE}} {bar} {int(100 * share):>3} % {time_left(remaining):>15}".rstrip()


@contextmanager
def progress_bar(title: str, stream: Console | None = None) -> Iterator[OnProgress]:
    """A callback for `run` that draws a bar on a terminal and prints a line every 10 s elsewhere."""
    console = stream or Console(stderr=True)
    if console.is_terminal:
        with _bars(console) as bar:
            task = _task(bar, title)

            def draw(p: Progress) -> None:
                bar.update(task, completed=p.done / p.total, left=time_left(p.remaining))

            yield draw
        return
    last = clock.perf_counter()

    def say(p: Progress) -> None:
        nonlocal last
        if clock.perf_counter() - last < SAYING:
            return
        last = clock.perf_counter()
        print(line(title, p.done / p.total, p.remaining), file=sys.stderr, flush=True)

    yield say


def _bars(console: Console) -> Bar:
    return Bar(
        TextColumn("{task.description}", table_column=Column(width=TITLE, no_wrap=True), markup=False),
        BarColumn(bar_width=BAR),
        TextColumn("{task.percentage:>3.0f} %", table_column=Column(width=5, no_wrap=True)),
        TextColumn("{task.fields[left]}", table_column=Column(width=15, no_wrap=True, justify="right")),
        console=console,
        transient=True,
    )


def _task(bar: Bar, title: str) -> Any:
    return bar.add_task(shortened(title), total=1.0, left="")


class Board:
    """Lines of several runs in processes of their own.

    The processes write into memory that is shared without locks, so that one that crashes stops no other.

    Args:
        titles: One per run; the place in the sequence is the run's number.
        context: Of the processes.
        stream: Where to draw; default: standard error.
    """

    def __init__(self, titles: Sequence[str], context: BaseContext, stream: Console | None = None) -> None:
        self.titles, self._console = titles, stream or Console(stderr=True)
        #: Share done and time left [s] of every run; a share below 0: it has not begun.
        self.slots: MutableSequence[float] = context.RawArray("d", [-1.0, 0.0] * len(titles))
        self._ended: set[int] = set()
        self._stop = threading.Event()

    def ended(self, number: int, outcome: str) -> None:
        """Say how a run ended; its line goes."""
        self._ended.add(number)
        self._console.print(
            f"[{len(self._ended)}/{len(self.titles)}] {self.titles[number]}: {outcome}",
            markup=False,
            highlight=False,
            soft_wrap=True,
        )

    @contextmanager
    def drawn(self) -> Iterator[None]:
        """Draws until the block ends."""
        thread = threading.Thread(target=self._draw if self._console.is_terminal else self._say, daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._stop.set()
            thread.join()

    def running(self) -> list[tuple[int, float, float]]:
        """Number, share done and time left [s] of every run that goes on."""
        states = [(i, self.slots[2 * i], self.slots[2 * i + 1]) for i in range(len(self.titles))]
        return [state for state in states if state[1] >= 0.0 and state[0] not in self._ended]

    def _draw(self) -> None:
        with _bars(self._console) as bar:
            tasks: dict[int, Any] = {}
            while not self._stop.wait(LOOKING):
                now = self.running()
                for number, share, remaining in now:
                    if number not in tasks:
                        tasks[number] = _task(bar, self.titles[number])
                    bar.update(tasks[number], completed=share, left=time_left(remaining))
                for number in set(tasks) - {n for n, _, _ in now}:
                    bar.remove_task(tasks.pop(number))

    def _say(self) -> None:
        while not self._stop.wait(SAYING):
            for number, share, remaining in self.running():
                self._console.print(
                    line(self.titles[number], share, remaining), markup=False, highlight=False, soft_wrap=True
                )


_slots: MutableSequence[float] | None = None


def report_to(slots: MutableSequence[float]) -> None:
    """Called at the start of a process: runs in it tell a board in another one how far they are."""
    global _slots
    _slots = slots


def reporter(number: int) -> OnProgress:
    """A callback for run `number` of the board; without a board it does nothing."""
    slots = _slots

    def tell(p: Progress) -> None:
        if slots is not None:
            slots[2 * number + 1] = p.remaining
            slots[2 * number] = p.done / p.total

    return tell
