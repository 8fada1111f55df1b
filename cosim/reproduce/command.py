"""`cosim reproduce`: run the paper's experiments, compare, draw, write the scorecard."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from pathlib import Path

import xarray as xr
from rich.console import Console

from cosim.components import FabricComponent, FmuComponent
from cosim.ensemble.folder import EnsembleFolder
from cosim.ensemble.run import run_ensemble
from cosim.errors import InputError
from cosim.figures.draw import draw_runs, open_run
from cosim.progress import progress_bar
from cosim.reproduce.electrical import electrical_rows
from cosim.reproduce.mechanical import curvature_rows, link_rows
from cosim.reproduce.row import Row
from cosim.reproduce.scorecard import as_json, as_markdown, show
from cosim.reproduce.starts import rows_over_starts
from cosim.reproduce.stiffness import stiffness_rows
from cosim.reproduce.thermal import thermal_rows
from cosim.run import RunStopped, run
from cosim.run_folder import RunFolder, write_atomically, writing
from cosim.scenario import Scenario, load_scenario

#: The longest first, so that two processes end together.
RUNS = (
    "hanging_contraction",
    "prototype_cantilever",
    "prototype_cantilever_instant",
    "passive_drape",
    "single_coil_heating",
    "single_coil_own_rate",
    "water_bath",
)


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


def run_one(name: str, out: Path, starts: int = 1) -> str:
    """Run or resume one scenario in `out/name`, a fabric from several starts; an empty text or why it stopped."""
    folder = RunFolder(out / name)
    if folder.is_complete() and (starts == 1 or not _has_fabric(scenario_of(name)) or _has_starts(folder.path, starts)):
        return ""
    scenario = scenario_of(name)
    if starts > 1 and _has_fabric(scenario):
        return _run_starts(name, scenario, folder.path, starts)
    is_begun = folder.scenario.exists()
    try:
        with progress_bar(name, Console(stderr=True, force_terminal=False)) as on_progress:
            run(load_scenario(folder.scenario) if is_begun else scenario, folder.path, is_begun, on_progress)
    except (RunStopped, InputError) as error:
        return f"{name}: {error}"
    return ""


def _has_fabric(scenario: Scenario) -> bool:
    return any(isinstance(c, FabricComponent) for c in scenario.components.values())


def _has_starts(path: Path, starts: int) -> bool:
    folder = EnsembleFolder(path)
    return folder.exists() and folder.starts() >= starts


def _run_starts(name: str, scenario: Scenario, path: Path, starts: int) -> str:
    """An ensemble; starts that stop are left out, and said, as long as one is complete."""
    folder = EnsembleFolder(path)

    def say(text: str) -> None:
        print(f"{name}: {text}", file=sys.stderr, flush=True)

    try:
        outcome = run_ensemble(scenario, folder, starts, folder.exists(), 1, say=say)
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
    print(f"scorecard: {out / 'scorecard.md'}\nFigure 3:  {out / 'prototype_cantilever/figures/figure3_curvature.png'}")
    return 0


def _run_all(out: Path, jobs: int, starts: int) -> list[str]:
    context = multiprocessing.get_context("spawn")  # Bullet and ngspice hold state that must not be forked
    problems: list[str] = []
    with ProcessPoolExecutor(jobs, mp_context=context) as pool:
        futures: dict[Future[str], str] = {pool.submit(run_one, name, out, starts): name for name in RUNS}
        try:
            for done, future in enumerate(as_completed(futures), start=1):
                problem = future.result()
                problems += [problem] if problem else []
                print(f"[{done}/{len(RUNS)}] {futures[future]}: {problem or 'done'}", file=sys.stderr, flush=True)
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
