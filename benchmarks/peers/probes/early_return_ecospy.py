"""ecos: an FMI 3.0 FMU whose event lies inside a macro-step; is the event time hit?"""

from __future__ import annotations

import csv
from pathlib import Path

from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """The ground steps at 0.25 s, the macro-step is 0.1 s."""
    EcosLib.set_log_level("off")
    with EcosSimulationStructure() as structure:
        structure.add_model("ground", str(fmu("ground_fmi3")))
        structure.add_parameter_set("start", {"ground::step_time": 0.25})
        with EcosSimulation(structure=structure, step_size=0.1) as simulation:
            simulation.add_csv_writer(str(work / "out.csv"), identifiers=["ground::z"])
            simulation.init(parameter_set="start")
            simulation.step(5)
            simulation.terminate()
    with (work / "out.csv").open() as file:
        header, *rows = csv.reader(file)
        column = next(i for i, title in enumerate(header) if "time" in title.lower())
        times = [float(row[column]) for row in rows]
    return f"event at 0.25 s; communication points {[round(t, 6) for t in times]}"


if __name__ == "__main__":
    report(probe)
