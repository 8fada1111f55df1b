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
from chainmail.reproduce.bands import ENGINE, in_mujoco, is_available, with_bands
from chainmail.reproduce.electrical import electrical_rows
from chainmail.reproduce.mechanical import curvature_rows, link_rows
from chainmail.reproduce.row import Row
from chainmail.reproduce.scorecard import as_json, as_markdown, show
from chainmail.reproduce.starts import rows_over_starts
from chainmail.reproduce.stiffness import stiffness_rows
from chainmail.reproduce.thermal import thermal_rows
from cosim.alone import alone
from cosim.components import FabricComponent, FmuComponent
from cosim.progress import Board, report_to, reporter
from cosim.run import Progress, RunStopped, record
from cosim.run_folder import RunFolder, write_atomically, writing
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError

#: Runs with the time [s] that one takes on a core of its own, the longest first, so that two processes end together.
#: Measured in a run of all of them.
RUNS = {
    "hanging_contraction": 345,
    "prototype_cantilever_instant": 225,
    "prototype_cantilever": 210,
    "passive_drape": 30,
    "single_coil_heating": 5,
    "single_coil_own_rate": 5,
    "water_bath": 5,
}
#: Those of them with a fabric, which are repeated in MuJoCo for the bands, with the time [s] of one start.
BANDS = {"hanging_contraction": 90, "prototype_cantilever": 70, "prototype_cantilever_instant": 55, "passive_drape": 11}
#: Starts of the bands unless another number is asked for.
STARTS_OF_BANDS = 12
#: Compared in Figure 3.
PROTOTYPES = ("prototype_cantilever", "prototype_cantilever_instant")
#: Name, number of starts, whether it is a band.
Task = tuple[str, int, bool]
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


def run_one(name: str, out: Path, starts: int = 1, line: int = 0, is_band: bool = False) -> str:
    """Run or resume one scenario, a fabric from several starts.

    Args:
        name: Of `RUNS`.
        out: Folder of all of them.
        starts: Of a fabric.
        line: Its line on the board, where there is one.
        is_band: Run it in the engine of the bands, in the folder of the bands.

    Returns:
        An empty text or why it stopped.
    """
    folder = RunFolder(folder_of(name, out, is_band))
    scenario = in_mujoco(scenario_of(name)) if is_band else scenario_of(name)
    if folder.is_complete() and (starts == 1 or not _has_fabric(scenario) or _has_starts(folder.path, starts)):
        return ""
    if starts > 1 and _has_fabric(scenario):
        return _run_starts(scenario, folder.path, starts, line)
    is_begun = folder.scenario.exists()
    try:
        record(load_scenario(folder.scenario) if is_begun else scenario, folder.path, is_begun, reporter(line))
    except (RunStopped, InputError) as error:
        return f"{name}: {error}"
    return ""


def folder_of(name: str, out: Path, is_band: bool = False) -> Path:
    """Where a run is kept."""
    return out / "bands" / name if is_band else out / name


def _has_fabric(scenario: Scenario) -> bool:
    return any(isinstance(c, FabricComponent) for c in scenario.components.values())


def _has_starts(path: Path, starts: int) -> bool:
    folder = EnsembleFolder(path)
    return folder.exists() and folder.starts() >= starts


def _run_starts(scenario: Scenario, path: Path, starts: int, line: int) -> str:
    """An ensemble; starts that stop are left out, and said, as long as one is complete."""
    folder, name = EnsembleFolder(path), path.name
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


def reproduce(out: Path, jobs: int, starts: int = 1, bands: int = 0) -> int:
    """Run what is needed, then print and write the scorecard.

    Args:
        out: Folder; complete runs in it are used again, begun ones are resumed.
        jobs: Processes.
        starts: Starts in Bullet of every scenario with a fabric; with several the scorecard has medians and bands.
        bands: Starts in MuJoCo of every scenario with a fabric, whose bands stand beside the one run in Bullet; 0 for
            none. They come last: the scorecard without them is there before.

    Returns:
        Exit code: 0 where the scorecard was made (a line that fails stays visible in it), 1 where a run stopped.

    Raises:
        InputError: Bands are asked for that cannot be: of one start, or beside several starts in Bullet.
    """
    bands = _possible_bands(starts, bands)
    with alone(out, "reproduction"):
        return _reproduce(out, jobs, starts, bands)


def _reproduce(out: Path, jobs: int, starts: int, bands: int) -> int:
    print(plan(out, jobs, starts, bands), file=sys.stderr, flush=True)
    problems = _run_all(out, jobs, [(name, starts, False) for name in RUNS])
    if not problems:
        _score(out, 0, is_shown=not bands)
        if bands:
            print(
                f"scorecard of the runs in Bullet: {out / 'scorecard.md'}; now the bands", file=sys.stderr, flush=True
            )
            problems = _run_all(out, jobs, [(name, bands, True) for name in BANDS])
    if problems:
        for problem in problems:
            print(f"stopped: {problem}", file=sys.stderr)
        return 1
    if bands:
        _score(out, bands)
    print(f"scorecard: {out / 'scorecard.md'}\nFigure 3:  {out / 'prototype_cantilever/figures/curvature.png'}")
    return 0


