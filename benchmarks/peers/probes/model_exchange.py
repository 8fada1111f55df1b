"""Does a tool load an FMU that offers Model Exchange alone? `python -m ... TOOL FMI_VERSION`."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

from benchmarks.peers.probes.finding import report
from benchmarks.peers.probes.model_exchange_fmu import write


def ecospy(path: Path, work: Path) -> str:
    """ecos."""
    from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

    del work
    EcosLib.set_log_level("off")
    with EcosSimulationStructure() as structure:
        structure.add_model("unit", str(path))
        with EcosSimulation(structure=structure, step_size=0.01) as simulation:
            simulation.init()
            return f"runs; time {simulation.step(2):g} s"


def libcosimpy(path: Path, work: Path) -> str:
    """libcosim."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimSlave import CosimLocalSlave

    del work
    execution = CosimExecution.from_step_size(step_size=1e7)
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="unit"))
    is_done = execution.step(2)
    return f"index {index}, step returns {is_done}, time {execution.status().current_time} ns"


def cofmupy(path: Path, work: Path) -> str:
    """CoFmuPy."""
    from cofmupy import Coordinator

    config = {
        "root": "",
        "cosim_method": "jacobi",
        "iterative": False,
        "edge_sep": " -> ",
        "connections": [],
        "fmus": [{"id": "unit", "name": "unit", "path": str(path), "initialization": {}}],
    }
    (work / "config.json").write_text(json.dumps(config))
    coordinator = Coordinator()
    coordinator.start(str(work / "config.json"))
    coordinator.do_step(0.01)
    return "runs"


def mastersim(path: Path, work: Path) -> str:
    """MasterSim."""
    (work / "job.msim").write_text(
        "tStart 0 s\ntEnd 0.1 s\nhMax 0.01 s\nhStart 0.01 s\nhOutputMin 0.01 s\nadjustStepSize no\n"
        f'MasterMode GAUSS_JACOBI\nErrorControlMode NONE\nmaxIterations 1\n\nsimulator 0 0 unit #000000 "{path}"\n'
    )
    done = subprocess.run(
        [os.environ["MASTERSIM"], "--verbosity-level=1", "-x", work / "job.msim"],
        capture_output=True,
        text=True,
        check=False,
    )
    text = re.sub(r"\x1b\[[0-9;]*m", "", done.stdout + done.stderr)
    reasons = [line.strip() for line in text.splitlines() if "xpected" in line]
    return f"exit code {done.returncode}; {reasons[-1] if reasons else 'no reason given'}"


def fmpy(path: Path, work: Path) -> str:
    """FMPy's simulate_fmu, which takes one FMU."""
    from fmpy import simulate_fmu

    del work
    result = simulate_fmu(str(path), stop_time=0.1, output_interval=0.01)
    return f"runs alone; time {float(result['time'][-1]):g} s"


if __name__ == "__main__":
    tool, version = sys.argv[1:3]
    report(lambda work: globals()[tool](write(work, int(version)), work))
