"""MasterSim's command-line solver: Gauss-Jacobi with a fixed step; the program is named by MASTERSIM."""

from __future__ import annotations

import csv
import os
import subprocess
from dataclasses import asdict, dataclass

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
adjustStepSize {adjust}
preventOversteppingOfEndTime yes
absTol {tolerance!r}
relTol {tolerance!r}
MasterMode {mode}
ErrorControlMode {control}
maxIterations {iterations}
writeInternalVariables no

"""


@dataclass(frozen=True)
class Method:
    """What its project file calls the algorithm."""

    mode: str = "GAUSS_JACOBI"
    control: str = "NONE"
    iterations: int = 1
    adjust: str = "no"
    tolerance: float = 1e-6


def run(job: Job) -> Answer:
    """The wall time is the one in its own summary."""
    return run_with(job, Method())


def run_with(job: Job, method: Method) -> Answer:
    """Run with another algorithm."""
    system = job.wired
    lines = [f'simulator 0 0 {name} #000000 "{system.fmu(name, job.version)}"' for name in system.components]
    lines += [f"graph {c.source}.{c.output} {c.target}.{c.input}" for c in system.connections]
    lines += [f"parameter {n}.{v} {value!r}" for (n, v), value in system.start.items()]
    settings = PROJECT.format(stop=job.stop, step=job.step, output=job.step if job.csv else job.stop, **asdict(method))
    (job.folder / "job.msim").write_text(settings + "\n".join(lines) + "\n")
    program = os.environ["MASTERSIM"]
    subprocess.run(
        [program, "--verbosity-level=0", "-x", job.folder / "job.msim"], check=True, stdout=subprocess.DEVNULL
    )
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
