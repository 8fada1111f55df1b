"""Command line: arguments, messages and exit codes."""

from __future__ import annotations

import atexit
import contextlib
import errno
import gc
import json
import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

import cosim.threads  # noqa: F401  before anything imports NumPy
from cosim.alone import alone
from cosim.commands import fmu
from cosim.commands.compare import compare
from cosim.commands.design import design
from cosim.commands.example import example
from cosim.commands.group import Commands
from cosim.commands.play import play
from cosim.commands.sweep import sweep
from cosim.commands.track import track
from cosim.interrupt import end_as_interrupt, keep_swallowed_interrupts
from cosim.loading import load_scenario
from cosim.options import Changes, Formats, ScenarioArgument, complete_scenario, formats_of, show_version
from cosim.run_folder import RunFolder
from cosim.ssp import command as ssp
from cosim.terminal import as_argument, in_one_line, printable
from cosim.unit.errors import InputError
from diagnosis.check import command as recording
from diagnosis.command import diagnose
from diagnosis.recording.command import record

if TYPE_CHECKING:
    from cosim.scenario import Scenario

#: Objects that are made before Python looks for unused cycles again: imports make a few hundred thousand that stay, and
#: looking at them every 700 (Python's own number) costs a tenth of the time of a short command.
OBJECTS_BETWEEN_COLLECTIONS = 50_000
#: Exit codes: 1 a unit failed, 2 wrong input, 130 interrupted (as shells do).
FAILED, WRONG_INPUT, INTERRUPTED = 1, 2, 130

app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Co-simulation of active chainmail: ngspice, actuator FMUs and Bullet behind one algorithm.",
    epilog="Begin with `cosim list`, then `cosim run single_coil_heating`. See docs/ for the file formats.",
)


def _add_prove() -> None:
    """Add `cosim prove` where there is an evaluation: it is part of a clone and of no wheel."""
    try:
        from evaluation.proof.command import prove
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "evaluation":
            raise
    else:
        app.command()(prove)


app.add_typer(fmu.app, name="fmu")
app.add_typer(ssp.app, name="ssp")
app.add_typer(recording.app, name="recording")
app.command()(compare)
app.command()(play)
app.command()(example)
app.command()(sweep)
app.command()(design)
app.command()(record)
app.command()(track)
app.command()(diagnose)
_add_prove()


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=show_version, is_eager=True, help="Show the version and end.")
    ] = False,
) -> None:
    """Options that stand before every command."""


@app.command("list")
def list_scenarios() -> None:
    """List the shipped scenarios."""
    from rich.console import Console  # late: no other command here prints a table
    from rich.table import Table

    from cosim.scenario import shipped_scenarios

    table = Table("scenario", "what it does", box=None)
    for name, path in shipped_scenarios().items():
        table.add_row(name, load_scenario(path).title)
    Console().print(table)


