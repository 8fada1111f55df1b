"""MasterSim: is an algebraic loop solved with its iterating algorithms?"""

from __future__ import annotations

from pathlib import Path

from benchmarks.peers.entries.mastersim import Method, run_with
from benchmarks.peers.job import Job
from benchmarks.peers.probes.finding import report


def probe(work: Path) -> str:
    """The solution is y = 2; what is there after one macro-step."""
    found = []
    for mode in ("GAUSS_JACOBI", "GAUSS_SEIDEL", "NEWTON"):
        folder = work / mode
        folder.mkdir()
        try:
            values = run_with(Job("loop", 2, 1, 1e-3, False, str(folder)), Method(mode=mode, iterations=50)).values
        except Exception as error:  # the finding is that it does not run
            values = [type(error).__name__]  # type: ignore[list-item]
        found.append(f"{mode}, 50 iterations: {values}")
    return "; ".join(found)


if __name__ == "__main__":
    report(probe)