def _possible_bands(starts: int, bands: int) -> int:
    """How many starts the bands get: none where their engine is not installed, which is said."""
    if bands == 1:
        raise InputError("command line", "--bands", "one start gives no band", "give 0, or at least 2")
    if bands and starts > 1:
        raise InputError(
            "command line",
            "--bands",
            f"{starts} starts in Bullet have bands of their own",
            "give `--starts` or `--bands`, not both",
        )
    if bands and not is_available():
        print(f'no bands: {ENGINE} is not installed; pip install "active-chainmail[mujoco]" brings it', file=sys.stderr)
        return 0
    return bands


def _score(out: Path, bands: int, is_shown: bool = True) -> None:
    """Figures and scorecard of what is there."""
    runs = {name: open_run(out / name) for name in RUNS}
    rows = rows_over_starts(runs, scorecard_rows)
    # Figure 3 compares the prototype with and without the heating model, each with its band.
    compared = [folder_of(n, out, is_band) for n in PROTOTYPES for is_band in ((False, True) if bands else (False,))]
    if bands:
        ensembles = {name: open_run(folder_of(name, out, True)) for name in BANDS}
        rows = with_bands(rows, rows_over_starts({**runs, **ensembles}, scorecard_rows))
        draw_runs([folder_of(name, out, True) for name in PROTOTYPES])
    for name in RUNS:
        draw_runs(compared if name == PROTOTYPES[0] else [out / name])
    with writing(out):
        write_atomically(out / "scorecard.md", as_markdown(rows).encode())
        write_atomically(out / "scorecard.json", as_json(rows).encode())
    if is_shown:
        show(rows, Console())


def plan(out: Path, jobs: int, starts: int = 1, bands: int = 0) -> str:
    """What is going to be done, and about how long it takes."""
    first, seconds = _plan_lines(out, jobs, [(name, starts, False) for name in RUNS])
    what = f"the paper's experiments in Bullet, {about(seconds)}"
    if starts > 1:
        what = f"the paper's experiments from {starts} starts in Bullet, {about(seconds)}"
    lines = [f"({jobs} at a time, into {out}; times: {MACHINE})", *first]
    if bands:
        second, more = _plan_lines(out, jobs, [(name, bands, True) for name in BANDS])
        what += f", then bands from {bands} starts in {ENGINE}, {about(more)}: in all {about(seconds + more)}"
        lines += [f"bands, in {ENGINE}:", *second]
    return "\n".join([what, *lines, "then figures and the scorecard. Ctrl-C keeps what is computed."])


def about(seconds: float) -> str:
    """`about 40 s`, `about 12 min`."""
    return f"about {seconds / 60:.0f} min" if seconds >= 90 else f"about {seconds:.0f} s"


def _plan_lines(out: Path, jobs: int, tasks: list[Task]) -> tuple[list[str], float]:
    """A line for each task, and how long [s] all of them take."""
    lines, seconds = [], []
    for name, starts, is_band in tasks:
        folder = RunFolder(folder_of(name, out, is_band))
        count, wall = _starts_left(name, folder, starts), (BANDS if is_band else RUNS)[name]
        state = "done" if not count else "to go on" if folder.scenario.exists() else "to run"
        seconds += [count * wall] if count else []
        of = f"  {count} starts" if count > 1 else ""
        lines.append(f"  {name:<30} {state:<9} {f'{count * wall:>4} s{of}' if count else ''}".rstrip())
    return lines, float(max([sum(seconds) / jobs, *seconds], default=0))


def _starts_left(name: str, folder: RunFolder, starts: int) -> int:
    """How many runs of a scenario are still to be made: one, or the starts of its ensemble that are not complete."""
    if starts == 1 or not _has_fabric(scenario_of(name)):
        return 0 if folder.is_complete() else 1
    members = EnsembleFolder(folder.path)
    return sum(not members.member(s).is_complete() for s in range(1, starts + 1))


def _run_all(out: Path, jobs: int, tasks: list[Task]) -> list[str]:
    context = multiprocessing.get_context("spawn")  # Bullet and ngspice hold state that must not be forked
    problems: list[str] = []
    board = Board([f"{name}, band" if is_band else name for name, _, is_band in tasks], context)
    with board.drawn(), ProcessPoolExecutor(jobs, context, report_to, (board.slots,)) as pool:
        futures: dict[Future[str], int] = {
            pool.submit(run_one, name, out, starts, line, is_band): line
            for line, (name, starts, is_band) in enumerate(tasks)
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
