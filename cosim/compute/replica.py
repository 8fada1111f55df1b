"""What a process of `cosim.compute.replicas` does: make the copy, answer questions until the line is closed."""

from __future__ import annotations

import contextlib
import pickle
import signal
import sys
from multiprocessing.connection import Connection


def main() -> None:
    """Answer lists of questions; None for a list of which one raised an error."""
    for number in (signal.SIGINT, signal.SIGTERM):  # they go to all of a group; the first process ends this one
        signal.signal(number, signal.SIG_IGN)
    line = Connection(int(sys.argv[1]))
    with contextlib.suppress(EOFError, OSError):
        make, given = pickle.loads(line.recv_bytes())
        answer = make(given)
        line.send(True)
        while True:
            questions = line.recv()
            try:
                answers = [answer(question) for question in questions]
            except Exception:  # the first process asks itself, and sees why
                answers = None
            line.send(answers)
