"""One start of an ensemble, here or in a process of its own: it loads what a run needs, no figures."""

from __future__ import annotations

import signal
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from rich.console import Console

from chainmail.ensemble.members import member
from cosim.progress import OnProgress, progress_bar
from cosim.run import Progress, RunStopped, record
from cosim.scenario import Scenario
from cosim.unit.errors import InputError

#: Told of a start, counted from 1, and how far it is.
OnStart = Callable[[int, Progress], None]


@dataclass(frozen=True)
class Ended:
    """How a start ended.

    Args:
        reason: Why it stopped; empty: it is complete.
        is_interrupt: Whether the user interrupted it.
        is_input: Whether the scenario or an FMU is wrong.
    """

    reason: str = ""
    is_interrupt: bool = False
    is_input: bool = False


def ignore_interrupts_between_runs() -> None:
    """A process without work waits for some, whatever happens: its parent ends it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def run_start(scenario: Scenario, start: int, path: Path, csv: bool, told: OnStart | None = None) -> Ended:
    """Run or resume one start; in a process of its own, or here."""
    given = signal.getsignal(signal.SIGINT)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return _run_one(scenario, start, path, csv, told)
    finally:
        signal.signal(signal.SIGINT, given)


def _run_one(scenario: Scenario, start: int, path: Path, csv: bool, told: OnStart | None) -> Ended:
    is_begun = (path / "scenario.yaml").is_file()
    try:
        with _progress(start, told) as on_progress:
            record(member(scenario, start), path, is_begun, on_progress, csv)
    except RunStopped as stopped:
        return Ended(stopped.reason, stopped.is_interrupt)
    except InputError as error:
        return Ended(str(error), is_input=True)
    except KeyboardInterrupt:
        return Ended("interrupted", is_interrupt=True)
    return Ended()


def _progress(start: int, told: OnStart | None) -> AbstractContextManager[OnProgress]:
    if told is not None:
        return nullcontext(partial(told, start))
    return progress_bar(f"start {start}", Console(stderr=True, force_terminal=False))
