"""`cosim sweep`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from cosim.terminal import as_argument

INTERRUPTED = 130


def sweep(
    file: Annotated[Path, typer.Argument(metavar="SWEEP.yaml", help="A sweep file (docs/sweeps.md).")],
    out: Annotated[Path | None, typer.Option(help="Folder; default runs/sweeps/NAME.")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Runs at the same time.")] = 2,
    cluster: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler that makes them; default: this machine.")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Use the runs that are in the folder already, and make the others.")
    ] = False,
) -> None:
    """Run one scenario at many values of its keys: one labelled data set, a table, failures by reason, figures.

    Ctrl-C keeps every run that was finished; `--resume` makes the others.
    """
    from rich.console import Console

    from cosim.compute.cluster import choose_place
    from cosim.compute.display import Display
    from cosim.sweep.command import sweep as make

    folder = out or Path("runs") / "sweeps" / file.stem
    display = Display(Console(stderr=True))
    try:
        with display.drawn():
            code = make(file, folder, choose_place(jobs, cluster, goes_on=True), resume, display.progress)
    except KeyboardInterrupt as error:
        print(
            "interrupted; finished runs are kept, go on with: "
            + f"cosim sweep {as_argument(file)} --out {as_argument(folder)} --resume",
            file=sys.stderr,
        )
        raise typer.Exit(INTERRUPTED) from error
    raise typer.Exit(code)
