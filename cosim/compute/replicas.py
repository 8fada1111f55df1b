"""Processes that each hold a copy of what answers quick questions: milliseconds each, thousands in a row.

A Dask cluster spends milliseconds on a task; here a question travels through a socket in a tenth of one. Copies are
made while this process goes on by itself, so that nothing waits for them, and answers do not depend on who gave them.
"""

from __future__ import annotations

import json
import os
import pickle
import socket
import subprocess
import sys
import time
import weakref
from collections import deque
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from typing import Any, Generic, TypeVar

Question = TypeVar("Question")
Answer = TypeVar("Answer")

#: Seconds of answers after which copies are made: what ends sooner needs none.
WORTH = 3.0
#: Seconds of answers that are asked for at once, so that their way there and back costs little.
AT_ONCE = 0.02
#: Seconds between two looks whether a process that is waited for still lives.
PATIENCE = 1.0
_PROGRAM = "import json, sys; sys.path[:] = json.loads(sys.argv[2]); from cosim.compute import replica; replica.main()"


class _Replica:
    """One process: it is begun, at some time ready, and asked one list of questions at a time."""

    def __init__(self, make: Callable[[Any], Callable[[Any], Any]], given: Any) -> None:
        here, there = socket.socketpair()
        with there:
            self.process = subprocess.Popen(
                [sys.executable, "-c", _PROGRAM, str(there.fileno()), json.dumps(sys.path)],
                pass_fds=[there.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        self.line = Connection(here.detach())
        self.is_ready = False
        #: Numbers of the questions that it was asked.
        self.asked: list[int] = []
        self.line.send_bytes(pickle.dumps((make, given)))

    def look(self) -> bool:
        """Whether it can be asked."""
        if not self.is_ready and self.line.poll():
            self.line.recv()
            self.is_ready = True
        return self.is_ready and not self.asked

    def end(self) -> None:
        """End the process, whatever it does; safe to call twice."""
        self.line.close()
        self.process.kill()
        self.process.wait()


class Replicas(Generic[Question, Answer]):
    """Answers lists of questions, some of them in other processes.

    Args:
        make: Function of a module; from `given` it makes what answers a question, in each process.
        given: What it needs; pickled.
        here: Answers a question in this process.
        count: Processes beside this one; they are begun after `WORTH` seconds of answers.
    """

    def __init__(
        self,
        make: Callable[[Any], Callable[[Question], Answer]],
        given: Any,
        here: Callable[[Question], Answer],
        count: int,
    ) -> None:
        self._make, self._given, self._here = make, given, here
        self._left = count if os.name == "posix" and sys.executable else 0
        self._spent, self._answered = 0.0, 0
        self._replicas: list[_Replica] = []
        weakref.finalize(self, _end_all, self._replicas)

    def answers(self, questions: Sequence[Question]) -> list[Answer]:
        """Answers in the order of the questions.

        Raises:
            Exception: What answering a question raises.
        """
        found: list[Any] = [None] * len(questions)
        todo = deque(range(len(questions)))
        try:
            while todo:
                self._ask(questions, todo)
                if todo:
                    number = todo.pop()
                    begin = time.perf_counter()
                    found[number] = self._here(questions[number])
                    self._spent += time.perf_counter() - begin
                    self._answered += 1
                for replica in [r for r in self._replicas if r.asked]:
                    self._take(replica, found, todo, is_patient=not todo)
        except BaseException:  # answers that were asked for and not taken would be taken for others
            self.close()
            raise
        self._begin()
        return found

    def close(self) -> None:
        """End the processes; this one answers alone from then on."""
        self._left = 0
        _end_all(self._replicas)

    def _begin(self) -> None:
        """Begin the processes, where answers have taken long enough."""
        if not self._left or self._spent < WORTH:
            return
        try:
            self._replicas += [_Replica(self._make, self._given) for _ in range(self._left)]
        except (OSError, pickle.PicklingError, AttributeError, TypeError):  # no process, or nothing that travels
            _end_all(self._replicas)
        self._left = 0

    def _ask(self, questions: Sequence[Question], todo: deque[int]) -> None:
        """Hand questions to processes that are free; at least one stays here."""
        for replica in list(self._replicas):
            try:
                count = min(self._share(len(todo)), len(todo) - 1)
                if count > 0 and replica.look():
                    replica.asked = [todo.popleft() for _ in range(count)]
                    replica.line.send([questions[n] for n in replica.asked])
            except (OSError, EOFError):
                self._lose(replica, todo)

    def _share(self, count: int) -> int:
        """How many of so many questions one process is asked at once."""
        quick = int(AT_ONCE / max(self._spent / max(self._answered, 1), 1e-9))
        return max(1, min(quick, count // (2 * (len(self._replicas) + 1))))

    def _take(self, replica: _Replica, found: list[Any], todo: deque[int], is_patient: bool) -> None:
        """Take answers that are there, or wait for them; what a lost process was asked is to be done again."""
        try:
            while not replica.line.poll(PATIENCE if is_patient else 0.0):
                if replica.process.poll() is not None:
                    raise EOFError
                if not is_patient:
                    return
            answers = replica.line.recv()
        except (OSError, EOFError):
            self._lose(replica, todo)
            return
        if answers is None:  # it failed there: here the reason is raised
            todo.extend(replica.asked)
        else:
            for number, answer in zip(replica.asked, answers):
                found[number] = answer
        replica.asked = []

    def _lose(self, replica: _Replica, todo: deque[int]) -> None:
        todo.extend(replica.asked)
        replica.end()
        self._replicas.remove(replica)


def _end_all(replicas: list[_Replica]) -> None:
    while replicas:
        replicas.pop().end()
