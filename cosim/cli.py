"""Command line: arguments, messages and exit codes."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, NoReturn

import typer
from rich.console import Console
from rich.table import Table

from cosim.commands import fmu
from cosim.commands.compare import compare
from cosim.commands.design import design
from cosim.commands.sweep import sweep
from cosim.errors import InputError
from cosim.run_folder import RunFolder
from cosim.scenario import Scenario, json_schema, load_scenario, shipped_scenarios
from cosim.ssp import command as ssp
from diagnosis.check import command as recording
from diagnosis.command import diagnose
from diagnosis.proof.command import prove
from diagnosis.recording.command import record

#: Exit codes: 1 a unit failed, 2 wrong input, 130 interrupted (as shells do).
FAILED, WRONG_INPUT, INTERRUPTED = 1, 2, 130

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Co-simulation of active chainmail: ngspice, actuator FMUs and Bullet behind one algorithm.",
    epilog="Begin with `cosim list`, then `cosim run single_coil_heating`. See docs/ for the file formats.",
)

app.add_typer(fmu.app, name="fmu")
app.add_typer(ssp.app, name="ssp")
app.add_typer(recording.app, name="recording")
app.command()(compare)
app.command()(sweep)
app.command()(design)
app.command()(record)
app.command()(diagnose)
app.command()(prove)

ScenarioArgument = Annotated[str, typer.Argument(help="A scenario file, or the name of a shipped scenario.")]


@app.command("list")
def list_scenarios() -> None:
    """List the shipped scenarios."""
    table = Table("scenario", "what it does", box=None)
    for name, path in shipped_scenarios().items():
        table.add_row(name, load_scenario(path).title)
    Console().print(table)


@app.command()
def validate(scenario: ScenarioArgument) -> None:
    """Check a scenario, its FMUs and its connections without running it."""
    from cosim.assemble import assemble  # late: `--help` must not load Bullet

    loaded = load_scenario(scenario)
    assembly = assemble(loaded)
    counts = {n: len(u.variables) for n, u in assembly.system.units.items()}
    loops = dict.fromkeys(str(loop) for loop in [*assembly.system.initial_loops, *assembly.system.loops])
    assembly.system.terminate()
    parts = ", ".join(f"{name} ({count} variables)" for name, count in counts.items())
    print(f"{loaded.path}: valid; {parts}; {len(assembly.scenario.connections)} connections")
    for loop in loops:
        print(f"  {loop}")


@app.command()
def schema() -> None:
    """Print the JSON Schema of scenario files, for editors."""
    print(json.dumps(json_schema(), indent=2))


@app.command()
def run(
    scenario: Annotated[
        str, typer.Argument(help="A scenario file or name, or an .ssp file; with --resume it may be a run folder.")
    ],
    out: Annotated[Path | None, typer.Option(help="Run folder; default runs/SCENARIO.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the last checkpoint of an earlier run.")] = False,
    plots: Annotated[bool, typer.Option(help="Draw the figures at the end.")] = True,
    csv: Annotated[bool, typer.Option("--csv", help="Write all recorded values as results.csv too.")] = False,
) -> None:
    """Run a scenario and write a run folder.

    Ctrl-C keeps what is computed; `--resume` goes on from there to the same result.
    """
    folder = _folder(scenario, out, resume)
    loaded = _loaded(scenario, folder, resume)
    run_into(loaded, folder, resume, csv)
    if plots:
        _draw(folder)
    print(f"{folder.path}: {loaded.title}")


def _loaded(scenario: str, folder: RunFolder, resume: bool) -> Scenario:
    is_imported = ssp.is_ssp(scenario)
    if resume and (is_imported or Path(scenario).is_dir()):
        return load_scenario(folder.scenario)
    if is_imported:
        folder.refuse_existing()
        return ssp.scenario_of(Path(scenario), folder.path / "imported")
    return load_scenario(scenario)


def _folder(scenario: str, out: Path | None, resume: bool) -> RunFolder:
    if out is None and resume and Path(scenario).is_dir():
        out = Path(scenario)
    folder = RunFolder(out or Path("runs") / Path(scenario).stem)
    if resume and not folder.scenario.is_file():
        raise InputError(folder.path, "", "there is no run to resume here", "give its folder with `--out`")
    return folder


def run_into(scenario: Scenario, folder: RunFolder, resume: bool = False, csv: bool = False) -> None:
    """Run with a progress bar; a run that stops early ends the program with its exit code."""
    from cosim.progress import progress_bar
    from cosim.run import RunStopped
    from cosim.run import run as run_scenario

    try:
        with progress_bar(scenario.title) as on_progress:
            run_scenario(scenario, folder.path, resume, on_progress, csv)
    except RunStopped as stopped:
        print(f"stopped: {stopped.reason}", file=sys.stderr)
        if folder.summary.is_file():
            print(f"  kept: {folder.results}", file=sys.stderr)
        if stopped.is_interrupt:
            print(f"  go on with: cosim run {folder.path} --resume", file=sys.stderr)
        raise typer.Exit(INTERRUPTED if stopped.is_interrupt else FAILED) from stopped


def _draw(folder: RunFolder) -> None:
    from cosim.figures.draw import draw_run

    for path in draw_run(folder.path):
        print(path)


@app.command()
def plot(
    runs: Annotated[list[Path], typer.Argument(help="Run folders; Figure 3 is drawn from all of them together.")],
) -> None:
    """Draw the figures of one or more runs into the first run's folder."""
    from cosim.figures.draw import draw_runs

    for path in draw_runs(runs):
        print(path)


@app.command()
def reproduce(
    out: Annotated[Path, typer.Option(help="Folder for the runs, the scorecard and the figures.")] = Path(
        "runs/reproduce"
    ),
    jobs: Annotated[int, typer.Option(min=1, help="Runs at the same time.")] = 2,
) -> None:
    """Run the paper's experiments and compare every published number with ours."""
    from cosim.reproduce.command import reproduce as reproduce_paper

    raise typer.Exit(reproduce_paper(out, jobs))


def main() -> NoReturn:
    """Entry point: every foreseen error becomes one message and an exit code."""
    try:
        app()
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(WRONG_INPUT)
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
    sys.exit(0)


if __name__ == "__main__":
    main()
