"""The simulation's side of the process of an isolated unit: start, ask, and tell how it ended."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cosim.isolation.ending import Ending, last_lines, memory_used
from cosim.isolation.limits import Limits, memory_text
from cosim.isolation.message import Channel, Closed, Frame, Kind, raised
from cosim.isolation.shared import Header, create_memory
from cosim.unit.errors import InputError
from cosim.unit.protocol import Unit, UnitError

#: Wall time that the interpreter and its imports may take [s]: about 0.5, much more on a loaded machine.
START_LIMIT = 60.0
#: Wall time for a process that has closed its connection to end [s].
_END_LIMIT = 2.0
_BOOT = "import sys; sys.path[:] = {path!r}; from cosim.isolation.child import serve; serve({arguments})"


class IsolatedProcess:
    """A process that holds one unit.

    Args:
        unit: Name of the unit.
        build: Makes the unit there.
        limits: What it may take.
        folder: Folder that the process removes if the simulation is killed.

    Raises:
        UnitError: It cannot be started.
    """

    def __init__(self, unit: str, build: Callable[[], Unit], limits: Limits, folder: Path | None) -> None:
        if os.name != "posix":
            raise UnitError(unit, "isolation needs Linux or macOS", remedy="use `isolation: none`")
        self.unit, self.limits = unit, limits
        self.memory = create_memory()
        self.header = Header(self.memory)
        #: Why it is of no use any more; empty: it lives.
        self.failure = ""
        self._status: int | None = None
        self._is_reaped = False
        self._largest, self._first_largest = 0, sys.maxsize
        self._start("" if folder is None else str(folder.resolve()))
        try:
            # Loading the modules that the unit needs is not the FMU's time.
            self.send(Frame(Kind.LOAD, payload=build), "its start", None)
            ready = self._receive("its start", None, START_LIMIT)
        except BaseException:
            self.end()
            raise
        self._first_largest = ready.second
        if ready.first > limits.memory_limit:
            self.end()
            used, limit = memory_text(ready.first), memory_text(limits.memory_limit)
            raise UnitError(
                unit,
                f"its process uses {used} before the FMU is loaded, more than its limit of {limit}",
                remedy="raise isolation.memory_limit",
            )

    @property
    def has_ended(self) -> bool:
        """Whether the process is gone."""
        return self._is_reaped

    def _start(self, folder: str) -> None:
        requests, replies, output = os.pipe(), os.pipe(), os.pipe()
        theirs = requests[0], replies[1], self.memory
        arguments = ", ".join(map(repr, (*theirs, os.getpid(), folder)))
        # -u: what an FMU prints, in C as well, is in the pipe before it crashes.
        command = [sys.executable, "-u", "-c", _BOOT.format(path=_import_path(), arguments=arguments)]
        try:
            # A process group of its own: Ctrl-C in the terminal does not reach it, and all its children end with it.
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=output[1],
                stderr=output[1],
                pass_fds=theirs,
                process_group=0,
                env={"OPENBLAS_NUM_THREADS": "1", **os.environ},
            )
        except OSError as error:
            for descriptor in (*requests, *replies, *output, self.memory):
                os.close(descriptor)
            raise UnitError(self.unit, f"its process cannot be started: {error}") from error
        for descriptor in (requests[0], replies[1], output[1]):
            os.close(descriptor)
        ended = os.pidfd_open(self._process.pid) if hasattr(os, "pidfd_open") else None
        self._channel = Channel(replies[0], requests[1], output[0], ended)

    def send(self, frame: Frame, doing: str, time: int | None) -> None:
        """Send a request; see `ask`."""
        if self.failure:
            raise UnitError(self.unit, f"its process has ended: {self.failure}", time)
        try:
            self._channel.send(frame, self.limits.step_limit)
        except Closed:
            raise self._died(doing, time) from None
        except TimeoutError:
            raise self._timed_out(doing, time, self.limits.step_limit) from None

    def receive(self, doing: str, time: int | None) -> Frame:
        """Wait for the reply; see `ask`."""
        return self._receive(doing, time, self.limits.step_limit)

    def ask(self, frame: Frame, doing: str, time: int | None) -> Frame:
        """Send a request and wait for its reply.

        Args:
            frame: The request.
            doing: What the unit does then, for messages.
            time: Simulated time [ns], where known.

        Raises:
            InputError: The unit refuses something that a user gave.
            UnitError: It cannot go on, its process has ended, or it did not answer in time.
        """
        self.send(frame, doing, time)
        return self.receive(doing, time)

    def _receive(self, doing: str, time: int | None, limit: float) -> Frame:
        try:
            reply = self._channel.receive(limit)
        except Closed:
            raise self._died(doing, time) from None
        except TimeoutError:
            raise self._timed_out(doing, time, limit) from None
        except Exception as error:
            self.failure = f"its process sent something unreadable ({type(error).__name__}: {error})"
            self.end()
            raise UnitError(self.unit, self.failure, time) from error
        except BaseException:  # the user's second Ctrl-C: a reply may still come, so no request can follow
            self.failure = "it was interrupted"
            self.end()
            raise
        if reply.kind is Kind.FAILED:
            raise self._refused(reply.payload, time)
        return reply

    def _refused(self, given: dict[str, Any], time: int | None) -> InputError | UnitError:
        addition = memory_used(self.header.memory, self.limits)
        if "unit" not in given and "problem" not in given:  # not an error of a unit: its traceback tells
            while self._channel.keep_output():
                pass
            addition += last_lines(self._channel.said)
        return raised(given, self.unit, time, addition)

    def _died(self, doing: str, time: int | None) -> UnitError:
        function = self.header.function
        self._wait_until_dead()
        self.end()
        self.failure = Ending(self._status, function, doing, self._largest, self._channel.said).text(self.limits)
        return UnitError(self.unit, self.failure, time)

    def _timed_out(self, doing: str, time: int | None, limit: float) -> UnitError:
        function = self.header.function
        self.end()
        what = f"{function or doing} did not return within {limit:g} s"
        self.failure = what + last_lines(self._channel.said)
        return UnitError(self.unit, self.failure, time, "raise isolation.step_limit if it needs longer")

    def _wait_until_dead(self) -> None:
        """Wait for a process that is about to end, without yet taking its status."""
        deadline = clock.perf_counter() + _END_LIMIT
        with contextlib.suppress(ChildProcessError):
            while clock.perf_counter() < deadline:
                if os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
                    return
                clock.sleep(1e-3)

    def finish(self) -> None:
        """End after the unit was terminated: the process is about to exit by itself."""
        self._wait_until_dead()
        self.end()

    def end(self) -> None:
        """Kill what is left of the process and of the processes that it started; safe to call twice."""
        if self._is_reaped:
            return
        self._is_reaped = True
        self.failure = self.failure or "it was terminated"
        self._largest = self.header.memory
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        try:
            _, self._status, usage = os.wait4(self._process.pid, 0)
            largest = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
            # This figure begins with the size of the simulation itself, of which the process was once a copy.
            if largest > self._first_largest:
                self._largest = max(self._largest, largest)
        except ChildProcessError:  # a signal handler of somebody else has waited for it
            self._status = None
        self._process.returncode = 0 if self._status is None else os.waitstatus_to_exitcode(self._status)
        while self._channel.keep_output():
            pass
        self._channel.close()
        self.header.close()
        os.close(self.memory)


def _import_path() -> list[str]:
    """Where this process imports from, so that the other one imports the same."""
    root = str(Path(__file__).resolve().parents[2])
    return [entry or os.getcwd() for entry in sys.path] + [root]
