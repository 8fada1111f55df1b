"""Cost of the loop itself: chained feedthrough FMUs, loop in Python and in C, with and without recording and CSV.

`python -m benchmarks.loop [repetitions]` writes benchmarks/results/loop.md.
"""

from __future__ import annotations

import itertools
import os
import statistics
import sys
import tempfile
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.machine import heading, results_folder
from benchmarks.models.build import build
from benchmarks.models.systems import FMUS
from cosim.algorithms.algorithm import Plain
from cosim.algorithms.choose import PLAIN
from cosim.connection import Connection
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuSettings
from cosim.loop import Loop, NativeLoop, PythonLoop, Watched
from cosim.native.csv_file import CsvColumn, write_csv
from cosim.native.plan import Grid
from cosim.observers.energy_balance import EnergyMeter
from cosim.observers.trace import Trace
from cosim.programme import Course, ProgrammeUnit
from cosim.system import System
from cosim.unit.protocol import Unit, seconds

MACRO_STEP = 1_000_000
#: Macro-steps times units of one run, so that every run takes about as long.
WORK = {"C": 400_000, "Python": 20_000}


@dataclass(frozen=True)
class Case:
    """One row of the table.

    Args:
        units: FMUs in the chain.
        version: FMI version.
        kind: Algorithm.
        recording: `every step` or `at the end`.
        csv: Whether the recorded rows are written as CSV.
    """

    units: int
    version: int
    kind: str
    recording: str
    csv: bool = False

    def __str__(self) -> str:
        return f"| {self.units} | {self.version}.0 | {self.kind} | {self.recording}{' + CSV' if self.csv else ''} |"


CASES = [
    Case(units, version, kind, recording, csv)
    for units in (2, 20)
    for version in (2, 3)
    for kind in ("jacobi", "gauss_seidel")
    for recording, csv in (("at the end", False), ("every step", False), ("every step", True))
]


def chain(case: Case, steps: int) -> System:
    """Feedthrough FMUs, each fed by the one before, the first by a ramp: every value is new in every macro-step."""
    ramp = Course((0, steps * MACRO_STEP), np.array([0.0, 1.0]), "1", None, is_linear=True)
    units: dict[str, Unit] = {"ramp": ProgrammeUnit("ramp", {"y": ramp})}
    for number in range(case.units):
        archive = open_fmu(FMUS / f"feedthrough_fmi{case.version}.fmu")
        units[f"u{number}"] = CoSimulationUnit(f"u{number}", archive, FmuSettings(start={"u": 0.0}))
    names = list(units)
    wires = [Connection((source, "y"), (target, "u")) for source, target in itertools.pairwise(names)]
    return System(units, wires, frozenset({"ramp"}))


def _csv(trace: Trace, path: Path) -> None:
    moments = np.array([seconds(t) for t in trace.times])
    rows = trace.chunk(0)
    write_csv(path, moments, [CsvColumn(c.name, c.variable.unit, rows[c.name]) for c in trace.channels])


def measure(case: Case, language: str) -> float:
    """Microseconds per macro-step and unit of one run, from the first step to the last byte of CSV."""
    steps = WORK[language] // case.units
    per_record = 1 if case.recording == "every step" else steps
    system = chain(case, steps)
    try:
        system.initialise(0, {})
        trace = Trace(system, range(0, steps * MACRO_STEP + 1, per_record * MACRO_STEP))
        trace.record(0)
        watched = Watched(system, trace, EnergyMeter(system), Grid(0, MACRO_STEP, per_record))
        loop: Loop = NativeLoop(watched, case.kind) if language == "C" else PythonLoop(watched, Plain(PLAIN[case.kind]))
        with tempfile.TemporaryDirectory() as folder:
            begin = clock.perf_counter()
            index = 0
            while index < steps:
                loop.advance(index, steps)
                index = loop.index
            if case.csv:
                _csv(trace, Path(folder) / "run.csv")
            spent = clock.perf_counter() - begin
        assert (
            abs(float(system.units[f"u{case.units - 1}"].get("y")) - (1.0 - 0.5 / steps)) < 1e-12
        )  # middle of the step
        assert trace.count == len(trace.times)
        return 1e6 * spent / (steps * case.units)
    finally:
        system.terminate()


def medians(repetitions: int, report: Callable[[str], None]) -> dict[tuple[Case, str], float]:
    """Median of interleaved repetitions, so that a busy moment of the machine falls on all cases alike."""
    found: dict[tuple[Case, str], list[float]] = {}
    for repetition in range(repetitions):
        for case in CASES:
            for language in WORK:
                found.setdefault((case, language), []).append(measure(case, language))
        report(f"repetition {repetition + 1} of {repetitions}")
    return {key: statistics.median(values) for key, values in found.items()}


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table."""
    given = sys.argv[1:] if arguments is None else arguments
    build()
    found = medians(int(given[0]) if given else 7, lambda text: print(text, file=sys.stderr))
    lines = [
        heading("Loop", "python -m benchmarks.loop"),
        "Microseconds per macro-step and unit, median of interleaved repetitions; y = u, chained, fed by a ramp. Each",
        "step settles the whole chain first (direct feedthrough), which the loops of other tools leave out.",
        f"Load average of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores.\n",
        "| FMUs | FMI | algorithm | recorded | native loop | loop in Python |",
        "|" + 6 * "---|",
    ]
    lines += [f"{case} {found[case, 'C']:.3f} | {found[case, 'Python']:.2f} |" for case in CASES]
    text = "\n".join(lines) + "\n"
    (results_folder() / "loop.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
