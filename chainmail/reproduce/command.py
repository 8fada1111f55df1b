"""`cosim reproduce`: run the paper's experiments, compare, draw, write the scorecard."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from dataclasses import replace
from pathlib import Path

import xarray as xr
from rich.console import Console

from chainmail.ensemble.folder import EnsembleFolder
from chainmail.ensemble.run import run_ensemble
from chainmail.figures.draw import draw_runs, open_run
from chainmail.reproduce.electrical import electrical_rows
from chainmail.reproduce.mechanical import curvature_rows, link_rows
from chainmail.reproduce.row import Row
from chainmail.reproduce.scorecard import as_json, as_markdown, show
from chainmail.reproduce.starts import rows_over_starts
from chainmail.reproduce.stiffness import stiffness_rows
from chainmail.reproduce.thermal import thermal_rows
from cosim.components import FabricComponent, FmuComponent
from cosim.progress import Board, report_to, reporter
from cosim.run import Progress, RunStopped, record
from cosim.run_folder import RunFolder, write_atomically, writing
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError

#: Runs with the time [s] that one takes on a core of its own, the longest first, so that two processes end together.
#: Measured: the prototype; the other fabrics by their simulated time and number of links, the rest by a short run.
RUNS = {
    "hanging_contraction": 200,
    "prototype_cantilever": 180,
    "prototype_cantilever_instant": 180,
    "passive_drape": 40,
    "single_coil_heating": 5,
    "single_coil_own_rate": 5,
    "water_bath": 5,
}
#: Where these times were measured.
MACHINE = "a core of a server each, November 2026"


def scenario_of(name: str) -> Scenario:
    """A shipped scenario, or the variant of the single coil that cools at its own rate."""
    if name != "single_coil_own_rate":
        return load_scenario(name)
    base = load_scenario("single_coil_heating")
    actuator = base.components["actuator"]
    assert isinstance(actuator, FmuComponent)
    changed = actuator.model_copy(update={"parameters": {**actuator.parameters, "use_regressed_cooling_rate": False}})
    title = "Single coils, cooling at the rate of equation (3)"
    return base.model_copy(update={"components": {**base.components, "actuator": changed}, "title": title})


def run_one(name: str, out: Path, starts: int = 1, line: int = 0) -> str:
    """Run or resume one scenario in `out/name`, a fabric from several starts.

    Args:
        name: Of `RUNS`.
        out: Folder of all of them.
        starts: Of a fabric.
        line: Its line on the board, where there is one.

    Returns:
        An empty text or why it stopped.
    """
    folder = RunFolder(out / name)
    if folder.is_complete() and (starts == 1 or not _has_fabric(scenario_of(name)) or _has_starts(folder.path, starts)):
        return ""
    scenario = scenario_of(name)
    if starts > 1 and _has_fabric(scenario):
        return _run_starts(name, scenario, folder.path, starts, line)
    is_begun = folder.scenario.exists()
    try:
        record(load_scenario(folder.scenario) if is_begun else scenario, folder.path, is_begun, reporter(line))
    except (RunStopped, InputError) as error:
        return f"{name}: {error}"
    return ""


def _has_fabric(scenario: Scenario) -> bool:
    return any(isinstance(c, FabricComponent) for c in scenario.components.values())


def _has_starts(path: Path, starts: int) -> bool:
    folder = EnsembleFolder(path)
    return folder.exists() and folder.starts() >= starts


def _run_starts(name: str, scenario: Scenario, path: Path, starts: int, line: int) -> str:
    """An ensemble; starts that stop are left out, and said, as long as one is complete."""
    folder = EnsembleFolder(path)
    report = reporter(line)

    def say(text: str) -> None:
        if not sys.stderr.isatty() or not text.endswith(": complete"):  # a terminal has the board's line for that
            print(f"{name}: {text}", file=sys.stderr, flush=True)

    def of_all(start: int, p: Progress) -> None:
        report(replace(p, done=(start - 1) * p.total + p.done, total=starts * p.total))

    try:
        outcome = run_ensemble(scenario, folder, starts, folder.exists(), 1, say=say, on_progress=of_all)
    except InputError as error:
        return f"{name}: {error}"
    if outcome.is_interrupted:
        return f"{name}: interrupted"
    return "" if outcome.complete else f"{name}: no start reached its end: {next(iter(outcome.failures.values()))}"


def reproduce(out: Path, jobs: int, starts: int = 1) -> int:
    """Run what is needed, then print and write the scorecard.

    Args:
        out: Folder; complete runs in it are used again, begun ones are resumed.
        jobs: Processes.
        starts: Starts of every scenario with a fabric; with several the scorecard has medians and bands.

    Returns:
        Exit code: 0 where the scorecard was made (a line that fails stays visible in it), 1 where a run stopped.
    """
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
    print(plan(out, jobs, starts), file=sys.stderr, flush=True)
    problems = _run_all(out, jobs, starts)
    if problems:
        for problem in problems:
            print(f"stopped: {problem}", file=sys.stderr)
        return 1
    runs = {name: open_run(out / name) for name in RUNS}
    rows = rows_over_starts(runs, scorecard_rows)
    for name in RUNS:
        # Figure 3 compares the prototype with and without the heating model.
        compared = ["prototype_cantilever_instant"] if name == "prototype_cantilever" else []
        draw_runs([out / n for n in (name, *compared)])
    with writing(out):
        write_atomically(out / "scorecard.md", as_markdown(rows).encode())
        write_atomically(out / "scorecard.json", as_json(rows).encode())
    show(rows, Console())
    print(f"scorecard: {out / 'scorecard.md'}\nFigure 3:  {out / 'prototype_cantilever/figures/curvature.png'}")
    return 0


def plan(out: Path, jobs: int, starts: int = 1) -> str:
    """What is going to be done, and about how long it takes."""
    lines, seconds = [], []
    for name, wall in RUNS.items():
        folder = RunFolder(out / name)
        count = _starts_left(name, folder, starts)
        state = "done" if not count else "to go on" if folder.scenario.exists() else "to run"
        seconds += [count * wall] if count else []
        of = f"  {count} starts" if count > 1 else ""
        lines.append(f"  {name:<30} {state:<9} {f'{count * wall:>4} s{of}' if count else ''}".rstrip())
    longest = max([sum(seconds) / jobs, *seconds], default=0)
    about = f"about {longest / 60:.0f} min" if longest >= 90 else f"about {longest:.0f} s"
    return "\n".join(
        [
            f"the paper's experiments, {jobs} at a time, into {out} (times: {MACHINE}):",
            *lines,
            f"then figures and the scorecard; in all {about}. Ctrl-C keeps what is computed.",
        ]
    )


def _starts_left(name: str, folder: RunFolder, starts: int) -> int:
    """How many runs of a scenario are still to be made: one, or the starts of its ensemble that are not complete."""
    if starts == 1 or not _has_fabric(scenario_of(name)):
        return 0 if folder.is_complete() else 1
    members = EnsembleFolder(folder.path)
    return sum(not members.member(s).is_complete() for s in range(1, starts + 1))


def _run_all(out: Path, jobs: int, starts: int) -> list[str]:
    context = multiprocessing.get_context("spawn")  # Bullet and ngspice hold state that must not be forked
    problems: list[str] = []
    board = Board(list(RUNS), context)
    with board.drawn(), ProcessPoolExecutor(jobs, context, report_to, (board.slots,)) as pool:
        futures: dict[Future[str], int] = {
            pool.submit(run_one, name, out, starts, line): line for line, name in enumerate(RUNS)
        }
        try:
            for future in as_completed(futures):
                problem = future.result()
                problems += [problem] if problem else []
                board.ended(futures[future], problem or "done")
        except KeyboardInterrupt:
            pool.shutdown(wait=True, cancel_futures=True)
            return ["interrupted; the same command goes on from here"]
    return problems


def scorecard_rows(runs: Mapping[str, xr.Dataset]) -> list[Row]:
    """All rows from the results of `RUNS`."""
    return [
        *electrical_rows(runs["prototype_cantilever"]),
        *thermal_rows(runs["single_coil_heating"], runs["single_coil_own_rate"]),
        *stiffness_rows(runs["water_bath"]),
        *link_rows(runs["prototype_cantilever"], runs["passive_drape"], runs["hanging_contraction"]),
        *curvature_rows(runs["prototype_cantilever"], runs["prototype_cantilever_instant"]),
    ]
