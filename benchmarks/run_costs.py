"""What a run costs beside its macro-steps: recording, checkpoints, memory of long runs, start of many FMUs.

`python -m benchmarks.run_costs [repetitions]` writes benchmarks/results/run_costs.md. Every measurement is a process of
its own; the cases of one table are interleaved.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time as clock
from pathlib import Path
from typing import Any

from benchmarks.machine import heading, results_folder
from benchmarks.models.build import build
from benchmarks.models.systems import FMUS
from cosim.run import Progress, record
from cosim.scenario import parse_scenario

#: Case to what is run: FMUs, macro-steps, macro-step [ms], output step in macro-steps, whether there is a folder.
CASES: dict[str, tuple[int, int, int, int, bool]] = {
    "two FMUs, output each second, macro-step 1 ms": (2, 1_000_000, 1, 1000, True),
    "two FMUs, output each second, macro-step 100 ms": (2, 1_000_000, 100, 10, True),
    "two FMUs, every step recorded, 1e5": (2, 100_000, 1, 1, True),
    "two FMUs, every step recorded, 1e6": (2, 1_000_000, 1, 1, True),
    "two FMUs, every step recorded, 1e7": (2, 10_000_000, 1, 1, True),
    "2 FMUs": (2, 100_000, 1, 100_000, False),
    "100 FMUs": (100, 10_000, 1, 10_000, False),
    "300 FMUs": (300, 4_000, 1, 4_000, False),
    "1000 FMUs": (1000, 2_000, 1, 2_000, False),
}


def measure(case: str) -> dict[str, float]:
    """Times [s] and memory [MiB] of one run, in this process."""
    fmus, steps, step, outputs, has_folder = CASES[case]
    data = "\n".join(
        [
            f"title: costs\ntime: {{stop: {steps * step} ms, macro_step: {step} ms, output_step: {outputs * step} ms}}",
            "algorithm: {kind: gauss_seidel}\ncomponents:",
            *(
                f"  u{i}: {{kind: fmu, fmu: {FMUS}/feedthrough_fmi2.fmu, fmi: 2, start: {{u: 1.0}}}}"
                for i in range(fmus)
            ),
            "connections:",
            *(f"  - u{i}.y -> u{i + 1}.u" for i in range(fmus - 1)),
        ]
    )
    scenario = parse_scenario(data, Path("costs.yaml"))
    folder = Path(tempfile.mkdtemp())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found: list[Progress] = []
    begin = clock.perf_counter()
    record(scenario, folder / "run" if has_folder else None, on_progress=found.append)
    whole = clock.perf_counter() - begin
    shutil.rmtree(folder)
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    return {"whole": whole, "loop": found[-1].elapsed, "grown": grown}


def interleaved(repetitions: int) -> dict[str, list[dict[str, float]]]:
    """All cases in turn, `repetitions` times."""
    found: dict[str, list[dict[str, float]]] = {case: [] for case in CASES}
    for _ in range(repetitions):
        for case in CASES:
            done = subprocess.run(
                [sys.executable, "-m", "benchmarks.run_costs", "--case", case],
                capture_output=True,
                text=True,
                check=True,
            )
            found[case].append(json.loads(done.stdout.splitlines()[-1]))
    return found


def _row(case: str, results: list[dict[str, float]]) -> str:
    fmus, steps, *_, has_folder = CASES[case]
    middle = {key: statistics.median(r[key] for r in results) for key in results[0]}
    start = "" if has_folder else f"{1e3 * (middle['whole'] - middle['loop']) / fmus:.2f}"
    whole = f"{1e6 * middle['whole'] / steps:.2f}" if has_folder else ""
    loop = f"{1e6 * middle['loop'] / steps / fmus:.3f}"
    return f"| {case} | {steps:g} | {loop} | {whole} | {start} | {middle['grown']:.0f} |"


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table, or one measurement."""
    given: list[Any] = sys.argv[1:] if arguments is None else arguments
    if given[:1] == ["--case"]:
        print(json.dumps(measure(given[1])))
        return
    build()
    found = interleaved(int(given[0]) if given else 3)
    lines = [
        heading("Costs of a run", "python -m benchmarks.run_costs"),
        "Chained feedthrough FMUs (FMI 2.0) under gauss_seidel, median of interleaved repetitions, each a process.",
        "`whole`: from the scenario to the last byte, checkpoints and files included. `start`: assembling,",
        "initialising and ending, per FMU. Memory: what the process has grown by.",
        f"Load average of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores.\n",
        "| case | macro-steps | loop, us per step and FMU | whole, us per step | start, ms per FMU | memory, MiB |",
        "|" + 6 * "---|",
        *(_row(case, results) for case, results in found.items()),
    ]
    text = "\n".join(lines) + "\n"
    (results_folder() / "run_costs.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
