"""`cosim track`: from a video to a recording."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from cosim.alone import alone
from cosim.unit.errors import InputError


def track(
    video: Annotated[Path, typer.Argument(help="A video file, or a folder of pictures in the order of their names.")],
    rig: Annotated[Path, typer.Option(help="Rig file: lens, plane, markers, clock (docs/camera.md).")],
    out: Annotated[Path, typer.Option(help="Folder for the recording; nothing in it is overwritten.")],
    page: Annotated[bool, typer.Option(help="Write track.html: overlays, tracks, quality over time.")] = True,
) -> None:
    """Track the markers of a fabric in a video and write a recording.

    Places of markers, row centres, angles of links and the largest curvature, each with its uncertainty. A frame that
    cannot be resolved is a gap. Exit code 2: wrong input.
    """
    from rich.console import Console

    from chainmail.camera.frames import Frames
    from chainmail.camera.measure import measure
    from chainmail.camera.output import refuse_recording, write_tracks
    from chainmail.camera.page import write_page
    from chainmail.camera.rig import load_rig
    from chainmail.camera.summary import summary

    with alone(out, "tracking"):
        refuse_recording(out)
        loaded = load_rig(rig)
        console = Console(stderr=True)
        if console.is_terminal:
            with console.status("reading frames") as status:
                found = measure(video, loaded, rig, lambda count: status.update(f"{count} frames read"))
        else:
            found = measure(video, loaded, rig)
        channels = write_tracks(out, found, loaded, f"cosim track {video}")
        for sentence in summary(found):
            print(sentence)
        if page:
            try:
                write_page(out / "track.html", found, loaded, Frames(video))
            except OSError as error:
                what = f"the page cannot be written ({error.strerror or error}); the recording is complete"
                raise InputError(out / "track.html", "", what, "make room and repeat in another folder") from error
            print(out / "track.html")
        print(f"{out}: {len(channels)} channels")
        if not any(c.startswith("fabric") for c in channels) and found.links is not None:
            print("no frame has all markers: the recording has no curvature", file=sys.stderr)
