"""libcosim: import of SSP 1.0 and 2.0, with a parameter set."""

from __future__ import annotations

import sys
from pathlib import Path

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver

from benchmarks.peers.probes.finding import report
from benchmarks.peers.probes.ssp_file import write

#: Value references in the order of model.toml: height and mass of the chassis.
HEIGHT, MASS = 3, 5


def one(work: Path, version: str) -> str:
    """Run one package; a failure ends the interpreter in this library, so each version has a process of its own."""
    execution = CosimExecution.from_ssp_file(ssp_path=str(write(work, version)[0]), step_size=1e6)
    last = CosimObserver.create_last_value()
    execution.add_observer(last)
    execution.simulate_until(target_time=1_500_000_000)
    index = execution.slave_index_from_instance_name("chassis")
    height, mass = last.last_real_values(index, [HEIGHT, MASS])
    return f"SSP {version}: z = {height:.6f} m, mass {mass:g} kg"


if __name__ == "__main__":
    report(lambda work: one(work, sys.argv[1]))
