"""PyFMI's Master: Jacobi with a fixed step; results kept by its own handlers."""

from __future__ import annotations

import os
from time import perf_counter
from typing import Any

from pyfmi import load_fmu
from pyfmi.master import Master

from benchmarks.peers.job import Answer, Job, answer, written


def run(job: Job, **more: Any) -> Answer:
    """Loading is apart; the wall time is that of `simulate` less one of a single step.

    Args:
        job: What to run.
        more: Options of its master.
    """
    os.chdir(job.folder)  # its logs and results go to the working folder
    loading = _simulate(job, 1, more)[0]
    seconds, end, values = _simulate(job, job.steps, more)
    return Answer(seconds - loading, end, values, written(job.folder) if job.csv else 0)


def _simulate(job: Job, steps: int, more: dict[str, Any]) -> tuple[float, float, list[float]]:
    system = job.wired
    models = {name: load_fmu(str(system.fmu(name, job.version)), log_level=0) for name in system.components}
    for (name, variable), value in system.start.items():
        models[name].set(variable, value)
    wires = [(models[c.source], c.output, models[c.target], c.input) for c in system.connections]
    master = Master(list(models.values()), wires)
    options = master.simulate_options()
    options["step_size"] = job.step
    options["result_handling"] = "csv" if job.csv else "memory"
    # Without recording it keeps no variable: a filter that no name matches is its way to say so.
    kept = {name: [v for n, v in system.outputs if n == name and job.csv] for name in models}
    options["filter"] = {models[name]: names or "none" for name, names in kept.items()}
    options.update(more)
    begin = perf_counter()
    master.simulate(start_time=0.0, final_time=round(steps * job.step, 9), options=options)
    seconds = perf_counter() - begin
    values = [float(models[name].get(variable)[0]) for name, variable in system.outputs]
    return seconds, float(next(iter(models.values())).time), values


if __name__ == "__main__":
    answer(run)
