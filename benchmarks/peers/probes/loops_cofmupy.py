"""CoFmuPy: is an algebraic loop solved by its fixed-point initialisation and its iterative master?"""

from __future__ import annotations

import json
from pathlib import Path

from cofmupy import Coordinator

from benchmarks.peers.entries.cofmupy import configuration
from benchmarks.peers.job import Job
from benchmarks.peers.probes.finding import report


def probe(work: Path) -> str:
    """The solution is y = 2; what is there after one macro-step."""
    found = []
    for is_fixed_point, is_iterative in ((True, False), (False, True), (True, True)):
        config = {**configuration(Job("loop", 2, 1, 1e-3, False, str(work))), "iterative": is_iterative}
        (work / "config.json").write_text(json.dumps(config))
        coordinator = Coordinator()
        try:
            coordinator.start(str(work / "config.json"), fixed_point_init=is_fixed_point)
            coordinator.do_step(1e-3)
            value = f"{float(coordinator.get_variable(('second', 'y'))[0]):.6f}"
        except Exception as error:  # the finding is that it does not run
            value = f"{type(error).__name__}: {error}"[:120]
        found.append(f"fixed-point initialisation {is_fixed_point}, iterative {is_iterative}: y = {value}")
    return "; ".join(found)


if __name__ == "__main__":
    report(probe)
