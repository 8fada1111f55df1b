"""MasterSim: error of its algorithms on the two-mass oscillator, step 1 ms, against the closed form."""

from __future__ import annotations

import math
from pathlib import Path

from benchmarks.peers.entries.mastersim import Method, run_with
from benchmarks.peers.job import Job
from benchmarks.peers.probes.finding import report

#: Displacements at 0.8 s: (cos(2 pi t) +- cos(6 pi t)) / 2.
LEFT, RIGHT = (0.5 * (math.cos(1.6 * math.pi) + sign * math.cos(4.8 * math.pi)) for sign in (1, -1))
METHODS = {
    "Jacobi": Method(),
    "Gauss-Seidel": Method(mode="GAUSS_SEIDEL"),
    "iterated Gauss-Seidel": Method(mode="GAUSS_SEIDEL", iterations=20),
    "step doubling, 1e-5": Method(
        mode="GAUSS_SEIDEL", control="STEP_DOUBLING", iterations=20, adjust="yes", tolerance=1e-5
    ),
}


def probe(work: Path) -> str:
    """Larger error of the two displacements at 0.8 s."""
    found = []
    for name, method in METHODS.items():
        folder = work / name.replace(" ", "_")
        folder.mkdir()
        try:
            values = run_with(Job("two_mass", 2, 800, 1e-3, False, str(folder)), method).values
            found.append(f"{name}: {max(abs(values[0] - LEFT), abs(values[2] - RIGHT)):.1e} m")
        except Exception as error:  # the finding is that it does not run
            found.append(f"{name}: {type(error).__name__}")
    return "; ".join(found)


if __name__ == "__main__":
    report(probe)
