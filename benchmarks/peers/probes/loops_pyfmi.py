"""PyFMI's Master: is an algebraic loop solved, at the start and during the run?"""

from __future__ import annotations

from pathlib import Path

from benchmarks.peers.entries.pyfmi import run
from benchmarks.peers.job import Job
from benchmarks.peers.probes.finding import report


def probe(work: Path) -> str:
    """The solution is y = 2; what is there after one macro-step."""
    found = []
    for options in ({}, {"block_initialization": True}, {"linear_correction": True}):
        try:
            found.append(f"{options}: {run(Job('loop', 2, 1, 1e-3, False, str(work)), **options).values}")
        except Exception as error:  # the finding is that it does not run
            found.append(f"{options}: {type(error).__name__}: {error}"[:140])
    return "; ".join(found)


if __name__ == "__main__":
    report(probe)
