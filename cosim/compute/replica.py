"""What a process of `cosim.compute.replicas` does: make the copy, answer questions until the line is closed."""

from __future__ import annotations

import contextlib
import pickle
import signal
import sys
from multiprocessing.connection import Connection


def main() -> None:
    """Answer lists of questions; None for a list of which one raised an error."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal sends Ctrl-C to all; the first process ends this one
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
