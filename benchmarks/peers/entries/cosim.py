"""This project: a scenario of plain FMU components, run as a user runs it.

Recorded results are a run folder with all outputs as NetCDF and as CSV, written at the end, as `cosim run` writes it.
"""

from __future__ import annotations

from time import perf_counter

from benchmarks.models import cosim_run
from benchmarks.peers.job import Answer, Job, answer, written
from cosim.run import Progress, record


def run(job: Job) -> Answer:
    """The run's own clock says when its first step began; where results are recorded, their file is counted too."""
    system = job.wired
    out = job.folder / "run" if job.csv else None
    scenario = cosim_run.load(system, job.version, job.step, output_step=job.step if job.csv else None)
    begins: list[float] = []
    loops: list[float] = []

    def note(progress: Progress) -> None:
        begins.append(perf_counter() - progress.elapsed)
        loops.append(progress.elapsed)

    trace = record(scenario, out, on_progress=note).trace
    seconds = perf_counter() - begins[-1] if job.csv else loops[-1]
    values = [float(trace.rows[f"{name}.{variable}"][trace.count - 1]) for name, variable in system.outputs]
    return Answer(seconds, float(trace.moments[-1]), values, written(out) if out else 0)


if __name__ == "__main__":
    answer(run)
