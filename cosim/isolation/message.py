"""Requests and replies between the simulation and the process of an isolated unit.

One frame is a header of 25 bytes, in one write to a pipe, with a pickled payload where there is more to say. There is
never more than one request under way, so whatever can be read belongs to one frame.
"""

from __future__ import annotations

import os
import pickle
import select
import struct
import time as clock
from enum import IntEnum
from typing import Any, NamedTuple

from cosim.unit.errors import InputError
from cosim.unit.protocol import StepStatus, UnitError

#: How long a reader asks again and again before it sleeps [s]. Waking up an idle core costs 25 us on a virtual machine,
#: more than what a small FMU computes. A reader whose last wait was long sleeps at once: giving way again and again
#: would cost it its turn on a busy machine.
PATIENCE = 50e-6

#: A step's status travels as its place in this list.
STATUSES = list(StepStatus)

_HEADER = struct.Struct("<Bqqq")
_CHUNK = 1 << 16
_give_way = getattr(os, "sched_yield", lambda: clock.sleep(0))


class Kind(IntEnum):
    """What a frame says; the first ones are the replies. LOAD is the first request, TERMINATE the last."""

    READY = 0
    DONE = 1
    FAILED = 2
    CONSTRUCT = 3
    INITIALISE = 4
    EXIT_INITIALISATION = 5
    REFRESH = 6
    DO_STEP = 7
    FETCH = 8
    SAVE = 9
    RESTORE = 10
    RELEASE = 11
    CHECKPOINT = 12
    RESUME = 13
    TERMINATE = 14
    LOAD = 15


_KINDS = list(Kind)


class Frame(NamedTuple):
    """One request or reply.

    Args:
        kind: What it says.
        first: A number, mostly simulated time [ns].
        second: Another, mostly the length of a step [ns].
        payload: Anything else.
    """

    kind: Kind
    first: int = 0
    second: int = 0
    payload: Any = None


class Closed(Exception):
    """The other process has closed its end: it has ended."""


class Channel:
    """One end of the connection.

    Args:
        read: Descriptor of the pipe that is read.
        write: Descriptor of the pipe that is written.
        output: Descriptor of a pipe whose content is kept as `said` while waiting; None: there is none.
        ended: Descriptor that becomes readable when the other process ends; None: only the closed pipe tells, which a
            process that the other one has started may keep open.
    """

    #: Bytes of `output` that are kept: its last lines.
    KEPT = 8192

    def __init__(self, read: int, write: int, output: int | None = None, ended: int | None = None) -> None:
        self._read, self._write, self._output, self._ended = read, write, output, ended
        self.said = b""
        self._is_patient = True
        self._poll = select.poll()
        for descriptor in _present(read, output, ended):
            self._poll.register(descriptor, select.POLLIN)
        for descriptor in _present(read, write, output):
            os.set_blocking(descriptor, False)
        self._writable = select.poll()
        self._writable.register(write, select.POLLOUT)

    def send(self, frame: Frame, timeout: float | None = None) -> None:
        """Write a frame.

        Raises:
            Closed: The other process has ended.
            TimeoutError: It reads nothing for `timeout` [s].
        """
        payload = b"" if frame.payload is None else pickle.dumps(frame.payload, pickle.HIGHEST_PROTOCOL)
        data = _HEADER.pack(frame.kind, frame.first, frame.second, len(payload)) + payload
        while data:
            try:
                data = data[os.write(self._write, data) :]
            except BlockingIOError:
                if not self._writable.poll(None if timeout is None else 1e3 * timeout):
                    raise TimeoutError from None
            except BrokenPipeError as error:
                raise Closed from error

    def receive(self, timeout: float | None = None) -> Frame:
        """Wait for a frame and read it.

        Raises:
            Closed: The other process has ended.
            TimeoutError: Nothing came within `timeout` [s].
            Exception: What came is no frame (pickle raises almost anything).
        """
        deadline = None if timeout is None else clock.perf_counter() + timeout
        data = self._read_some(deadline)
        kind, first, second, length = _HEADER.unpack_from(data)
        if not length:
            return Frame(_KINDS[kind], first, second)
        parts, missing = [data], _HEADER.size + length - len(data)
        while missing > 0:
            parts.append(self._read_some(deadline))
            missing -= len(parts[-1])
        return Frame(_KINDS[kind], first, second, pickle.loads(b"".join(parts)[_HEADER.size :]))

    def _read_some(self, deadline: float | None) -> bytes:
        while self._read not in (ready := self._wait(deadline)):
            if self._ended in ready:
                raise Closed
            # A flood of output must not put off the end; a reply that is there counts, however late it is read.
            if not ready or (deadline is not None and clock.perf_counter() > deadline):
                raise TimeoutError
            self.keep_output()
        data = os.read(self._read, _CHUNK)
        if not data:
            raise Closed
        return data

    def _wait(self, deadline: float | None) -> list[int]:
        """Descriptors that can be read; none if the deadline has passed."""
        poll, now = self._poll.poll, clock.perf_counter
        begin = now()
        while self._is_patient and now() - begin < PATIENCE:
            if ready := poll(0):
                break
            _give_way()
        else:
            ready = poll(None if deadline is None else max(0.0, 1e3 * (deadline - begin)))
            self._is_patient = now() - begin < 2 * PATIENCE
        return [descriptor for descriptor, _ in ready]

    def keep_output(self) -> bool:
        """Keep the last lines of what has been written to `output`; returns whether there was anything."""
        if self._output is None:
            return False
        try:
            data = os.read(self._output, _CHUNK)
        except BlockingIOError:
            return False
        if not data:
            self._poll.unregister(self._output)
            os.close(self._output)
            self._output = None
            return False
        self.said = (self.said + data)[-self.KEPT :]
        return True

    def close(self) -> None:
        """Close all descriptors."""
        for descriptor in _present(self._read, self._write, self._output, self._ended):
            os.close(descriptor)
        self._output = self._ended = None


def _present(*descriptors: int | None) -> list[int]:
    return [d for d in descriptors if d is not None]


def failure(error: Exception) -> dict[str, Any]:
    """An error as plain data: exceptions with arguments of their own do not survive pickling."""
    if isinstance(error, InputError):
        return {"source": error.source, "key": error.key, "problem": error.problem, "remedy": error.remedy}
    if isinstance(error, UnitError):
        return {"unit": error.unit, "what": error.what, "time": error.time, "remedy": error.remedy}
    return {"what": f"{type(error).__name__}: {error}"}


def raised(given: dict[str, Any], unit: str, time: int | None, addition: str) -> InputError | UnitError:
    """The error that `failure` described.

    Args:
        given: Result of `failure`.
        unit: Name of the unit, where the error does not say.
        time: Simulated time [ns], where it does not say.
        addition: Appended to the failure.
    """
    if "problem" in given:
        return InputError(given["source"], given["key"], given["problem"] + addition, given["remedy"])
    moment = given.get("time")
    what = given["what"] + addition
    return UnitError(given.get("unit", unit), what, time if moment is None else moment, given.get("remedy", ""))
