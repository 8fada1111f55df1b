"""`cosim design`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from cosim.terminal import as_argument

INTERRUPTED = 130


def design(
    task: Annotated[Path, typer.Argument(metavar="TASK.yaml", help="A task file (docs/design.md).")],
    out: Annotated[Path, typer.Option(help="Folder for scenario, report, front and ledger.")],
    jobs: Annotated[int, typer.Option(min=1, help="Runs at the same time.")] = 2,
    cluster: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler that makes them; default: this machine.")
    ] = None,
    page: Annotated[bool, typer.Option(help="Run the design once more and write play.html, which shows it.")] = True,
    resume: Annotated[bool, typer.Option("--resume", help="Use the runs that are in the folder already.")] = False,
) -> None:
    """Find heated rows, voltages and instants that meet what is wanted with the least energy, and say how surely.

    Ctrl-C keeps every run that was finished; `--resume` goes on with them.
    """
    from rich.console import Console

    from chainmail.design.command import design as find
    from cosim.compute.cluster import choose_place
    from cosim.compute.display import Display

    display = Display(Console(stderr=True))
    try:
        with display.drawn():
            place = choose_place(jobs, cluster, goes_on=True)
            code = find(task, out, place, resume, display.stage, display.progress, page)
    except KeyboardInterrupt as error:
        print(
            "interrupted; finished runs are kept, go on with: "
            + f"cosim design {as_argument(task)} --out {as_argument(out)} --resume",
            file=sys.stderr,
        )
        raise typer.Exit(INTERRUPTED) from error
    raise typer.Exit(code)
