"""`cosim design`: read, search, write."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from chainmail.design.candidate import Rig, rig_of, scenario_for
from chainmail.design.impossible import Impossible
from chainmail.design.keys import check_keys
from chainmail.design.ledger import Ledger
from chainmail.design.report import delay_front, front, impossible, report, winning_scenario
from chainmail.design.search import HOLD, Search, check_of
from chainmail.design.shape import with_requirements
from chainmail.design.task import Task, load_task
from chainmail.play.notebook import play
from cosim.alone import alone
from cosim.assemble import assemble
from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.cluster import Place
from cosim.compute.progress import Progress
from cosim.run import RunStopped, run
from cosim.run_folder import write_atomically, writing
from cosim.scenario import Scenario
from cosim.sweep.checks import check_output, unit_of
from cosim.sweep.file import Output
from cosim.unit.errors import InputError

#: Exit code where no design was accepted.
NOT_FOUND = 1


def design(
    path: Path,
    out: Path,
    place: Place,
    resume: bool,
    tell: Callable[[str], None],
    progress: Progress | None = None,
    with_page: bool = False,
) -> int:
    """Find a design and write its folder.

    Args:
        path: Task file.
        out: Folder: `scenario.yaml`, `report.md`, `front.csv`, `ledger.csv`, and every run.
        place: Where runs are made.
        resume: Use the runs that an earlier search left in the folder.
        tell: Told what is done.
        progress: Told of every run.
        with_page: Run the winner once more and write `play.html`, which shows it move.

    Returns:
        Exit code: 0 where a design was accepted, 1 where none was, or the request is impossible (report.md says which).

    Raises:
        InputError: Something in task, scenario or folder is wrong.
        KeyboardInterrupt: The user stopped it; runs that were finished are kept.
    """
    task, scenario = load_task(path)
    rig = rig_of(scenario, path)
    _check_rows(task.vary.rows_heated, rig.free, path)
    check_keys(task.vary.keys, rig, path)
    _check_temperatures(task, rig, path)
    task = with_requirements(task, rig, path)
    _check_effort(task, path)
    _check_wanted(task, rig, path)
    with alone(out, "design"):
        is_begun = (out / "report.md").exists() or (out / "runs").exists()
        if is_begun and not resume:
            raise InputError(
                out,
                "",
                "this folder already holds a design",
                "go on from it with `--resume`, or give another folder with `--out`",
            )
        with Batches(place, Cache(out / "runs"), progress) as batches:
            ledger = Ledger(task, rig, batches)
            search = Search(ledger, tell)
            try:
                outcome = search.run()
            except Impossible as why:
                _write(
                    out,
                    {"report.md": impossible(ledger, why), "ledger.csv": ledger.table(), "front.csv": front(ledger)},
                )
                print(
                    f"not possible: {why.limit}\n  nearest: {why.nearest}\nreport: {out / 'report.md'}", file=sys.stderr
                )
                return NOT_FOUND
        files = {"report.md": report(search, outcome), "ledger.csv": ledger.table(), "front.csv": front(ledger)}
        if outcome.points:
            files["delays.csv"] = delay_front(ledger, outcome)
        if outcome.winner is not None:
            files["scenario.yaml"] = winning_scenario(outcome.winner, rig, task.title)
        _write(out, files)
        if outcome.winner is not None and with_page:
            files["play.html"] = ""
            tell("the page that shows the design move")
            write_page(scenario_for(outcome.winner, rig).model_copy(update={"title": task.title}), out)
    print((out / "report.md").read_text(encoding="utf-8"))
    for name in files:
        print(f"{name}: {out / name}")
    return 0 if outcome.winner is not None else NOT_FOUND


def write_page(scenario: Scenario, out: Path) -> None:
    """The design as `cosim play` shows it, from a run of its own in `winner/`."""
    try:
        run(scenario, out / "winner", overwrite=(out / "winner").exists())
    except RunStopped as stop:
        if stop.is_interrupt:
            raise KeyboardInterrupt from stop
        print(f"no page: {stop.reason}", file=sys.stderr)
        return
    play(out / "winner").save(out / "play.html")


def _check_rows(given: object, free: tuple[int, ...], path: Path) -> None:
    if not isinstance(given, list):
        return
    twice = [r for p in given for r in p if p.count(r) > 1]
    if twice:
        raise InputError(path, "vary.rows_heated", f"row {twice[0]} stands twice in a pattern", "name each row once")
    wrong = sorted({r for pattern in given for r in pattern} - set(free))
    if wrong or not given:
        problem = f"row {wrong[0]} is no free row of the fabric" if wrong else "there is no pattern"
        raise InputError(path, "vary.rows_heated", problem, f"free rows are {free[0]} to {free[-1]}")


def _check_temperatures(task: Task, rig: Rig, path: Path) -> None:
    """Refuse what the programme of a row cannot do: it is held at `HOLD` once it has been hotter."""
    hold, ambient, low = f"{HOLD - 273.15:.3g} degC", rig.rows[rig.held].ambient, task.vary.temperature.low
    if ambient >= HOLD:
        raise InputError(
            rig.scenario.path or path,
            "components",
            f"the room has {ambient - 273.15:.3g} degC, and rows are held stiff at {hold}: they never cool to it",
            f"give a room below {hold}",
        )
    if low.to("K") < HOLD:
        raise InputError(
            path,
            "vary.temperature",
            f"{low} is below {hold}, at which a row is held after it has been hotter",
            f"begin the range at {hold} or above",
        )


def _check_effort(task: Task, path: Path) -> None:
    """Refuse a number of runs with which no design can be accepted."""
    fewest = check_of(task.wanted).fewest
    if task.runs.full < fewest:
        raise InputError(
            path,
            "runs.full",
            f"with {task.runs.full} runs no design can be accepted: the last check alone takes {fewest} fresh starts",
            f"give more than {fewest}; the search makes runs of its own",
        )


def _check_wanted(task: Task, rig: Rig, path: Path) -> None:
    """Refuse quantities that no run of the scenario has: the first run would be spent on that."""
    assembly = assemble(rig.scenario)
    assembly.system.terminate()
    for number, wanted in enumerate(task.wanted):
        # Times are those of the design, whose run is not that of the scenario.
        timeless = Output(quantity=wanted.quantity, of=wanted.of, unit=wanted.unit)
        try:
            check_output(timeless, assembly)
            bound = wanted.below or wanted.above
            assert bound is not None
            bound.to(wanted.unit or unit_of(wanted.quantity, assembly))
        except ValueError as error:
            key = f"wanted[{number + 1}]"
            raise InputError(path, key, str(error), "docs/design.md and docs/sweeps.md explain quantities") from error


def _write(out: Path, files: dict[str, str]) -> None:
    with writing(out):
        for name, text in files.items():
            write_atomically(out / name, text.encode())
