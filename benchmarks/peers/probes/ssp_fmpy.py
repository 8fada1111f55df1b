"""FMPy: import of SSP 1.0 and 2.0, with a parameter set."""

from __future__ import annotations

from pathlib import Path

from fmpy.ssp.simulation import simulate_ssp

from benchmarks.peers.probes.finding import report
from benchmarks.peers.probes.ssp_file import write


def probe(work: Path) -> str:
    """Height of the chassis after 1.5 s: 1.1362 m with the mass of the package, 1.1666 m with that of the FMU."""
    found = []
    for version in ("1.0", "2.0"):
        try:
            result = simulate_ssp(str(write(work, version)[1]), stop_time=1.5, step_size=1e-3)
            found.append(f"SSP {version}: z = {float(result['chassis.z'][-1]):.6f} m")
        except Exception as error:  # the finding is that it refuses
            found.append(f"SSP {version}: {type(error).__name__}: {' '.join(str(error).split())[:140]}")
    return "; ".join(found)


if __name__ == "__main__":
    report(probe)
