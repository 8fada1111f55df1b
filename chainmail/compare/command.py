"""`cosim compare`: run one scenario over several actuators, measure, draw, write the table."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from rich.console import Console

from chainmail.compare.figure import draw
from chainmail.compare.layout import Layout, layout_of
from chainmail.compare.measures import measures
from chainmail.compare.one import INTERRUPTED, run_one
from chainmail.compare.table import Columns, as_csv, as_json, as_markdown, show
from chainmail.compare.variants import Variant, actuator_name, label_of, variant
from chainmail.figures.draw import open_run
from cosim.alone import alone
from cosim.progress import Board, report_to
from cosim.run_folder import write_atomically, writing
from cosim.scenario import load_scenario
from cosim.shipped import shipped_actuators
from cosim.unit.errors import InputError


@dataclass(frozen=True)
class Request:
    """What is compared.

    Args:
        scenario: File or name of a scenario.
        actuators: Shipped names or .fmu paths; empty: all shipped ones.
        fmi: FMI version of shipped ones; None as in the scenario.
        component: The actuator to exchange, where there are several.
        jobs: Runs at the same time.
        changes: `key=value` of `--set`.
    """

    scenario: str
    actuators: Sequence[str] = ()
    fmi: int | None = None
    component: str | None = None
    jobs: int = 1
    changes: Sequence[str] = ()


def compare(request: Request, out: Path | None = None) -> int:
    """Run what is needed, then print and write table and figure.

    Args:
        request: What is compared.
        out: Folder; complete runs in it are used again, begun ones are resumed. Default runs/compare/SCENARIO.

    Returns:
        Exit code: 0 where every actuator ran, 1 where one failed (the others are shown), 130 where it was interrupted.

    Raises:
        InputError: The scenario has no actuator to exchange, or an actuator is named twice.
    """
    scenario = load_scenario(request.scenario, request.changes)
    component = actuator_name(scenario, request.component)
    names = list(request.actuators) or list(shipped_actuators())
    labels = [label_of(n) for n in names]
    if len(set(labels)) < len(labels):
        raise InputError("--actuators", "", f"a name stands twice: {', '.join(labels)}", "name each actuator once")
    folder = out or Path("runs") / "compare" / Path(request.scenario).stem
    problems: dict[str, str] = {}
    variants: list[Variant] = []
    for name in names:
        try:
            variants.append(variant(scenario, component, name, request.fmi))
        except InputError as error:
            if name == names[-1] and not variants:  # none of them can be run: there is nothing to compare
                raise
            problems[label_of(name)] = str(error)
    with alone(folder, "comparison"):
        problems |= _run_all(variants, folder, request.jobs)
        if INTERRUPTED in problems.values():
            print(INTERRUPTED, file=sys.stderr)
            return 130
        notes = [f"{v.label} has no {', '.join(v.left_out)}: left out" for v in variants if v.left_out]
        _report(folder, scenario.title, layout_of(scenario, component), labels, problems, notes)
    return 1 if problems else 0


def _run_all(variants: Sequence[Variant], out: Path, jobs: int) -> dict[str, str]:
    """Label to problem of every variant that stopped."""
    context = multiprocessing.get_context("spawn")  # Bullet and ngspice hold state that must not be forked
    problems: dict[str, str] = {}
    board = Board([v.label for v in variants], context)
    with board.drawn(), ProcessPoolExecutor(jobs, context, report_to, (board.slots,)) as pool:
        futures: dict[Future[str], int] = {
            pool.submit(run_one, v, out / v.label, number): number for number, v in enumerate(variants)
        }
        try:
            for future in as_completed(futures):
                label = variants[futures[future]].label
                try:
                    problem = future.result()
                except Exception as error:  # a crash of the FMU ends the process, and the pool with it
                    problem = f"the process ended: {type(error).__name__}; use `isolation: process` to find where"
                if problem:
                    problems[label] = problem
                board.ended(futures[future], problem or "done")
        except KeyboardInterrupt:
            pool.shutdown(wait=True, cancel_futures=True)
            return {"": INTERRUPTED}
    return problems


def _report(
    out: Path, title: str, layout: Layout, labels: Sequence[str], problems: dict[str, str], notes: list[str]
) -> None:
    runs: dict[str, xr.Dataset] = {label: open_run(out / label) for label in labels if label not in problems}
    columns: Columns = {label: measures(runs[label], layout) if label in runs else None for label in labels}
    lines = [*notes, *(f"{label} failed: {' '.join(text.split())}" for label, text in problems.items())]
    with writing(out):
        write_atomically(out / "comparison.md", as_markdown(title, columns, lines).encode())
        write_atomically(out / "comparison.csv", as_csv(columns).encode())
        write_atomically(out / "comparison.json", as_json(title, columns, notes, problems).encode())
        if runs:
            draw(out / "comparison.png", runs, layout, title)
    show(columns, Console())
    for line in lines:
        print(line)
    print(f"table:  {out / 'comparison.md'} (.csv, .json)" + (f"\nfigure: {out / 'comparison.png'}" if runs else ""))
