"""Run an ensemble: every start in a run folder of its own, some at a time, then all of them as one result."""

from __future__ import annotations

import multiprocessing
import time as clock
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from chainmail.ensemble.combine import bands, combined, spread
from chainmail.ensemble.files import write_netcdf, write_series
from chainmail.ensemble.folder import EnsembleFolder
from chainmail.ensemble.members import member
from chainmail.ensemble.one import Ended, OnStart, ignore_interrupts_between_runs, run_start
from chainmail.figures.draw import open_run
from cosim.alone import alone
from cosim.assemble import assemble
from cosim.run_folder import replacing, writing
from cosim.scenario import Scenario
from cosim.unit.errors import InputError


@dataclass(frozen=True)
class Outcome:
    """How an ensemble ended.

    Args:
        complete: Starts that reached their end.
        failures: Start to why it stopped.
        is_interrupted: Whether the user interrupted it.
    """

    complete: tuple[int, ...]
    failures: dict[int, str]
    is_interrupted: bool = False


def run_ensemble(
    scenario: Scenario,
    folder: EnsembleFolder,
    starts: int,
    resume: bool = False,
    jobs: int = 2,
    csv: bool = False,
    say: Callable[[str], None] = print,
    on_progress: OnStart | None = None,
) -> Outcome:
    """Run a scenario from several starts, and write their common result.

    A start that stops early (links torn free, the engine diverged) does not stop the others; it is missing in the
    result and named in the summary. Starts that are complete are not made again, begun ones go on from their last
    checkpoint.

    Args:
        scenario: With a fabric.
        folder: Where everything is written.
        starts: How many.
        resume: Whether an ensemble that is there goes on.
        jobs: How many run at the same time, in processes of this machine.
        csv: Write all values of every start as CSV too.
        say: Told of every start that ends.
        on_progress: Told how far each start is, in place of lines on standard error; with `jobs` 1 alone.

    Raises:
        InputError: The scenario, an FMU or the folder is wrong.
    """
    member(scenario, 1)
    begin = clock.perf_counter()
    assembly = assemble(scenario)  # what is wrong with it is said once, before any start begins
    assembly.system.terminate()
    with alone(folder.path, "ensemble"):
        scenario = folder.begin(assembly, starts, resume)
        failures: dict[int, str] = {}
        is_interrupted = False
        for start, ended in _each(scenario, folder, starts, jobs, csv, on_progress):
            if not start:
                is_interrupted = True
                continue
            if ended.is_input:
                raise InputError(
                    folder.member(start).path, "", f"start {start} cannot run: {ended.reason}", "correct the scenario"
                )
            is_interrupted = is_interrupted or ended.is_interrupt
            if ended.reason and not ended.is_interrupt:
                failures[start] = ended.reason
            say(f"start {start} of {starts}: {ended.reason or 'complete'}")
        complete = tuple(s for s in range(1, starts + 1) if folder.member(s).is_complete())
        if is_interrupted:
            return Outcome(complete, failures, True)
        _write(folder, scenario, complete, failures, starts, clock.perf_counter() - begin)
    return Outcome(complete, failures)


def _each(
    scenario: Scenario, folder: EnsembleFolder, starts: int, jobs: int, csv: bool, on_progress: OnStart | None
) -> Iterator[tuple[int, Ended]]:
    """Starts as they end; at last number 0 where the user interrupted them."""
    waiting = [s for s in range(1, starts + 1) if not folder.member(s).is_complete()]
    if min(jobs, len(waiting)) <= 1:
        for start in waiting:
            ended = run_start(scenario, start, folder.member(start).path, csv, on_progress)
            yield start, ended
            if ended.is_interrupt:
                return
        return
    context = multiprocessing.get_context("spawn")  # Bullet and ngspice hold state that must not be forked
    count = min(jobs, len(waiting))
    under_way: dict[Future[Ended], int] = {}
    is_interrupted = False
    with ProcessPoolExecutor(count, mp_context=context, initializer=ignore_interrupts_between_runs) as pool:
        while waiting or under_way:
            # No more are handed over than run: what waits in the pool's own queue would begin after an interrupt.
            while waiting and len(under_way) < count and not is_interrupted:
                start = waiting.pop(0)
                under_way[pool.submit(run_start, scenario, start, folder.member(start).path, csv)] = start
            try:
                done = wait(under_way, return_when=FIRST_COMPLETED).done
            except KeyboardInterrupt:  # the processes have got it too, and stop after their macro-step
                is_interrupted = True
                waiting.clear()
                continue
            for future in done:
                found = _result(future, folder.member(under_way[future]).path)
                is_interrupted = is_interrupted or found.is_interrupt
                yield under_way.pop(future), found
            if is_interrupted:
                waiting.clear()
    if is_interrupted:
        yield 0, Ended("interrupted", is_interrupt=True)


def _result(future: Future[Ended], path: Path) -> Ended:
    try:
        return future.result()
    except BrokenProcessPool as error:
        raise InputError(
            path,
            "",
            "a process died while it simulated; most often memory ran out",
            "go on with `--resume --jobs 1`, which shows why",
        ) from error


def _write(
    folder: EnsembleFolder,
    scenario: Scenario,
    complete: tuple[int, ...],
    failures: dict[int, str],
    starts: int,
    seconds: float,
) -> None:
    """Common results, series and summary of the starts that are complete."""
    failed = {str(s): reason for s, reason in sorted(failures.items())}
    status = "complete" if len(complete) == starts else f"{len(complete)} of {starts} starts are complete"
    summary: dict[str, Any] = {
        "title": scenario.title,
        "status": status,
        "ensemble": {"starts": starts, "complete": list(complete), "failures": failed},
        "wall_time_s": {"since_start_or_resumption": seconds},
    }
    if complete:
        whole = combined({s: open_run(folder.member(s).path) for s in complete})
        whole.attrs.update(title=scenario.title, status=status, starts=starts)
        write_results(folder, whole)
        summary["spread"] = spread(whole)
    folder.write_summary(summary)


def write_results(folder: EnsembleFolder, whole: xr.Dataset) -> None:
    """Results and main series of an ensemble; raises InputError where they cannot be written."""
    with writing(folder.path):
        with replacing(folder.run.results) as partial:
            write_netcdf(partial, whole)
        with replacing(folder.path / "series.csv") as partial:
            write_series(partial, bands(whole))
