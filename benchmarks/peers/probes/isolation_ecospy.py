"""ecos: an FMU run through proxyfmu (a process per FMU), named on the command line."""

from __future__ import annotations

import csv
import os
import shutil
import sys
from pathlib import Path

import ecospy
from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """The crasher aborts at 0.5 s; step 1 ms. What does the caller see, and what is in the CSV?"""
    # The wheel ships proxyfmu without the permission to run it: a copy gets it.
    program = work / "proxyfmu"
    shutil.copy(next(Path(ecospy.__file__).parent.rglob("proxyfmu")), program)
    program.chmod(0o755)
    os.environ["PATH"] = f"{work}{os.pathsep}{os.environ['PATH']}"
    EcosLib.set_log_level("warn")
    with EcosSimulationStructure() as structure:
        structure.add_model("first", str(fmu("feedthrough_fmi2")))
        structure.add_model("second", f"proxyfmu://localhost?file={fmu(sys.argv[1])}")
        structure.make_real_connection("first::y", "second::u")
        with EcosSimulation(structure=structure, step_size=1e-3) as simulation:
            simulation.add_csv_writer(str(work / "out.csv"), identifiers=["second::y"])
            simulation.init()
            problem = "no error"
            try:
                simulation.step_until(1.0)
                problem = f"no error, last error text {EcosLib.get_last_error()!r}"
            except Exception as error:  # how it fails is the finding
                problem = f"{type(error).__name__}: {error}"
            reached = simulation.get_time()
    with (work / "out.csv").open() as file:
        rows = sum(1 for _ in csv.reader(file)) - 1
    return f"caller sees: {problem[:160]}; time then {reached:g} s; {rows} rows in the CSV"


if __name__ == "__main__":
    report(probe)
