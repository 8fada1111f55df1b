"""`play(results)`: a run inside a notebook."""

from __future__ import annotations

import html
from os import PathLike
from pathlib import Path

import xarray as xr

from chainmail.play.film import Film
from chainmail.play.from_results import FRAMES, fabric_of
from chainmail.play.output import output
from chainmail.play.page import page
from chainmail.play.run_results import run_results


class Player:
    """A page that a notebook shows, and that can be saved.

    Args:
        text: The whole page.
        height: In a notebook [px].
    """

    def __init__(self, text: str, height: int) -> None:
        self.text, self.height = text, height

    def _repr_html_(self) -> str:
        """The page in a frame of its own, so that notebook and page leave each other alone."""
        return (
            f'<iframe title="fabric" style="width: 100%; height: {self.height}px; border: 1px solid #cbd5e0" '
            f'srcdoc="{html.escape(self.text)}"></iframe>'
        )

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the page as a file; returns its path."""
        target = Path(path)
        with output(target) as partial:
            partial.write_text(self.text, encoding="utf-8")
        return target


def play(
    results: xr.Dataset | str | PathLike[str],
    *others: xr.Dataset | str | PathLike[str],
    frames: int = FRAMES,
    height: int = 620,
) -> Player:
    """Show a fabric in a notebook.

    Args:
        results: What `cosim.run.run` returns, or a run folder.
        others: More of them, shown as ghosts.
        frames: At most this many frames of each are kept, evenly spaced.
        height: Of the frame in the notebook [px].

    Raises:
        InputError: There is no fabric in one of them, or no results in a folder.

    >>> from chainmail.play import play  # doctest: +SKIP
    >>> play(dataset)  # doctest: +SKIP
    """
    given = [r if isinstance(r, xr.Dataset) else Path(r) for r in (results, *others)]
    fabrics = tuple(
        fabric_of(g, "dataset", frames) if isinstance(g, xr.Dataset) else fabric_of(run_results(g), g, frames)
        for g in given
    )
    return Player(page(Film(fabrics)), height)
