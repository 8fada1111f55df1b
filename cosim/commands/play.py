"""`cosim play`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from cosim.unit.errors import InputError


def play(
    folders: Annotated[
        list[Path], typer.Argument(help="A run folder; then more runs, recordings and diagnoses to compare with it.")
    ],
    out: Annotated[Path | None, typer.Option(help="Page; default: play.html in the first folder.")] = None,
    gif: Annotated[Path | None, typer.Option(help="Write an animated GIF.")] = None,
    mp4: Annotated[Path | None, typer.Option(help="Write an MP4; needs the extra `video`.")] = None,
    colour: Annotated[
        str, typer.Option(help="GIF, MP4: temperature, stiffness, tension, extension or `link length`.")
    ] = "",
    view: Annotated[str, typer.Option(help="GIF, MP4: oblique, side, top or front.")] = "oblique",
    speed: Annotated[
        float | None, typer.Option(help="GIF, MP4: simulated seconds a second; default: 12 s in all at most.")
    ] = None,
    width: Annotated[int, typer.Option(min=200, max=3840, help="GIF, MP4: width [px].")] = 560,
    frames: Annotated[int, typer.Option(min=2, max=20_000, help="At most so many output times of a run.")] = 1000,
) -> None:
    """Show a fabric moving: one page that opens without a network, a GIF or an MP4.

    The first run is coloured, further runs are ghosts; recorded markers and findings of diagnoses are laid over it.
    """
    from cosim.commands.play_sources import film_of  # late: `--help` needs no netCDF

    for option, path, ending in (("--out", out, ".html"), ("--gif", gif, ".gif"), ("--mp4", mp4, ".mp4")):
        if path is not None and path.suffix.lower() != ending:
            raise InputError(
                option, "", f"`{path}` does not end in {ending}", f"give a file name that ends in {ending}"
            )
    if speed is not None and not 0.0 < speed < float("inf"):
        raise InputError(
            "--speed", "", f"{speed:g} is no speed", "give a positive number of simulated seconds a second"
        )
    film = film_of(folders, frames)
    if out is not None or (gif is None and mp4 is None):
        from chainmail.play.page import page

        _write_page(out or folders[0] / "play.html", page(film))
    if gif is not None or mp4 is not None:
        from chainmail.play import movie

        style = movie.MovieStyle(colour, view, speed, width)
        for path, write in ((gif, movie.write_gif), (mp4, movie.write_mp4)):
            if path is not None:
                with _progress(path.name) as on_progress:
                    count = write(film, path, style, on_progress)
                print(f"{path}: {count} pictures, {_size(path)}")
    for note in film.all_notes():
        print(f"  {note}")


def _write_page(path: Path, text: str) -> None:
    from chainmail.play.output import output

    with output(path) as partial:
        partial.write_text(text, encoding="utf-8")
    print(f"{path}: {_size(path)}")


def _size(path: Path) -> str:
    size = path.stat().st_size
    return f"{size / 1e6:.2f} MB" if size >= 1e6 else f"{size / 1e3:.0f} kB"


@contextmanager
def _progress(name: str) -> Iterator[Callable[[int, int], None]]:
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(name, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
