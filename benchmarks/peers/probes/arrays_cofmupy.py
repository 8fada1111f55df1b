"""CoFmuPy: two FMI 3.0 FMUs, array connected to array."""

from __future__ import annotations

import json
from pathlib import Path

from cofmupy import Coordinator

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """Expected: second.y = (2, 4) for offset 1 in both; n is left at its start value 2."""
    config = {
        "root": "",
        "cosim_method": "jacobi",
        "iterative": False,
        "edge_sep": " -> ",
        "fmus": [
            {"id": n, "name": n, "path": str(fmu("vector_gain_fmi3")), "initialization": {"offset": 1.0}}
            for n in ("first", "second")
        ],
        "connections": [
            {
                "source": {"id": "first", "variable": "y", "unit": ""},
                "target": {"id": "second", "variable": "u", "unit": ""},
            }
        ],
    }
    (work / "config.json").write_text(json.dumps(config))
    coordinator = Coordinator()
    coordinator.start(str(work / "config.json"))
    for _ in range(3):
        coordinator.do_step(0.1)
    return f"y of the second array reads as {coordinator.get_variable(('second', 'y'))!r}; expected (2, 4)"


if __name__ == "__main__":
    report(probe)