@app.command()
def validate(scenario: ScenarioArgument, changes: Changes = None) -> None:
    """Check a scenario, its FMUs and its connections without running it; guess size, memory and time of a run."""
    from cosim.assemble import assemble  # late: `--help` must not load Bullet
    from cosim.estimate import estimate

    loaded = load_scenario(scenario, changes or ())
    assembly = assemble(loaded)
    counts = {n: len(u.variables) for n, u in assembly.system.units.items()}
    loops = dict.fromkeys(str(loop) for loop in [*assembly.system.initial_loops, *assembly.system.loops])
    assembly.system.terminate()
    outside = [text for unit in assembly.system.units.values() for text in unit.outside_range]
    parts = ", ".join(f"{name} ({count} variables)" for name, count in counts.items())
    print(f"{loaded.path}: valid; {parts}; {len(assembly.scenario.connections)} connections")
    for loop in loops:
        print(f"  {loop}")
    print(f"  {estimate(assembly)}")
    _warn(outside)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scenario files, for editors."""
    from cosim.scenario import json_schema

    print(json.dumps(json_schema(), indent=2))


@app.command()
def run(
    scenario: Annotated[
        str,
        typer.Argument(
            help="A scenario file or name, or an .ssp file; with --resume it may be a run folder.",
            autocompletion=complete_scenario,
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="Run folder; default runs/SCENARIO.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the last checkpoint of an earlier run.")] = False,
    plots: Annotated[bool, typer.Option(help="Draw the figures at the end.")] = True,
    csv: Annotated[bool, typer.Option("--csv", help="Write all recorded values as results.csv too.")] = False,
    figures: Formats = "png",
    changes: Changes = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace the run that the folder holds, once this one has begun.")
    ] = False,
    starts: Annotated[
        int | None,
        typer.Option(min=1, help="Run a fabric from so many starts: the result has medians and bands."),
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Starts at the same time.")] = 2,
) -> None:
    """Run a scenario and write a run folder.

    Ctrl-C keeps what is computed; `--resume` goes on from there to the same result.
    """
    if resume and (changes or overwrite):
        option = "--set" if changes else "--overwrite"
        raise InputError(option, "", "a run that goes on stays as it is", f"leave out `{option}` or `--resume`")
    formats = formats_of(figures)
    folder = _folder(scenario, out, resume, overwrite)
    loaded = _loaded(scenario, folder, resume, changes or [])
    _announce(loaded, starts or 1, jobs, resume)
    if starts is not None or (resume and is_ensemble(folder.path)):
        _run_starts(loaded, folder, starts, resume, jobs, csv, formats if plots else [])
    else:
        run_into(loaded, folder, resume, csv)
    if plots:
        _draw(folder, formats)
    print(f"{folder.path}: {in_one_line(loaded.title)}")


def _announce(scenario: Scenario, starts: int, jobs: int, resume: bool) -> None:
    """Say how long a run will take, where that is minutes; the progress bar says it of a run that goes on."""
    from cosim.estimate import announcement

    text = "" if resume else announcement(scenario, starts, jobs)
    if text:
        print(text, file=sys.stderr, flush=True)


def is_ensemble(folder: Path) -> bool:
    """Whether a folder holds an ensemble."""
    return RunFolder(folder).ensemble.is_file()


def _run_starts(
    scenario: Scenario, target: RunFolder, starts: int | None, resume: bool, jobs: int, csv: bool, formats: list[str]
) -> None:
    """Run or resume an ensemble; where a start stopped, the program ends with the exit code of a failure."""
    from chainmail.ensemble.folder import EnsembleFolder
    from chainmail.ensemble.run import run_ensemble

    folder = EnsembleFolder(target.path, target.overwrites)
    count = folder.starts() if starts is None else starts
    outcome = run_ensemble(scenario, folder, count, resume, jobs, csv, lambda text: print(text, file=sys.stderr))
    if outcome.is_interrupted:
        print(f"interrupted: {len(outcome.complete)} of {count} starts are complete", file=sys.stderr)
        print(f"  go on with: cosim run {as_argument(folder.path)} --resume", file=sys.stderr)
        raise typer.Exit(INTERRUPTED)
    for start, reason in sorted(outcome.failures.items()):
        print(f"stopped: start {start}: {printable(str(reason))}", file=sys.stderr)
    if outcome.failures:
        if outcome.complete:
            if formats:
                _draw(folder.run, formats)
            print(f"  kept: {folder.run.results}, {len(outcome.complete)} of {count} starts", file=sys.stderr)
        raise typer.Exit(FAILED)


def _loaded(scenario: str, folder: RunFolder, resume: bool, changes: list[str]) -> Scenario:
    is_imported = ssp.is_ssp(scenario)
    if resume and (is_imported or Path(scenario).is_dir()):
        return load_scenario(folder.scenario)
    if is_imported:
        folder.refuse_existing()
        with alone(folder.path, "run"):  # it replaces what an earlier import left: nobody may be running it
            return ssp.scenario_of(Path(scenario), folder.path / "imported", changes)
    return load_scenario(scenario, changes)


def _folder(scenario: str, out: Path | None, resume: bool, overwrite: bool) -> RunFolder:
    if out is None and resume and Path(scenario).is_dir():
        out = Path(scenario)
    folder = RunFolder(out or Path("runs") / Path(scenario).stem, overwrites=overwrite)
    if resume and not folder.scenario.is_file():
        raise InputError(folder.path, "", "there is no run to resume here", "give its folder with `--out`")
    return folder


def run_into(scenario: Scenario, folder: RunFolder, resume: bool = False, csv: bool = False) -> None:
    """Run with a progress bar; a run that stops early ends the program with its exit code."""
    from cosim.progress import progress_bar
    from cosim.run import RunStopped, record

    try:
        with progress_bar(scenario.title) as on_progress:
            recorded = record(scenario, folder.path, resume, on_progress, csv, folder.overwrites)
        _warn(recorded.outside)
    except RunStopped as stopped:
        print(f"stopped: {printable(str(stopped.reason))}", file=sys.stderr)
        _warn(stopped.recorded.outside)
        if folder.summary.is_file():
            print(f"  kept: {folder.results}", file=sys.stderr)
        if stopped.is_interrupt:
            print(f"  go on with: cosim run {as_argument(folder.path)} --resume", file=sys.stderr)
        raise typer.Exit(INTERRUPTED if stopped.is_interrupt else FAILED) from stopped


def _warn(texts: Iterable[str]) -> None:
    for text in texts:
        print(f"warning: {printable(text)}", file=sys.stderr)


def _draw(folder: RunFolder, formats: list[str]) -> None:
    from chainmail.figures.draw import draw_run

    for path in draw_run(folder.path, formats):
        print(path)


@app.command()
def plot(
    runs: Annotated[list[Path], typer.Argument(help="Run folders; the curvature is drawn of all of them together.")],
    formats: Formats = "png",
) -> None:
    """Draw the figures of one or more runs into the first run's folder."""
    from chainmail.figures.draw import draw_runs

    for path in draw_runs(runs, formats_of(formats)):
        print(path)


