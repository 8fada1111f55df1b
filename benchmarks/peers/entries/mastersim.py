"""MasterSim's command-line solver: Gauss-Jacobi with a fixed step; the program is named by MASTERSIM."""

from __future__ import annotations

import csv
import os
import subprocess

from benchmarks.peers.job import Answer, Job, answer, written

#: Without CSV it still writes the first and the last row.
PROJECT = """tStart 0 s
tEnd {stop!r} s
hMax {step!r} s
hMin 1e-9 s
hFallBackLimit 1e-10 s
hStart {step!r} s
hOutputMin {output!r} s
outputTimeUnit s
adjustStepSize no
preventOversteppingOfEndTime yes
absTol 1e-6
relTol 1e-6
MasterMode GAUSS_JACOBI
ErrorControlMode NONE
maxIterations 1
writeInternalVariables no

"""


def run(job: Job) -> Answer:
    """The wall time is the one in its own summary."""
    system = job.wired
    lines = [f'simulator 0 0 {name} #000000 "{system.fmu(name, job.version)}"' for name in system.components]
    lines += [f"graph {c.source}.{c.output} {c.target}.{c.input}" for c in system.connections]
    lines += [f"parameter {n}.{v} {value!r}" for (n, v), value in system.start.items()]
    output = job.step if job.csv else job.stop
    project = job.folder / "job.msim"
    project.write_text(PROJECT.format(stop=job.stop, step=job.step, output=output) + "\n".join(lines) + "\n")
    subprocess.run([os.environ["MASTERSIM"], "--verbosity-level=0", "-x", project], check=True,
                   stdout=subprocess.DEVNULL)  # fmt: skip
    summary = dict(line.split("=", 1) for line in (job.folder / "job/log/summary.txt").read_text().split())
    with (job.folder / "job/results/values.csv").open() as file:
        header, *rows = csv.reader(file, delimiter="\t")
    names = [title.split(" ")[0] for title in header]
    last = [float(text) for text in rows[-1]]
    values = [last[names.index(f"{n}.{v}")] for n, v in system.outputs]
    results = written(job.folder / "job/results") if job.csv else 0
    return Answer(float(summary["WallClockTime"]), last[0], values, results)


if __name__ == "__main__":
    answer(run)
