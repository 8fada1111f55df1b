"""What every tool computes beside the solution, for each system that it runs: `python -m benchmarks.peers.correctness`.

All tools get the same FMUs and the same macro-steps. The solution is a closed form, or one monolithic integration; the
error is taken at the end time that the tool reports, so that a tool that ends a step early is not blamed for that.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from benchmarks import quarter_truck, two_mass
from benchmarks.machine import heading, results_folder
from benchmarks.models.build import build
from benchmarks.models.systems import SYSTEMS
from benchmarks.peers.job import Answer, Job
from benchmarks.peers.run import Cell
from benchmarks.peers.tools import Tool, tools

#: Largest error of what a tool answers.
Error = Callable[[Answer], float]


def largest(values: list[float], exact: tuple[float, ...]) -> float:
    """Largest difference of values from as many exact ones; there may be more values than are known exactly."""
    return max(abs(value - right) for value, right in zip(values, exact, strict=False))


@dataclass(frozen=True)
class Case:
    """A system whose solution is known.

    Args:
        system: Name in `SYSTEMS`.
        title: What it is, and what is compared.
        error: Largest error of an answer, in `unit`.
        unit: Unit of the error.
        steps: Macro-steps [s]; none of them where its length changes nothing.
        stop: End of the run [s].
    """

    system: str
    title: str
    error: Error
    unit: str
    steps: tuple[float, ...]
    stop: float


CASES = (
    Case(
        "chain",
        "Two chained feedthrough FMUs, 3 handed on: the output after 0.1 s",
        lambda answer: largest(answer.values, (3.0,)),
        "1",
        (1e-3,),
        0.1,
    ),
    Case(
        "loop",
        "Two FMUs y = u/2 + 1 in a circle: both outputs after one macro-step; 2 solves the loop",
        lambda answer: largest(answer.values, (2.0, 2.0)),
        "1",
        (1e-3,),
        1e-3,
    ),
    Case(
        "two_mass",
        "Two masses between springs: displacements and velocities at 0.8 s beside the closed form",
        lambda answer: largest(answer.values, two_mass.closed_form(answer.end_time)),
        "m, m/s",
        (2e-3, 1e-3, 5e-4),
        0.8,
    ),
    Case(
        "quarter_truck",
        "Quarter truck, three FMUs: height of the chassis at 2 s beside one monolithic integration",
        lambda answer: largest(answer.values, (quarter_truck.monolithic(answer.end_time),)),
        "m",
        (2e-3, 1e-3, 5e-4),
        2.0,
    ),
)


def cells(case: Case, tool: Tool, version: int) -> list[Cell]:
    """One run for each macro-step, each in a process of its own."""
    found = []
    for step in case.steps:
        cell = Cell(tool, Job(case.system, version, round(case.stop / step), step, False, ""))
        cell.measure()
        found.append(cell)
    return found


def row(case: Case, tool: Tool, version: int) -> str:
    """One line of a case's table."""
    measured = cells(case, tool, version)
    failures = [cell.failure for cell in measured if cell.failure]
    if failures:
        blank = " |" * (len(case.steps) + (len(case.steps) > 1))
        return f"| {tool.name} | {version}.0 | fails: {failures[0]} |{blank}"
    answers = [cell.answers[0] for cell in measured]
    errors = [case.error(answer) for answer in answers]
    ends = ", ".join(dict.fromkeys(f"{answer.end_time!r}" for answer in answers))
    order = f" {math.log2(errors[-2] / errors[-1]):.2f} |" if len(errors) > 1 and errors[-1] > 0.0 else ""
    return f"| {tool.name} | {version}.0 | {ends} | " + " | ".join(f"{error:.3e}" for error in errors) + f" |{order}"


def table(case: Case, chosen: list[Tool]) -> Iterator[str]:
    """Tools in rows, macro-steps in columns."""
    columns = [f"error, step {step * 1e3:g} ms [{case.unit}]" for step in case.steps]
    columns += ["order"] if len(case.steps) > 1 else []
    yield f"## {case.title}\n"
    yield "| tool | FMI | end time [s] | " + " | ".join(columns) + " |"
    yield "|" + "---|" * (3 + len(columns))
    for version in (2, 3):
        for tool in chosen:
            if tool.python is not None and version in tool.versions:
                yield row(case, tool, version)
    yield ""


def main(arguments: list[str] | None = None) -> None:
    """Run, print and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="*", help="modules of the tools (default: all); writes no page")
    options = parser.parse_args(arguments)
    build()
    chosen = [t for t in tools() if not options.only or t.module in options.only]
    chosen = [t for t in chosen if t.module != "c_floor"]
    absent = [t.name for t in chosen if t.python is None]
    lines = [
        heading("Correctness beside other tools", "python -m benchmarks.peers.correctness"),
        "The same FMUs and macro-steps in every tool, exchanged once per step (Jacobi). The error is taken at the end",
        "time that the tool reports; order: from the last two macro-steps, 1 is what one exchange per step gives.",
        *([f"Not installed here: {', '.join(absent)}."] if absent else []),
        "",
    ]
    for case in CASES:
        assert case.system in SYSTEMS
        lines += table(case, chosen)
    text = "\n".join(lines).rstrip() + "\n"
    if not options.only:
        (results_folder() / "peers_correctness.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
