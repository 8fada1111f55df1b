"""`cosim reproduce`: run the paper's experiments, compare, draw, write the scorecard."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from pathlib import Path

import xarray as xr
from rich.console import Console

from cosim.components import FmuComponent
from cosim.errors import InputError
from cosim.figures.draw import draw_runs, open_run
from cosim.progress import Board, report_to, reporter
from cosim.reproduce.electrical import electrical_rows
from cosim.reproduce.mechanical import curvature_rows, link_rows
from cosim.reproduce.row import Row
from cosim.reproduce.scorecard import as_json, as_markdown, show
from cosim.reproduce.stiffness import stiffness_rows
from cosim.reproduce.thermal import thermal_rows
from cosim.run import RunStopped, run
from cosim.run_folder import RunFolder, write_atomically, writing
from cosim.scenario import Scenario, load_scenario

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


def run_one(number: int, out: Path) -> str:
    """Run or resume one of `RUNS` in a folder of its name; returns an empty text or why it stopped."""
    name = list(RUNS)[number]
    folder = RunFolder(out / name)
    if folder.is_complete():
        return ""
    scenario = scenario_of(name)
    is_begun = folder.scenario.exists()
    try:
        run(load_scenario(folder.scenario) if is_begun else scenario, folder.path, is_begun, reporter(number))
    except (RunStopped, InputError) as error:
        return f"{name}: {error}"
    return ""


def reproduce(out: Path, jobs: int) -> int:
    """Run what is needed, then print and write the scorecard.

    Args:
        out: Folder; complete runs in it are used again, begun ones are resumed.
        jobs: Processes.

    Returns:
        Exit code: 0 where the scorecard was made (a line that fails stays visible in it), 1 where a run stopped.
    """
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
    print(plan(out, jobs), file=sys.stderr, flush=True)
    problems = _run_all(out, jobs)
    if problems:
        for problem in problems:
            print(f"stopped: {problem}", file=sys.stderr)
        return 1
    runs = {name: open_run(out / name) for name in RUNS}
    rows = scorecard_rows(runs)
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


def plan(out: Path, jobs: int) -> str:
    """What is going to be done, and about how long it takes."""
    lines, seconds = [], []
    for name, wall in RUNS.items():
        folder = RunFolder(out / name)
        state = "done" if folder.is_complete() else "to go on" if folder.scenario.exists() else "to run"
        seconds += [] if state == "done" else [wall]
        lines.append(f"  {name:<30} {state:<9} {'' if state == 'done' else f'{wall:>4} s'}".rstrip())
    longest = max([sum(seconds) / jobs, *seconds], default=0)
    about = f"about {longest / 60:.0f} min" if longest >= 90 else f"about {longest:.0f} s"
    return "\n".join([
        f"the paper's experiments, {jobs} at a time, into {out} (times: {MACHINE}):", *lines,
        f"then figures and the scorecard; in all {about}. Ctrl-C keeps what is computed.",
    ])  # fmt: skip


def _run_all(out: Path, jobs: int) -> list[str]:
    context = multiprocessing.get_context("spawn")  # Bullet and ngspice hold state that must not be forked
    problems: list[str] = []
    board = Board(list(RUNS), context)
    with board.drawn(), ProcessPoolExecutor(jobs, context, report_to, (board.slots,)) as pool:
        futures: dict[Future[str], int] = {pool.submit(run_one, number, out): number for number in range(len(RUNS))}
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
