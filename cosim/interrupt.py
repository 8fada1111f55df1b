"""Ctrl-C that stops a run between two macro-steps, not inside ngspice, an FMU or Bullet, and is never lost.

SIGTERM, by which `timeout` and schedulers of jobs announce that a command's time is over, is the same.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType

#: Time after which a Ctrl-C that was swallowed is sent again: the callback has ended by then [s].
AGAIN = 0.05
#: Signals to end that come within this time are one: `timeout` sends its own to the process and to its group [s].
ONE = 1.0


@dataclass
class Interrupt:
    """Whether the user has asked to stop."""

    is_requested: bool = False

    def check(self) -> None:
        """Raise KeyboardInterrupt if the user has asked to stop."""
        if self.is_requested:
            raise KeyboardInterrupt


@contextmanager
def deferred_interrupt() -> Iterator[Interrupt]:
    """Note the first SIGINT; the second one acts at once.

    An exception raised inside a callback from C (ngspice's messages, CVODE's derivatives) would be lost or taken for a
    failure of the unit. Outside the main thread, or where a program has its own handler, nothing is changed.
    """
    interrupt = Interrupt()

    def note() -> bool:
        interrupt.is_requested = True
        return True

    with first_interrupt(note):
        yield interrupt


class _Asking:
    """Handler of SIGINT that asks first, once it was taken no more."""

    def __init__(self, ask: Callable[[], bool]) -> None:
        self._ask, self._is_taken = ask, False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        if self._is_taken or not self._ask():
            signal.default_int_handler(number, frame)
        self._is_taken = True


#: Who is asked, the innermost last; SIGTERM asks where SIGINT is ignored.
_ASKED: list[_Asking] = []


@contextmanager
def first_interrupt(ask: Callable[[], bool]) -> Iterator[None]:
    """Ask what a SIGINT may do: one that is taken (True) does no more, and the next one acts at once.

    Outside the main thread, or where a program has its own handler, nothing is changed. Where SIGINT is ignored, as a
    shell without job control has it for what it starts with `&`, it stays ignored, and SIGTERM asks. Within each other
    the innermost is asked: a run within a search still ends between two macro-steps.
    """
    previous = signal.getsignal(signal.SIGINT)
    is_own = previous in (signal.default_int_handler, signal.SIG_IGN) or isinstance(previous, _Asking)
    if threading.current_thread() is not threading.main_thread() or not is_own:
        yield
        return
    _ASKED.append(_Asking(ask))
    if previous is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _ASKED[-1])
    try:
        yield
    finally:
        _ASKED.pop()
        signal.signal(signal.SIGINT, previous)


def end_as_interrupt() -> None:
    """Take SIGTERM as a Ctrl-C: from now on, in this process.

    Without it nothing of a long command would be kept or answered. The second one, or a Ctrl-C after it, acts at once.
    It does so where SIGINT is ignored, too. Outside the main thread nothing is changed.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    last = -ONE

    def interrupt(number: int, frame: FrameType | None) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last < ONE:
            return
        last = now
        if _is_ignored():
            (_ASKED[-1] if _ASKED else signal.default_int_handler)(number, frame)
        else:
            signal.raise_signal(signal.SIGINT)

    signal.signal(signal.SIGTERM, interrupt)


def _is_ignored() -> bool:
    """Whether this process ignores SIGINT."""
    return signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def keep_swallowed_interrupts() -> None:
    """Send a Ctrl-C again that Python could not raise: from now on, in this process.

    Python raises KeyboardInterrupt wherever its main thread is. In a callback from C (ngspice's messages, an FMU's
    logger) or a finaliser it prints the exception, ignores it, and the command would go on to its end. Other ignored
    exceptions are printed as before.
    """
    print_ignored = sys.unraisablehook

    def send_again(ignored: sys.UnraisableHookArgs) -> None:
        if ignored.exc_type is not None and issubclass(ignored.exc_type, KeyboardInterrupt):
            main = threading.main_thread().ident or 0
            number, after = (signal.SIGTERM, ONE + AGAIN) if _is_ignored() else (signal.SIGINT, AGAIN)
            timer = threading.Timer(after, signal.pthread_kill, (main, number))
            timer.daemon = True  # a command that has ended meanwhile does not wait for it
            timer.start()
        else:
            print_ignored(ignored)

    sys.unraisablehook = send_again
