"""CoFmuPy: its coordinator with the Jacobi master; results by its own list and CSV writer."""

from __future__ import annotations

import json
from time import perf_counter
from typing import Any

from cofmupy import Coordinator

from benchmarks.peers.job import Answer, Job, answer, written


def configuration(job: Job) -> dict[str, Any]:
    """What its JSON file holds."""
    system = job.wired
    start: dict[str, dict[str, float]] = {name: {} for name in system.components}
    for (name, variable), value in system.start.items():
        start[name][variable] = value
    fmus = [
        {"id": name, "name": name, "path": str(system.fmu(name, job.version)), "initialization": values}
        for name, values in start.items()
    ]
    wires = [
        {
            "source": {"id": c.source, "variable": c.output, "unit": ""},
            "target": {"id": c.target, "variable": c.input, "unit": ""},
        }
        for c in system.connections
    ]
    return {
        "root": "",
        "loop_solver": "jacobi",
        "cosim_method": "jacobi",
        "iterative": False,
        "edge_sep": " -> ",
        "fmus": fmus,
        "connections": wires,
    }


def run(job: Job) -> Answer:
    """Without CSV it still keeps every output of every step in lists: there is no switch for that."""
    system = job.wired
    file = job.folder / "config.json"
    file.write_text(json.dumps(configuration(job)))
    coordinator = Coordinator()
    coordinator.start(str(file))
    begin = perf_counter()
    coordinator.run_simulation(step_size=job.step, end_time=job.stop)
    if job.csv:
        coordinator.save_results(str(job.folder / "out.csv"))
    seconds = perf_counter() - begin
    values = [float(coordinator.get_variable(output)[0]) for output in system.outputs]
    return Answer(seconds, float(coordinator.master.current_time), values, written(job.folder) if job.csv else 0)


if __name__ == "__main__":
    answer(run)
