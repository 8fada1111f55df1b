"""Progress of a run in the terminal: simulated time, speed against real time, time left."""

from __future__ import annotations

import sys
import time as clock
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from cosim.run import Progress


@contextmanager
def progress_bar(title: str, stream: Console | None = None) -> Iterator[Callable[[Progress], None]]:
    """A callback for `run` that draws a bar on a terminal and prints a line every 10 s elsewhere."""
    console = stream or Console(stderr=True)
    if console.is_terminal:
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("t = {task.fields[moment]:.2f} s  {task.fields[speed]:.2g} x real time"),
            TimeRemainingColumn(),
        )
        with Bar(*columns, console=console, transient=True) as bar:
            task = bar.add_task(title, total=None, moment=0.0, speed=0.0)

            def draw(p: Progress) -> None:
                bar.update(task, total=p.total, completed=p.done, moment=p.time, speed=_speed(p))

            yield draw
        return
    last = clock.perf_counter()

    def say(p: Progress) -> None:
        nonlocal last
        if clock.perf_counter() - last < 10.0:
            return
        last = clock.perf_counter()
        speed = _speed(p)
        print(f"{title}: t = {p.time:.2f} s, {100 * p.done / p.total:.0f} %, {speed:.2g} x real time, "
              f"about {p.remaining:.0f} s left", file=sys.stderr, flush=True)  # fmt: skip

    yield say


def _speed(p: Progress) -> float:
    return p.simulated / p.elapsed if p.elapsed else 0.0
