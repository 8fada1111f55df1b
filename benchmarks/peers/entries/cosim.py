"""This project: a scenario of plain FMU components, run as a user runs it.

Recorded results are a NetCDF file in a run folder; it writes no CSV while it runs.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from time import perf_counter

from benchmarks.models import cosim_run
from benchmarks.peers.job import Answer, Job, answer, written
from cosim.run import run as run_scenario


def _wall_time(job: Job, folder: Path | None) -> tuple[float, float, list[float]]:
    system = job.wired
    scenario = cosim_run.load(system, job.version, job.step, output_step=job.step if job.csv else None)
    begin = perf_counter()
    result = run_scenario(scenario, folder)
    seconds = perf_counter() - begin
    values = [float(result[f"{name}.{variable}"].values[-1]) for name, variable in system.outputs]
    return seconds, float(result["time"].values[-1]), values


def run(job: Job) -> Answer:
    """Loading is taken off by a run of one step before."""
    out = job.folder / "run" if job.csv else None
    loading = _wall_time(replace(job, steps=1), job.folder / "one" if job.csv else None)[0]
    seconds, end, values = _wall_time(job, out)
    return Answer(seconds - loading, end, values, written(out) if out else 0)


if __name__ == "__main__":
    answer(run)