@app.command()
def reproduce(
    out: Annotated[Path, typer.Option(help="Folder for the runs, the scorecard and the figures.")] = Path(
        "runs/reproduce"
    ),
    jobs: Annotated[int, typer.Option(min=1, help="Runs at the same time.")] = 2,
    starts: Annotated[
        int, typer.Option(min=1, help="Starts of every fabric; with several the scorecard has medians and bands.")
    ] = 1,
    bands: Annotated[
        int | None,
        typer.Option(
            min=0,
            help="Starts in MuJoCo for the bands beside the runs in Bullet; default: 12, or 0 with --starts.",
        ),
    ] = None,
) -> None:
    """Run the paper's experiments and compare every published number with ours."""
    from chainmail.reproduce.command import STARTS_OF_BANDS
    from chainmail.reproduce.command import reproduce as reproduce_paper

    default = STARTS_OF_BANDS if starts == 1 else 0
    raise typer.Exit(reproduce_paper(out, jobs, starts, default if bands is None else bands))


def _check_working_folder() -> None:
    """Refuse to work in a folder that was removed meanwhile: no path could be found from there."""
    try:
        Path.cwd()
    except OSError as error:
        what = f"the working folder cannot be read: {error.strerror}"
        raise InputError("cosim", "", what, "go to a folder that exists (`cd`)") from error


def main() -> NoReturn:
    """Entry point: every foreseen error becomes one message and an exit code."""
    keep_swallowed_interrupts()
    end_as_interrupt()
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    atexit.register(gc.freeze)  # or Python looks through all objects before it ends: a fifth of the time of `validate`
    if hasattr(sys.stdout, "reconfigure"):  # a name that the terminal's encoding does not have ends no command
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        _check_working_folder()
        app()
    except InputError as error:
        print(f"error: {printable(str(error))}", file=sys.stderr)
        sys.exit(WRONG_INPUT)
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
    except SystemExit as end:
        if _is_unsaid_interrupt(end):
            print("interrupted", file=sys.stderr)
        _write_out()
        raise
    except OSError as error:
        _say_unwritten(error)
    sys.exit(0)


def _write_out() -> None:
    """Write what is left of the output now: Python does it after the last moment to say that it failed."""
    try:
        if sys.stdout is not None:  # it is where the shell has closed it
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        _say_unwritten(error)


def _say_unwritten(error: OSError) -> None:
    """End the program because a disk is full, as where the output goes to a file.

    Raises:
        OSError: It is another error.
    """
    if error.errno not in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        raise error
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # or Python tries again, and says so in its way
    where = error.filename or "the output"
    print(f"error: {where}: it cannot be written: {error.strerror}", file=sys.stderr)
    print("  remedy: make room on the disk, and repeat the command", file=sys.stderr)
    sys.exit(FAILED)


def _is_unsaid_interrupt(end: SystemExit) -> bool:
    """Whether a command was interrupted where nothing handles that: Typer ends it with the right code and no word."""
    cause = end.__context__.__cause__ if end.__context__ is not None else None
    return end.code == INTERRUPTED and isinstance(cause, KeyboardInterrupt)


if __name__ == "__main__":
    main()
