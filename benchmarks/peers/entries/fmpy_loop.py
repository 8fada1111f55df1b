"""FMPy: a loop written by hand on its calls; CSV by Python's csv module."""

from __future__ import annotations

import csv
from time import perf_counter

from benchmarks.models.fmpy_loop import Loop
from benchmarks.peers.job import Answer, Job, answer


def run(job: Job) -> Answer:
    """Jacobi steps, time as index times step."""
    loop = Loop(job.wired, job.version)
    loop.initialise()
    step = job.step
    if not job.csv:
        begin = perf_counter()
        for index in range(job.steps):
            loop.step_jacobi(index * step, step)
        seconds = perf_counter() - begin
    else:
        with (job.folder / "out.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            begin = perf_counter()
            for index in range(job.steps):
                loop.step_jacobi(index * step, step)
                writer.writerow([(index + 1) * step, *(loop.get(*output) for output in job.wired.outputs)])
            file.flush()
            seconds = perf_counter() - begin
    values = [loop.get(*output) for output in job.wired.outputs]
    return Answer(seconds, job.steps * step, values)


if __name__ == "__main__":
    answer(run)
