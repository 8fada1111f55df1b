"""Speed and exactness of all tools, interleaved in one run: `python -m benchmarks.peers.run [--rounds 5]`.

Every measurement is a process of its own. The rounds go over all tools one after the other, so that a slow minute of
the machine meets all of them; a cell gives the median over the rounds and (smallest .. largest).
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

from benchmarks.machine import heading, results_folder
from benchmarks.models.build import build
from benchmarks.models.systems import SYSTEMS
from benchmarks.peers.job import Answer, Job
from benchmarks.peers.tools import Tool, environment, tools

#: The truck runs longer for the timing than its 2 s, or the fast tools would be done before they are warm.
TRUCK_STEPS = 100_000
#: Steps that no binary floating-point number holds exactly [s]; 2.0 s is a whole number of each.
END_STEPS = (1e-3, 1e-2)
SECONDS_AT_MOST = 300


@dataclass
class Cell:
    """Measurements of one tool on one system, FMI version and way of recording."""

    tool: Tool
    job: Job
    answers: list[Answer] = field(default_factory=list)
    failure: str = ""

    def measure(self) -> None:
        """One more repetition."""
        if self.failure or self.tool.python is None:
            return
        with tempfile.TemporaryDirectory() as work:
            job = Job(**{**json.loads(self.job.text()), "work": work})
            try:
                done = subprocess.run(
                    [self.tool.python, "-m", f"benchmarks.peers.entries.{self.tool.module}", job.text()],
                    capture_output=True,
                    text=True,
                    env=environment(),
                    timeout=SECONDS_AT_MOST,
                    check=False,
                )
            except subprocess.TimeoutExpired:
                self.failure = f"not done after {SECONDS_AT_MOST} s"
                return
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            self.failure = f"exit code {done.returncode}: {last[:120]}"
            print(self.tool.name, self.job, self.failure, file=sys.stderr)
            return
        line = done.stdout.strip().splitlines()[-1]
        self.answers.append(Answer(**json.loads(line[line.index("{") :])))

    @property
    def times(self) -> list[float]:
        """Microseconds per macro-step and FMU."""
        calls = self.job.steps * len(SYSTEMS[self.job.system].components)
        return [1e6 * a.seconds / calls for a in self.answers]

    def text(self) -> str:
        """Median and range."""
        if self.tool.python is None:
            return "not installed"
        if not self.answers:
            return "fails"
        return f"{median(self.times):.3g} ({min(self.times):.3g} .. {max(self.times):.3g})"


def timing_cells(chosen: list[Tool]) -> Iterator[Cell]:
    """Every tool, system, FMI version, without and with recording."""
    for system in ("chain", "quarter_truck"):
        for version in (2, 3):
            for csv in (False, True):
                for tool in chosen:
                    if version in tool.versions and (tool.has_csv or not csv):
                        steps = tool.steps if system == "chain" else min(tool.steps, TRUCK_STEPS)
                        yield Cell(tool, Job(system, version, steps, 1e-3, csv, ""))


def end_cells(chosen: list[Tool]) -> Iterator[Cell]:
    """The truck to 2 s."""
    for tool in chosen:
        for step in END_STEPS:
            yield Cell(tool, Job("quarter_truck", 2, round(2.0 / step), step, False, ""))


def timing_table(cells: list[Cell], chosen: list[Tool], system: str) -> list[str]:
    """Rows of tools, columns of FMI version and recording."""
    columns = [(2, False), (2, True), (3, False), (3, True)]
    lines = ["| tool | FMI 2.0 | FMI 2.0, recording | FMI 3.0 | FMI 3.0, recording |", "|---|---|---|---|---|"]
    for tool in chosen:
        row = {(c.job.version, c.job.csv): c.text() for c in cells if c.tool is tool and c.job.system == system}
        lines.append(f"| {tool.name} | " + " | ".join(row.get(column, "") for column in columns) + " |")
    return lines


def end_table(cells: list[Cell]) -> list[str]:
    """Where each tool ends, and its chassis height there."""
    lines = ["| tool | step [s] | end time [s] | chassis height [m] |", "|---|---|---|---|"]
    for cell in cells:
        if cell.answers:
            found = cell.answers[0]
            lines.append(f"| {cell.tool.name} | {cell.job.step:g} | {found.end_time!r} | {found.values[0]:.12f} |")
        else:
            lines.append(f"| {cell.tool.name} | {cell.job.step:g} | {cell.text()} | |")
    return lines


def report(cells: list[Cell], ends: list[Cell], chosen: list[Tool], rounds: int) -> str:
    """The whole page."""
    return "\n".join(
        [
            heading("Speed and end time beside other tools", "python -m benchmarks.peers.run"),
            f"Microseconds per macro-step and FMU: median of {rounds} rounds that go over all tools in turn, in",
            "brackets the smallest and the largest. The stepping loop alone: loading and unpacking are left out. A",
            "blank cell: the tool has no such FMI version or records nothing. What `recording` is differs:",
            "benchmarks/peers/README.md.",
            f"Load average of the machine at the end of the run: {os.getloadavg()[0]:.1f}.",
            "",
            "## Two chained feedthrough FMUs\n",
            *timing_table(cells, chosen, "chain"),
            "",
            "## Quarter truck, three FMUs in a loop, step 1 ms\n",
            *timing_table(cells, chosen, "quarter_truck"),
            "",
            "The C floor of the truck contains what the FMUs themselves take.",
            "",
            "## Where a run to 2 s ends\n",
            *end_table(ends),
            "",
        ]
    )


def main(arguments: list[str] | None = None) -> None:
    """Measure, print and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", nargs="*", help="modules of the tools to measure (default: all); writes no page")
    options = parser.parse_args(arguments)
    build()
    chosen = [tool for tool in tools() if not options.only or tool.module in options.only]
    cells, ends = list(timing_cells(chosen)), list(end_cells(chosen))
    for cell in ends:
        cell.measure()
    for done in range(options.rounds):
        for cell in cells:
            cell.measure()
        print(f"round {done + 1} of {options.rounds}", file=sys.stderr, flush=True)
    text = report(cells, ends, chosen, options.rounds)
    if not options.only:
        Path(results_folder() / "peers.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
