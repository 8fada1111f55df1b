"""`cosim diagnose`: arguments, progress and exit codes."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cosim.alone import alone
from cosim.interrupt import first_interrupt
from cosim.loading import load_scenario
from cosim.run_folder import refuse_unwritable, writing
from cosim.unit.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cosim.compute.steps import Steps
    from cosim.scenario import Scenario
    from diagnosis.diagnose import Result
    from diagnosis.judge.diagnosis import Diagnosis
    from diagnosis.recording.recording import Recording

#: How long further effects are looked for where nobody says how long. Where no law explains the readings a search takes
#: longest, up to an hour, and its answer is that nothing was found (docs/decisions/0035-a-usual-time.md).
USUAL_TIME = "10 min"


def diagnose(
    scenario: Annotated[str, typer.Argument(help="A scenario file or name: the model as it is.")],
    recording: Annotated[list[Path], typer.Option(help="Recording that is fitted; may be given several times.")],
    out: Annotated[Path, typer.Option(help="Folder for diagnosis.json and report.html.")],
    held_out: Annotated[
        list[Path] | None,
        typer.Option(
            help="Recording that judges; may be given several times. Without one, stretches of the others judge."
        ),
    ] = None,
    level: Annotated[float, typer.Option(min=0.001, max=0.5, help="Rate of false alarms that is allowed.")] = 0.05,
    seed: Annotated[int, typer.Option(min=0, help="Of all random numbers.")] = 0,
    jobs: Annotated[int, typer.Option(min=1, help="Simulations at the same time.")] = 2,
    cluster: Annotated[
        str | None,
        typer.Option(help="Address of a Dask scheduler that makes them; default: processes of this machine."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the simulations that an interrupted diagnosis left in --out.")
    ] = False,
    without: Annotated[
        list[str] | None, typer.Option(help="Effect of the catalogue to do without; may be given several times.")
    ] = None,
    brief: Annotated[
        bool, typer.Option("--brief", help="Verdict, findings and fit alone, as diagnosis.json: for many in a row.")
    ] = False,
    despite_doubts: Annotated[
        bool,
        typer.Option(
            "--despite-doubts",
            help="Search although the recordings seem to be of another experiment.",
        ),
    ] = False,
    limit: Annotated[
        list[str] | None, typer.Option(help="Greatest value in a next experiment: `supply.voltage=12 V`.")
    ] = None,
    stop_after: Annotated[
        str | None,
        typer.Option(
            help=f"Answer with what is found by then: a time, or `never`; {USUAL_TIME} where nothing is said. Not of "
            "fabrics and pendulums, which resume.",
        ),
    ] = None,
) -> None:
    """Find out what a model leaves out, by recordings of the real thing.

    Nothing is fitted to recordings that are held out; they judge. Coil networks with hanging loads and lumped heaters
    are simulated by one compiled function; a pendulum or a fabric in Bullet by the co-simulation itself, which takes
    longer.
    """
    from rich.console import Console

    from cosim.compute.batch import Batches
    from cosim.compute.cache import Cache
    from cosim.compute.cluster import choose_place
    from cosim.compute.display import Display
    from cosim.compute.steps import Steps, watched
    from diagnosis.diagnose import Options
    from diagnosis.diagnose import diagnose as find
    from diagnosis.experiment.limits import parse_limits, parse_time
    from diagnosis.recording.recording import load_recording
    from diagnosis.recording.together import prepared
    from diagnosis.report.summary import print_summary
    from diagnosis.search.search import Settings

    held_out = held_out or []
    _check(recording, held_out, out)
    kept = Cache(out / "simulations")
    display = Display(Console(stderr=True))
    try:
        with (
            alone(out, "diagnosis"),
            display.drawn(),
            Batches(choose_place(jobs, cluster), kept, display.progress) as batches,
        ):
            if kept.count() and not resume:
                raise InputError(
                    out,
                    "",
                    "an interrupted diagnosis left its simulations here",
                    "go on from them with `--resume`, or give another folder with `--out`",
                )
            base = load_scenario(scenario)
            limits = parse_limits(limit or [], base)
            options = Options(tuple(without or ()), jobs, limits, batches, brief, not despite_doubts)
            training, judges = prepared(
                base, [load_recording(p) for p in recording], [load_recording(p) for p in held_out]
            )
            gc.freeze()  # modules and recordings stay to the end: they need not be looked through again and again
            time = parse_time(stop_after or USUAL_TIME)
            with watched(Steps(display.stage, most=time, is_usual=stop_after is None)) as steps:
                with first_interrupt(lambda: _is_stopped(steps)):
                    found = find(base, training, judges, Settings(level=level, seed=seed), steps, options)
                steps("writing" if brief else "writing the amended model and the report")
                try:
                    diagnosis = _brief(found, out) if brief else _whole(found, base, training, judges, out)
                except InputError:  # a full disk must not cost the answer
                    print_summary(found.diagnosis, Console(), "diagnosis.json")
                    raise
    except KeyboardInterrupt:
        rest = (
            f"`--resume` goes on from its {kept.count()} simulations"
            if kept.count()
            else "the same command starts afresh"
        )
        print(f"interrupted: there is no diagnosis in {out}; {rest}", file=sys.stderr)
        raise typer.Exit(130) from None
    print_summary(diagnosis, Console(), "diagnosis.json" if brief else "report.html")
    if not brief:
        print(out / "report.html")


def _is_stopped(steps: Steps) -> bool:
    """Whether a search goes on to its answer with what it has; says so."""
    if not steps.stop():
        return False
    # not by Rich: its lock may be held where the signal came
    os.write(2, b"\nstopping: what was found is judged, which takes a little; Ctrl-C again gives it up\n")
    return True


def _brief(found: Result, out: Path) -> Diagnosis:
    """Write diagnosis.json alone."""
    from diagnosis.report.json_file import write_json

    with writing(out):
        write_json(found.diagnosis, out / "diagnosis.json")
    return found.diagnosis


def _whole(
    found: Result, scenario: Scenario, training: Sequence[Recording], judges: Sequence[Recording], out: Path
) -> Diagnosis:
    """Write everything; see `write_outputs`."""
    from diagnosis.write_outputs import write_outputs  # late: figures take a second to load

    return write_outputs(found, scenario, training, judges, out)


def _check(recording: list[Path], held_out: list[Path], out: Path) -> None:
    """Refuse what would lose something, or judge a fit by itself, before any work is done."""
    if (out / "diagnosis.json").exists():
        raise InputError(out, "", "this folder already holds a diagnosis", "give another folder with `--out`")
    refuse_unwritable(out)  # it must not cost a diagnosis
    from diagnosis.recording.together import refuse_doubled

    refuse_doubled(recording)
    refuse_doubled(held_out)
    same = {os.path.realpath(p) for p in recording} & {os.path.realpath(p) for p in held_out}
    if same:
        raise InputError(
            sorted(same)[0],
            "",
            "this recording is fitted and held out at once",
            "hold out a recording that was made with another programme",
        )
