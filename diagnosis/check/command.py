"""`cosim recording new`, `import` and `check`: arguments, what is printed, exit codes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cosim.alone import alone
from cosim.loading import load_scenario
from cosim.run_folder import write_atomically, writing
from cosim.terminal import as_argument, printable
from cosim.unit.errors import InputError

app = typer.Typer(
    no_args_is_help=True, help="Recordings: begin one from a table or from tracks, and check it against a scenario."
)


@app.command()
def new(
    table: Annotated[Path, typer.Argument(help="CSV table as a logger or spreadsheet wrote it.")],
    scenario: Annotated[str, typer.Option(help="A scenario file or name: the model that it belongs to.")],
    out: Annotated[Path, typer.Option(help="Folder for the recording: recording.yaml and a plain copy of the table.")],
) -> None:
    """Propose a recording.yaml for a table: channels, units, clock and noise, as far as column names tell.

    What is not clear stands in it as a comment with the reason. Read it before you use it. Nothing is overwritten.
    """
    from diagnosis.check.propose import propose
    from diagnosis.check.sniff import read_table

    with alone(out, "recording"):
        for name in ("recording.yaml", "data.csv"):
            if (out / name).exists():
                raise InputError(out / name, "", "this file exists already", "give another folder with `--out`")
        found = propose(load_scenario(scenario), read_table(table), table)
        with writing(out):
            write_atomically(out / "data.csv", found.table.encode())
            write_atomically(out / "recording.yaml", found.sidecar.encode())
    channels, columns = _counted(found.channels, "channel"), _counted(len(found.unclear_columns), "column")
    print(f"{out / 'recording.yaml'}: {channels} proposed, {columns} unclear")
    for text in found.unclear_columns:
        print(f"  unclear column {printable(text)}")
    if not found.channels:
        print("no column could be matched: write the channels yourself (docs/recordings.md lists their names)")
    else:
        print(f"read it, then: cosim recording check {as_argument(out)} --scenario {as_argument(scenario)}")


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


@app.command("import")
def import_tracks(
    table: Annotated[Path, typer.Argument(help="CSV of DeepLabCut, OptiTrack (Motive), or a plain tracker.")],
    given: Annotated[Path, typer.Option("--as", help="What its points are on the rig (docs/camera.md).")],
    out: Annotated[Path, typer.Option(help="Folder for the recording; nothing in it is overwritten.")],
) -> None:
    """Make a recording of markers that another tool tracked."""
    from chainmail.camera.import_file import load_import
    from chainmail.camera.importing import imported
    from chainmail.camera.imports import read_tracks
    from chainmail.camera.output import refuse_recording, write_tracks

    with alone(out, "recording"):
        refuse_recording(out)
        loaded = load_import(given)
        found = imported(read_tracks(table), loaded, given)
        channels = write_tracks(out, found, loaded, f"cosim recording import {table}")
    for note in found.notes:
        print(note)
    tracks = found.tracks
    gaps = float((tracks.share == 0.0).mean())
    print(
        f"{out}: {len(channels)} channels, {len(tracks.times)} rows from {tracks.times[0]:.6g} s to "
        f"{tracks.times[-1]:.6g} s, {100.0 * gaps:.1f} % gaps"
    )


@app.command()
def check(
    recordings: Annotated[list[Path], typer.Argument(help="Folders of recordings of one rig.")],
    scenario: Annotated[str, typer.Option(help="A scenario file or name: the model as it is.")],
    out: Annotated[Path | None, typer.Option(help="Page (.html) with measured beside simulated.")] = None,
) -> None:
    """Are these recordings and this scenario of the same experiment? In seconds, without any search.

    One simulation for each recording. Exit code 0: no serious doubt; 1: a serious one; 2: wrong input.
    """
    from diagnosis.recording.recording import load_recording
    from diagnosis.recording.together import refuse_doubled

    if out is not None and out.exists():
        raise InputError(out, "", "this file exists already", "give another name with `--out`")
    refuse_doubled(recordings)
    base = load_scenario(scenario)
    loaded = [load_recording(path) for path in recordings]

    from diagnosis.check.beside import compare
    from diagnosis.check.check import doubts_of
    from diagnosis.check.page import write_page
    from diagnosis.check.tables import print_check
    from diagnosis.models.coil_network.runs import refuse_unknown
    from diagnosis.recording.conditions import scenario_of

    for one in loaded:  # what `cosim diagnose` would refuse is no experiment of this scenario
        refuse_unknown(scenario_of(base, one), one)
    every = [compare(base, one) for one in loaded]
    doubts = doubts_of(every)
    from rich.console import Console  # here: `cosim validate` loads this module

    print_check(every, doubts, Console())
    if out is not None:
        with writing(out):
            out.parent.mkdir(parents=True, exist_ok=True)
            write_page(every, doubts, out)
        print(out)
    raise typer.Exit(1 if any(d.is_serious for d in doubts) else 0)
